#pragma once

#include <vector>

#include "soil/engine_material.hpp"
#include "soil/gll.hpp"
#include "soil/lattice.hpp"
#include "soil/simd.hpp"

namespace easydyn::soil {

/// Positions [m] of the nodes of a line of elements.
std::vector<double> node_positions(const GllRule& rule, const std::vector<double>& lines);

/// Assembled lumped mass of a line of elements: node distances weighted by quadrature, times `factor` of each.
std::vector<double> assemble_mass(const GllRule& rule, const std::vector<double>& lines,
                                  const std::vector<double>& factor);

/// One factor per slab of elements: that of its layer.
template <class Factor>
std::vector<double> factor_of_slabs(const Lattice& lattice, const std::vector<EngineMaterial>& materials,
                                    const Factor& factor) {
  std::vector<double> result;
  for (const int layer : lattice.layer) result.push_back(factor(materials[static_cast<std::size_t>(layer)]));
  return result;
}

/// Line operators of a lattice of layers. Mass of a node = mx my mz_density; tables [N][stride] along x as
/// tile_operator.hpp wants them.
template <class T>
struct AxisTables {
  AxisTables(const Lattice& lattice, const std::vector<EngineMaterial>& materials, int stride);

  std::vector<double> mx, my, mz_density;
  AlignedVector<T> rmx, kx, kx_left, x_end, mx_table;
};

}  // namespace easydyn::soil

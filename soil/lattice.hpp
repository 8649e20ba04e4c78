#pragma once

#include <array>
#include <string>
#include <vector>

#include "soil/site.hpp"
#include "soil/surface_loads.hpp"

namespace easydyn::soil {

/// How the lattice is made.
struct LatticeOptions {
  int degree = 4;              ///< polynomial degree of the elements, 3..6
  bool half_model = true;      ///< only y >= 0, plane y = 0
  bool quarter_model = false;  ///< only x >= 0 and y >= 0: one footprint at the origin
  int sponge_elements = 8;     ///< damped elements on each outer side (three quarters of it below), >= 0
  double sponge_growth = 1.1;  ///< size ratio of neighbouring elements in the sponge and in depth, 1..1.5
  /// > 0: elements grow by half away from footprints and blocks, and downward, to what this frequency [Hz] asks
  /// for, and so the sponge is longer: for loads without anything above it. 0: Site::highest_frequency everywhere.
  double far_frequency = 0;
  int lanes = 16;  ///< elements along x + 1 is made a multiple of this with more sponge, >= 1
};

/// The elements lo <= e < hi of each axis that are not of their layer's material.
struct LatticeBlock {
  std::array<int, 2> x{}, y{}, z{};
  int material = 0;  ///< number of layers + index into Site::blocks; -1: open
};

/// Structured lattice of rectangular hexahedra with Gauss-Lobatto-Legendre nodes, graded in depth and toward
/// the boundaries. Element (ex, ey, ez) is the box between lines ex, ex + 1 of `x`, and so on; layer
/// interfaces lie on z lines and faces of blocks on lines, and the material depends on ez only, but for blocks.
struct Lattice {
  int degree = 4;
  bool half_model = true;
  bool quarter_model = false;        ///< then half_model, too
  std::vector<double> x, y, z;       ///< element boundaries [m], ascending; z.back() = 0 (surface)
  std::vector<int> layer;            ///< per z element (from the bottom): index into Site::layers
  std::vector<LatticeBlock> blocks;  ///< the later one holds where two overlap
  std::array<int, 2> sponge_x{}, sponge_y{}, sponge_z{};  ///< damped elements at the low and the high end

  int nx() const { return static_cast<int>(x.size()) - 1; }
  int ny() const { return static_cast<int>(y.size()) - 1; }
  int nz() const { return static_cast<int>(z.size()) - 1; }
  long elements() const { return static_cast<long>(nx()) * ny() * nz(); }
  long interior_elements() const {  ///< undamped
    return static_cast<long>(nx() - sponge_x[0] - sponge_x[1]) * (ny() - sponge_y[0] - sponge_y[1]) *
           (nz() - sponge_z[0] - sponge_z[1]);
  }
  long nodes() const {
    return (static_cast<long>(nx()) * degree + 1) * (static_cast<long>(ny()) * degree + 1) *
           (static_cast<long>(nz()) * degree + 1);
  }
  long dofs() const { return 3 * nodes(); }

  /// Undamped range [m] of each axis.
  std::array<double, 2> interior_x() const { return {x[sponge_x[0]], x[x.size() - 1 - sponge_x[1]]}; }
  std::array<double, 2> interior_y() const { return {y[sponge_y[0]], y[y.size() - 1 - sponge_y[1]]}; }
  std::array<double, 2> interior_z() const { return {z[sponge_z[0]], z[z.size() - 1 - sponge_z[1]]}; }
};

/// Lattice that holds all receivers and footprints, `Site::margin` away from the sponge, and resolves the
/// shortest shear wave of each layer at Site::highest_frequency with Site::points_per_wavelength mean node
/// distances. Horizontal sizes follow the slowest material, vertical sizes the slowest at each depth. The undamped
/// ground holds the finite faces of the blocks, too; what reaches to infinity goes on through the sponge.
/// @throws ModelError if the site or an option is out of range, naming it, its value and the accepted range
Lattice make_lattice(const Site& site, const std::vector<Footprint>& footprints,
                     const LatticeOptions& options = {});

/// Name and position of the receiver farthest from the origin, for messages; "none" without receivers.
std::string describe_farthest_receiver(const Site& site);
/// Name and speed of the slowest layer or block, for messages.
std::string describe_slowest_layer(const Site& site);

}  // namespace easydyn::soil

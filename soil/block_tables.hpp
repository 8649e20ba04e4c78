#pragma once

#include <array>
#include <vector>

#include "soil/axis_tables.hpp"
#include "soil/engine_material.hpp"
#include "soil/lattice.hpp"
#include "soil/partition.hpp"
#include "soil/simd.hpp"

namespace easydyn::soil {

/// Material of an element: that of the last block that holds it, else of its layer; -1: open.
int find_material(const Lattice& lattice, int ex, int ey, int ez);

/// Nodes of the line with mass: all but those between open elements only.
int count_nodes_with_mass(const Lattice& lattice, LinePlace line);

/// What blocks of other material change in a part of a lattice of layers: the rows of elements with blocks in them
/// and the lines of nodes whose masses are not the layers'.
template <class T>
class BlockTables {
 public:
  struct Row {  // tables [stride] per element
    int first, last;
    AlignedVector<T> lambda, mu;              // zero outside blocks and where open
    AlignedVector<T> minus_lambda, minus_mu;  // those of the layer, where a block is
    AlignedVector<T> lambda_change, mu_change;
    AlignedVector<T> beta;
    std::array<AlignedVector<T>, 3> minus_weight;  // of the memory variables

    template <class AnyRow>
    static auto tables_of(AnyRow& row) {
      return std::array{
          &row.lambda,    &row.mu,   &row.minus_lambda,    &row.minus_mu,        &row.lambda_change,
          &row.mu_change, &row.beta, &row.minus_weight[0], &row.minus_weight[1], &row.minus_weight[2]};
    }
  };
  struct MassLine {                   // tables [N][stride]
    AlignedVector<T> ratio, inverse;  // true mass / that of the layers; inverse 0 where there is none
  };

  BlockTables() = default;
  BlockTables(const Lattice& lattice, const std::vector<EngineMaterial>& materials, const AxisTables<T>& axes,
              int stride, const ElementBlock& part);

  /// [byte] of the tables of such a part, before they are made.
  static double compute_memory(const Lattice& lattice, int stride, const ElementBlock& part);
  double memory() const;  ///< [byte]

  /// nullptr: no block there.
  const Row* find_row(int ey, int ez) const {
    if (row_index_.empty()) return nullptr;
    const int row = row_index_[static_cast<std::size_t>(ez - part_.slabs[0]) * rows_ + (ey - part_.rows[0])];
    return row < 0 ? nullptr : &row_[row];
  }
  const MassLine* find_mass_line(LinePlace line) const {
    if (line_index_.empty()) return nullptr;
    const int found = line_index_[static_cast<std::size_t>(line.Z - first_.Z) * lines_ + (line.Y - first_.Y)];
    return found < 0 ? nullptr : &mass_line_[found];
  }

  AlignedVector<T> hx, slope_x, ones;  ///< [stride] element size, 2 / size, 1

 private:
  void make_rows(const Lattice& lattice, const std::vector<EngineMaterial>& materials, int stride);
  void make_mass_lines(const Lattice& lattice, const std::vector<EngineMaterial>& materials,
                       const AxisTables<T>& axes, int stride);

  ElementBlock part_;
  LinePlace first_;
  int rows_ = 0, lines_ = 0;  // along y
  std::vector<int> row_index_, line_index_;
  std::vector<Row> row_;
  std::vector<MassLine> mass_line_;
};

}  // namespace easydyn::soil

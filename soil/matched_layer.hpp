#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "soil/axis_tables.hpp"
#include "soil/boundary_tables.hpp"
#include "soil/lattice.hpp"
#include "soil/partition.hpp"
#include "soil/simd.hpp"
#include "soil/stretched_operator.hpp"

namespace easydyn::soil {

/// Perfectly matched layer in the elements lattice.sponge_x, _y, _z: coordinates stretched by s_x(x), s_y(y), s_z(z),
///
///   s = 1 + d / q,  q = i w + alpha,  d = strength x speed / length x (distance / length)^2
///
/// with the length of the layer on its side and the distance from its inner face. The equations of motion become (Z. Xie,
/// D. Komatitsch, R. Martin, R. Matzen, Geophys. J. Int. 198, 2014, doi:10.1093/gji/ggu219)
///
///   (i w)^2 s_x s_y s_z rho u_c = sum_j d/dx_j (prod_{k != j} s_k sigma_cj),   sigma = C : (1 / s_j) d w_c / d x_j
///
/// The right side is that of stretched_operator.hpp. The left side, with h = i w / q and c1, c2, c3 the sums of the d, of
/// their products in pairs and their product, is
///
///   (i w)^2 s_x s_y s_z = (i w)^2 + i w c1 - alpha c1 h + c2 h^2 + c3 h^2 / q
///
/// : damping c1, and three filters 1 / q in a chain, x1 = u - alpha psi1(u), x2 = x1 - alpha psi2(x1), psi3(x2). They rest when
/// the motion rests, which leaves a static problem in stretched coordinates.
///
/// Material damping acts in the layer as outside, because both are filters of the same gradients. The waves of all layers
/// of the ground decay alike per length. There is no proof of stability: matched_layer_limits.hpp has the
/// grounds in which strength 5 and alpha 20 1/s did not grow.
template <class T>
class MatchedLayer {
 public:
  MatchedLayer(const Lattice& lattice, const EngineBoundary& boundary, const AxisTables<T>& axes, int stride,
               const ElementBlock& part);

  static double compute_memory(const Lattice& lattice, int stride,
                               const ElementBlock& part);    ///< [byte] of states
  static std::size_t count_scratch(const Lattice& lattice);  ///< values that a thread needs beside them
  void set_time_step(double dt);
  void set_to_rest();
  /// Calls use(data, bytes) for each array of states.
  template <class Use>
  void visit_state(const Use& use) {
    for (AlignedVector<T>* states : {&element_state_, &line_state_})
      use(states->data(), states->size() * sizeof(T));
  }

  /// Whether all elements of the rows ey, of the slabs ez, are of the layer.
  bool fills_rows(int ey) const { return is_layer(lattice_.sponge_y, ey, lattice_.ny()); }
  bool fills_slabs(int ez) const { return is_layer(lattice_.sponge_z, ez, lattice_.nz()); }
  bool fills(int ey, int ez) const { return fills_rows(ey) || fills_slabs(ez); }
  /// Adds the forces of the layer's elements of a row; of a row that it does not fill, their difference from those of plain
  /// elements. Takes a step of the row's states.
  /// @param scratch  scratch_size() values of this thread
  void add_forces(const Tile<T>& tile, int ey, int ez, T* scratch);
  std::size_t scratch_size() const { return count_scratch(lattice_); }

  /// Whether all nodes of a line lie behind the inner faces of the layer.
  bool holds_line(int Y, int Z) const { return count_axes_across(Y, Z) > 0; }
  /// Adds the terms of the left side on a line of nodes to f = force / m_x, then damps f and v so that
  /// v - dt f / line_mass is the velocity after the step. Takes a step of the line's states.
  void add_inertia(int Y, int Z, double line_mass, const T* u, T* v, T* f);
  /// [N][stride] m_x of nodes outside the layer, zero in it.
  const AlignedVector<T>& plain_mass() const { return plain_mass_; }

 private:
  /// Lanes of a row, copied to other lanes.
  struct Piece {
    int from, to, count;
  };
  /// The elements at both ends of a row that the layer does not fill, side by side, so that they fill vectors: each end
  /// with one lane more, for the right end of its last element.
  struct Ends {
    Ends(const Lattice& lattice);
    std::vector<Piece> pieces;
    std::vector<LanePack> packs;
    int stride = 0;
  };
  /// Where the states of each row and line begin; -1: it has none.
  struct Places {
    Places(const Lattice& lattice, int stride, const ElementBlock& part);
    Ends ends;
    std::vector<LanePack> all_elements, all_nodes, layer_nodes;  // along x
    std::vector<std::ptrdiff_t> row, line;
    std::size_t element_states = 0, line_states = 0;
  };
  /// Along x, per lane.
  struct Tables {
    AlignedVector<T> rmx, d, a, g;  // [N][stride] 1 / m_x, d and filters of quotients
    AlignedVector<T> h, slope;      // [stride]
  };
  static bool is_layer(const std::array<int, 2>& ends, int e, int count) {
    return e < ends[0] || e >= count - ends[1];
  }
  static bool is_behind(const std::array<int, 2>& ends, int node, int degree, int elements) {
    return node < ends[0] * degree || node > (elements - ends[1]) * degree;
  }
  /// Axes y and z that stretch the nodes of a line.
  int count_axes_across(int Y, int Z) const {
    const int N = lattice_.degree;
    return (is_behind(lattice_.sponge_y, Y, N, lattice_.ny()) ? 1 : 0) +
           (is_behind(lattice_.sponge_z, Z, N, lattice_.nz()) ? 1 : 0);
  }

  std::size_t lines_of_row() const {
    return static_cast<std::size_t>(lattice_.degree + 1) * (lattice_.degree + 1);
  }
  std::size_t ends_line_size() const {
    return static_cast<std::size_t>(3) * lattice_.degree * places_.ends.stride;
  }
  void copy_ends(const T* from, T* to) const;
  void add_ends(const T* from, T* to) const;

  Lattice lattice_;
  ElementBlock part_;
  int stride_;
  double alpha_, dt_ = 0;
  Places places_;
  StretchedFunction<T> function_;
  std::vector<double> d_y_, d_z_;  // of the nodes [1/s]
  Tables row_, ends_;              // of whole rows, of their ends side by side
  AlignedVector<T> plain_mass_;    // [N][stride]
  std::vector<T> y_, z_;           // d, a, g of the points of each element: [element][3][N + 1]
  AlignedVector<T> element_state_, line_state_;
};

}  // namespace easydyn::soil

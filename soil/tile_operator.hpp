#pragma once

#include "soil/simd.hpp"

namespace easydyn::soil {

inline constexpr int lowest_degree = 3, highest_degree = 6;

/// One row of elements along x (fixed ey, ez) of the elastic operator, all of one material.
///
/// A *line* holds the 3 components of all nodes of one (Y, Z) pair of node indices as
/// [component][node][element x]: node X = N ex + i of the lattice is lane ex of node i, 0 <= i < N; the right
/// end of element ex is node 0 of lane ex + 1. Vectors run over the elements: derivatives along x are aligned
/// loads of the N nodes and loads shifted by one lane; no gathers. At least one unused lane (zero) separates
/// the rows of lanes.
///
/// The operator is a sum of tensor products of the line operators of gll.hpp: m (mass), K (stiffness) and G =
/// A + B / 2 (gradient, w_i D_ij; A antisymmetric, B = diag(-1, 0, ..., 0, 1)). With lambda, mu:
///
///   f_x = (lambda + 2 mu) K_x u_x + mu (K_y + K_z) u_x + (lambda G_x^T G_y + mu G_x G_y^T) u_y + (same with
///   z)
///
/// and cyclic, masses m of the directions not shown. Along x and y the material does not change, so B cancels
/// between elements and G^T = -A, G = A, except at the outer faces (`gradient_end`, `x_end`); along x the
/// operators are used assembled, along y and z element by element. The result is f / m_x.
template <class T>
struct Tile {
  static constexpr int max_n = highest_degree + 1;

  // Field and result: line (k, j) of the (N + 1)^2 lines of the row; k along z, j along y.
  const T* w[max_n * max_n];
  T* f[max_n * max_n];
  bool add[max_n * max_n];  ///< add to the line instead of setting it
  int stride;               ///< lanes per row (multiple of the pack, > number of elements + 1)

  // Line operators along x, per lane.
  const T* rmx;      ///< [N][stride] 1 / m_x, zero where there is no node
  const T* kx;       ///< [N][stride] (2 / hx) / m_x; node 0: of the element to the right
  const T* kx_left;  ///< [stride] node 0: of the element to the left
  const T* x_end;    ///< [stride] node 0: -1/2 and 1/2 (times 1 / m_x) at the two ends, else zero
  int last_lane;     ///< of the right end

  T lambda, mu;
  T my[max_n],
      my_element[max_n];  ///< m_y assembled (zero where another row takes the line) and element's own
  T mz[max_n], mz_element[max_n];  ///< same along z
  int j_end, k_end;       ///< lines j < j_end, k < k_end are this row's for terms that carry m_y, m_z
  T hy, hz;               ///< element size [m]
  T gradient_end[max_n];  ///< B_y / 2 at an outer face y = const, else zero
  bool y_end;             ///< one of them is not zero

  static constexpr int max_ahead = 512;
  const T* ahead[max_ahead];  ///< lines needed soon: fetched into the cache between the arithmetic
  int ahead_count;
};

/// f (+)= K w / m_x for one row of elements.
template <class T>
using TileFunction = void (*)(const Tile<T>&);

/// The compiled kernel for a degree, 3..6.
template <class T>
TileFunction<T> find_tile_function(int degree);

}  // namespace easydyn::soil

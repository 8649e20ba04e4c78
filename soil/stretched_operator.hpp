#pragma once

#include <vector>

#include "soil/simd.hpp"
#include "soil/tile_operator.hpp"

namespace easydyn::soil {

/// Lanes e .. e + lanes - 1 of a row of elements or of a line of nodes.
struct LanePack {
  int first;
  bool stretched_x;  ///< one of them at least
};

/// Elements of one row along x (fixed ey, ez) in stretched coordinates, s_j = 1 + d_j / (i w + alpha), all of one material:
///
///   f_a += sum_q w_q |J| sum_j (prod_{k != j} s_k) sigma_cj (d phi_a / d x_j)_q / m_x,
///   sigma = C : (1 / s_j) d w_c / d x_j,   c the component of the force
///
/// in the layout of lines of tile_operator.hpp. Products and quotients with s are filters with one state each: with
/// psi = x / (i w + p),  x s = x + d psi (p = alpha),  x / s = x - d psi (p = alpha + d), by the trapezoidal rule
///
///   psi = g x + c,  c <- a psi + g x,   a = (1 - p dt / 2) / (1 + p dt / 2),  g = (dt / 2) / (1 + p dt / 2)
///
/// Each call is one time step. Per point and axis that stretches an element: 3 states of the gradient along the axis, 6 of
/// the two columns of stress across it.
template <class T>
struct StretchedRow {
  static constexpr int max_n = highest_degree + 1, states_per_axis = 9;

  const T* w[max_n * max_n];  ///< line (k, j); k along z, j along y
  T* f[max_n * max_n];        ///< lines to add to
  int stride;                 ///< lanes per row
  const T* rmx;               ///< [N][stride] 1 / m_x
  const T *hx, *slope_x;      ///< [stride] element size and 2 / size, zero where there is none
  T hy, hz;                   ///< element size [m]
  T lambda, mu;
  bool subtracts_plain;  ///< adds the difference from the elements without stretch

  const LanePack* packs;
  int pack_count;
  bool stretched_y, stretched_z;
  T* state;                  ///< of the first pack: [pack][point][state][lane]
  T a, g;                    ///< of products: p = alpha
  const T *d_x, *a_x, *g_x;  ///< [N][stride] d and filters of quotients, p = alpha + d
  const T *d_y, *a_y, *g_y;  ///< [N + 1] of the element's points along y
  const T *d_z, *a_z, *g_z;  ///< along z
};

template <class T>
using StretchedFunction = void (*)(const StretchedRow<T>&);

/// The compiled kernel for a degree, 3..6.
template <class T>
StretchedFunction<T> find_stretched_function(int degree);

}  // namespace easydyn::soil

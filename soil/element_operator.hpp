#pragma once

#include "soil/simd.hpp"
#include "soil/tile_operator.hpp"

namespace easydyn::soil {

/// Elements of one row along x (fixed ey, ez), each of its own material: what blocks add to a row of one material
/// (tile_operator.hpp), in the same layout of lines. Element by element as in the textbook:
///
///   f_a += sum_q w_q |J| sigma_q grad(phi_a)_q / m_x,   sigma = lambda tr(eps) I + 2 mu eps
///
/// of the displacement w = sum_p weight_p part_p, weights per element. Elements without a modulus add nothing.
template <class T>
struct ElementRow {
  static constexpr int max_n = highest_degree + 1, max_parts = 4;

  int parts;
  const T* part[max_parts][max_n * max_n];  ///< line (k, j) of each part; k along z, j along y
  const T* weight[max_parts];               ///< [stride]
  T* f[max_n * max_n];                      ///< lines to add to
  int stride, first, last;                  ///< lanes per row; elements first <= e < last
  const T* rmx;                             ///< [N][stride] 1 / m_x
  const T *hx, *slope_x;                    ///< [stride] element size and 2 / size, zero where there is none
  T hy, hz;                                 ///< element size [m]
  const T *lambda, *mu;                     ///< [stride] zero outside first <= e < last
};

template <class T>
using ElementFunction = void (*)(const ElementRow<T>&);

/// The compiled kernel for a degree, 3..6.
template <class T>
ElementFunction<T> find_element_function(int degree);

}  // namespace easydyn::soil

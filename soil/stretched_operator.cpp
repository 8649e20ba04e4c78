#include "soil/stretched_operator.hpp"

#include "easydyn/error.hpp"
#include "soil/gll.hpp"

namespace easydyn::soil {

namespace {

template <class T, int N>
struct ElementRule {
  static constexpr int n = N + 1;
  T D[n][n], weight[n];  // derivative of shape function j at point i
  ElementRule() {
    const GllRule rule(N);
    for (int i = 0; i < n; ++i) {
      weight[i] = static_cast<T>(rule.weights(i));
      for (int j = 0; j < n; ++j) D[i][j] = static_cast<T>(rule.derivative(i, j));
    }
  }
};

/// psi of one filter, which goes on to the next step.
template <class T>
inline __attribute__((always_inline)) pack<T> filter(pack<T> a, pack<T> g, pack<T> x, T*& state) {
  const pack<T> psi = g * x + load_pack(state);
  store_pack(state, a * psi + g * x);
  state += Pack<T>::lanes;
  return psi;
}

/// The 9 states of one axis at a point: gradients along it, before the stress is known.
template <class T>
inline __attribute__((always_inline)) void divide_gradients(pack<T> (&gradient)[3][3], int axis, pack<T> d,
                                                            pack<T> a, pack<T> g, T*& state) {
  for (int c = 0; c < 3; ++c) gradient[c][axis] -= d * filter<T>(a, g, gradient[c][axis], state);
}

/// Columns of stress that work across the axis.
template <class T>
inline __attribute__((always_inline)) void multiply_stresses(pack<T> (&stress)[3][3], int axis, pack<T> d,
                                                             pack<T> a, pack<T> g, T*& state) {
  for (int j = 0; j < 3; ++j) {
    if (j == axis) continue;
    for (int c = 0; c < 3; ++c) stress[c][j] += d * filter<T>(a, g, stress[c][j], state);
  }
}

template <class T>
inline __attribute__((always_inline)) void compute_stress(const pack<T> (&gradient)[3][3], T lambda, T mu,
                                                          pack<T> (&stress)[3][3]) {
  const pack<T> pressure = lambda * (gradient[0][0] + gradient[1][1] + gradient[2][2]);
  for (int c = 0; c < 3; ++c) {
    for (int j = 0; j < 3; ++j) stress[c][j] = mu * (gradient[c][j] + gradient[j][c]);
    stress[c][c] += pressure;
  }
}

template <class T, int N>
void apply_stretched(const StretchedRow<T>& row) {
  static const ElementRule<T, N> rule;
  constexpr int n = N + 1;
  using V = pack<T>;
  V w[3][n][n][n];        // [component][k][j][i]
  V flux[3][3][n][n][n];  // |J| w_q stress times the slope of its direction, [component][direction]
  const T slope_y = 2 / row.hy, slope_z = 2 / row.hz;
  const V a = row.a + V{}, g = row.g + V{};
  T* state = row.state;

  for (int p = 0; p < row.pack_count; ++p) {
    const int e = row.packs[p].first;
    const bool stretched_x = row.packs[p].stretched_x;
    for (int c = 0; c < 3; ++c)
      for (int k = 0; k < n; ++k)
        for (int j = 0; j < n; ++j)
          for (int i = 0; i < n; ++i)
            w[c][k][j][i] = load_pack(row.w[k * n + j] +
                                      (i < N ? (c * N + i) * row.stride + e : c * N * row.stride + e + 1));

    const V slope_x = load_pack(row.slope_x + e);
    const V jacobian = load_pack(row.hx + e) * (row.hy * row.hz / 8);
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
          V gradient[3][3], stress[3][3], plain[3][3];  // gradient: d w_c / d x_j
          for (int c = 0; c < 3; ++c) {
            V dx{}, dy{}, dz{};
            for (int b = 0; b < n; ++b) {
              dx += rule.D[i][b] * w[c][k][j][b];
              dy += rule.D[j][b] * w[c][k][b][i];
              dz += rule.D[k][b] * w[c][b][j][i];
            }
            gradient[c][0] = slope_x * dx;
            gradient[c][1] = slope_y * dy;
            gradient[c][2] = slope_z * dz;
          }
          if (row.subtracts_plain) compute_stress<T>(gradient, row.lambda, row.mu, plain);

          const int at_x = i < N ? i * row.stride + e : e + 1;
          const V d_x = load_pack(row.d_x + at_x), d_y = row.d_y[j] + V{}, d_z = row.d_z[k] + V{};
          if (stretched_x)
            divide_gradients<T>(gradient, 0, d_x, load_pack(row.a_x + at_x), load_pack(row.g_x + at_x),
                                state);
          if (row.stretched_y)
            divide_gradients<T>(gradient, 1, d_y, row.a_y[j] + V{}, row.g_y[j] + V{}, state);
          if (row.stretched_z)
            divide_gradients<T>(gradient, 2, d_z, row.a_z[k] + V{}, row.g_z[k] + V{}, state);
          compute_stress<T>(gradient, row.lambda, row.mu, stress);
          if (stretched_x) multiply_stresses<T>(stress, 0, d_x, a, g, state);
          if (row.stretched_y) multiply_stresses<T>(stress, 1, d_y, a, g, state);
          if (row.stretched_z) multiply_stresses<T>(stress, 2, d_z, a, g, state);

          const V volume = jacobian * (rule.weight[i] * rule.weight[j] * rule.weight[k]);
          const V slope[3] = {volume * slope_x, volume * slope_y, volume * slope_z};
          for (int c = 0; c < 3; ++c)
            for (int d = 0; d < 3; ++d)
              flux[c][d][k][j][i] =
                  slope[d] * (row.subtracts_plain ? stress[c][d] - plain[c][d] : stress[c][d]);
        }

    for (int c = 0; c < 3; ++c)
      for (int k = 0; k < n; ++k)
        for (int j = 0; j < n; ++j)
          for (int i = 0; i < n; ++i) {
            V force{};
            for (int b = 0; b < n; ++b)
              force += rule.D[b][i] * flux[c][0][k][j][b] + rule.D[b][j] * flux[c][1][k][b][i] +
                       rule.D[b][k] * flux[c][2][b][j][i];
            const int place = i < N ? (c * N + i) * row.stride + e : c * N * row.stride + e + 1;
            const V rmx = load_pack(row.rmx + (i < N ? i * row.stride + e : e + 1));
            T* to = row.f[k * n + j] + place;
            store_pack(to, load_pack(to) + rmx * force);
          }
  }
}

}  // namespace

template <class T>
StretchedFunction<T> find_stretched_function(int degree) {
  switch (degree) {
    case 3:
      return apply_stretched<T, 3>;
    case 4:
      return apply_stretched<T, 4>;
    case 5:
      return apply_stretched<T, 5>;
    case 6:
      return apply_stretched<T, 6>;
    default:
      throw ModelError("spectral elements: the degree must be in 3..6");
  }
}

template StretchedFunction<float> find_stretched_function<float>(int);
template StretchedFunction<double> find_stretched_function<double>(int);

}  // namespace easydyn::soil

#include "soil/element_operator.hpp"

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

template <class T, int N>
void apply_elements(const ElementRow<T>& row) {
  static const ElementRule<T, N> rule;
  constexpr int n = N + 1;
  using V = pack<T>;
  V w[3][n][n][n];        // [component][k][j][i]
  V flux[3][3][n][n][n];  // |J| w_q sigma times the slope of its direction, [component][direction]
  const T slope_y = 2 / row.hy, slope_z = 2 / row.hz;

  const int begin = row.first / Pack<T>::lanes * Pack<T>::lanes;
  for (int e = begin; e < row.last; e += Pack<T>::lanes) {
    V weight[ElementRow<T>::max_parts];
    for (int p = 0; p < row.parts; ++p) weight[p] = load_pack(row.weight[p] + e);
    for (int c = 0; c < 3; ++c)
      for (int k = 0; k < n; ++k)
        for (int j = 0; j < n; ++j)
          for (int i = 0; i < n; ++i) {
            const int place = i < N ? (c * N + i) * row.stride + e : c * N * row.stride + e + 1;
            V sum = weight[0] * load_pack(row.part[0][k * n + j] + place);
            for (int p = 1; p < row.parts; ++p) sum += weight[p] * load_pack(row.part[p][k * n + j] + place);
            w[c][k][j][i] = sum;
          }

    const V slope_x = load_pack(row.slope_x + e), lambda = load_pack(row.lambda + e),
            mu = load_pack(row.mu + e);
    const V jacobian = load_pack(row.hx + e) * (row.hy * row.hz / 8);
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
          V g[3][3];  // d u_c / d x_d
          for (int c = 0; c < 3; ++c) {
            V dx{}, dy{}, dz{};
            for (int a = 0; a < n; ++a) {
              dx += rule.D[i][a] * w[c][k][j][a];
              dy += rule.D[j][a] * w[c][k][a][i];
              dz += rule.D[k][a] * w[c][a][j][i];
            }
            g[c][0] = slope_x * dx;
            g[c][1] = slope_y * dy;
            g[c][2] = slope_z * dz;
          }
          const V volume = jacobian * (rule.weight[i] * rule.weight[j] * rule.weight[k]);
          const V slope[3] = {volume * slope_x, volume * slope_y, volume * slope_z};
          const V pressure = lambda * (g[0][0] + g[1][1] + g[2][2]);
          for (int c = 0; c < 3; ++c)
            for (int d = 0; d < 3; ++d) {
              V stress = mu * (g[c][d] + g[d][c]);
              if (c == d) stress += pressure;
              flux[c][d][k][j][i] = slope[d] * stress;
            }
        }

    for (int c = 0; c < 3; ++c)
      for (int k = 0; k < n; ++k)
        for (int j = 0; j < n; ++j)
          for (int i = 0; i < n; ++i) {
            V force{};
            for (int a = 0; a < n; ++a)
              force += rule.D[a][i] * flux[c][0][k][j][a] + rule.D[a][j] * flux[c][1][k][a][i] +
                       rule.D[a][k] * flux[c][2][a][j][i];
            const int place = i < N ? (c * N + i) * row.stride + e : c * N * row.stride + e + 1;
            const V rmx = load_pack(row.rmx + (i < N ? i * row.stride + e : e + 1));
            T* to = row.f[k * n + j] + place;
            store_pack(to, load_pack(to) + rmx * force);
          }
  }
}

}  // namespace

template <class T>
ElementFunction<T> find_element_function(int degree) {
  switch (degree) {
    case 3:
      return apply_elements<T, 3>;
    case 4:
      return apply_elements<T, 4>;
    case 5:
      return apply_elements<T, 5>;
    case 6:
      return apply_elements<T, 6>;
    default:
      throw ModelError("spectral elements: the degree must be in 3..6");
  }
}

template ElementFunction<float> find_element_function<float>(int);
template ElementFunction<double> find_element_function<double>(int);

}  // namespace easydyn::soil

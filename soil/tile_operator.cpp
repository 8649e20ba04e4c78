#include "soil/tile_operator.hpp"

#include "easydyn/error.hpp"
#include "soil/gll.hpp"

namespace easydyn::soil {

namespace {

#define EASYDYN_INLINE inline __attribute__((always_inline))

/// Line operators on [-1, 1] in the precision of the field.
template <class T, int N>
struct LineOperators {
  static constexpr int n = N + 1;
  T K[n][n], A[n][n];
  LineOperators() {
    const GllRule rule(N);
    const Eigen::MatrixXd stiffness = rule.compute_stiffness();
    const Eigen::MatrixXd gradient = rule.compute_antisymmetric_gradient();
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        K[i][j] = static_cast<T>(stiffness(i, j));
        A[i][j] = static_cast<T>(gradient(i, j));
      }
  }
};

/// sum_j m[j] in[j]
template <int n, class T, class V>
EASYDYN_INLINE V dot(const T (&m)[n], const V (&in)[n]) {
  V sum = m[0] * in[0];
#pragma GCC unroll 8
  for (int j = 1; j < n; ++j) sum += m[j] * in[j];
  return sum;
}

/// Matrices of one row, with material and element sizes in them.
template <class T, int N>
struct RowMatrices {
  static constexpr int n = N + 1;
  T A[n][n];                         // gradient
  T KYs[n][n], KYp[n][n], AY[n][n];  // mu K_y, (lambda + 2 mu) K_y, -(lambda + mu) A
  T KZs[n][n], KZp[n][n];            // same along z
  T H[n][n], HT[n][n];               // -(lambda G_z - mu G_z^T) and minus its transpose
  T J[n][n];                         // lambda G_z + mu G_z^T

  RowMatrices(const Tile<T>& tile, const LineOperators<T, N>& line) {
    const T l = tile.lambda, m = tile.mu;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const T B = i != j ? T(0) : i == 0 ? T(-1) : i == N ? T(1) : T(0);
        A[i][j] = line.A[i][j];
        AY[i][j] = -(l + m) * line.A[i][j];
        KYs[i][j] = m * (2 / tile.hy) * line.K[i][j];
        KYp[i][j] = (l + 2 * m) * (2 / tile.hy) * line.K[i][j];
        KZs[i][j] = m * (2 / tile.hz) * line.K[i][j];
        KZp[i][j] = (l + 2 * m) * (2 / tile.hz) * line.K[i][j];
        H[i][j] = -(l + m) * line.A[i][j] - (l - m) * B / 2;
        HT[i][j] = -(l + m) * line.A[i][j] + (l - m) * B / 2;
        J[i][j] = (l - m) * line.A[i][j] + (l + m) * B / 2;
      }
  }
};

/// Asks for the lines `ahead` in equal portions, so that the memory works while the arithmetic goes on.
template <class T>
class Prefetcher {
 public:
  Prefetcher(const Tile<T>& tile, int line_size, int portions)
      : tile_(tile), line_bytes_(line_size * static_cast<int>(sizeof(T))) {
    const int total = tile.ahead_count * ((line_bytes_ + 63) / 64);
    portion_ = (total + portions - 1) / portions;
  }
  EASYDYN_INLINE void fetch() {
    for (int p = 0; p < portion_ && line_ < tile_.ahead_count; ++p) {
      __builtin_prefetch(reinterpret_cast<const char*>(tile_.ahead[line_]) + offset_, 0, 2);
      offset_ += 64;
      if (offset_ >= line_bytes_) {
        offset_ = 0;
        ++line_;
      }
    }
  }

 private:
  const Tile<T>& tile_;
  int line_bytes_, portion_, line_ = 0, offset_ = 0;
};

/// Terms of the outer faces x = const and y = const for node i of one pack of elements.
template <class T, int N>
void add_end_terms(const Tile<T>& tile, const RowMatrices<T, N>& row, int i, int e, const pack<T>* gx,
                   pack<T>* f) {
  constexpr int n = N + 1, nn = n * n;
  using V = pack<T>;
  const T l = tile.lambda, m = tile.mu;
  const auto w = [&](int c, int k, int j) {
    return load_pack(tile.w[k * n + j] + (c * N + i) * tile.stride + e);
  };
  const V zero{};
  const V g = i == 0 ? load_pack(tile.x_end + e) : zero;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j) {
      const T gy = tile.gradient_end[j], mz = tile.mz[k], my = tile.my[j];
      V dy_uy = zero, dy_ux = zero, dz_uz = zero, dzt_ux = zero, dzt_uy = zero;
      for (int p = 0; p < n; ++p) {
        dy_uy += row.A[j][p] * w(1, k, p);
        dy_ux += row.A[j][p] * w(0, k, p);
        dz_uz += row.J[k][p] * w(2, p, j);
        dzt_ux += row.J[p][k] * w(0, p, j);
        dzt_uy += row.J[p][k] * w(1, p, j);
      }
      f[k * n + j] += g * (mz * (l - m) * dy_uy + my * dz_uz + (l + m) * mz * gy * w(1, k, j)) -
                      (l - m) * mz * gy * gx[nn + k * n + j];
      f[nn + k * n + j] += gy * ((l - m) * mz * gx[k * n + j] + dz_uz) -
                           g * ((l - m) * mz * dy_ux - (l + m) * mz * gy * w(0, k, j));
      f[2 * nn + k * n + j] += g * (my * dzt_ux) + gy * dzt_uy;
    }
}

/// Node i of the elements e .. e + lanes - 1 of the row; `first` means i == 0, which the element to the left
/// shares.
template <class T, int N, bool first>
EASYDYN_INLINE void apply_node(const Tile<T>& tile, const LineOperators<T, N>& line,
                               const RowMatrices<T, N>& row, int i, int e, Prefetcher<T>& ahead) {
  constexpr int n = N + 1, nn = n * n;
  using V = pack<T>;
  const int stride = tile.stride;
  const V zero{};
  const T s = tile.mu, p = tile.lambda + 2 * tile.mu, sum = tile.lambda + tile.mu;
  V f[3 * nn], gx[3 * nn];  // result and (d/dx w) / m_x, [component][k][j]

  // Along x: every line apart.
  const V rmx = load_pack(tile.rmx + i * stride + e), kx = load_pack(tile.kx + i * stride + e);
  const V kx_left = first ? load_pack(tile.kx_left + e) : zero;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j) {
      const T* from = tile.w[k * n + j] + e;
      const T weight = tile.my[j] * tile.mz[k];
      ahead.fetch();
#pragma GCC unroll 3
      for (int c = 0; c < 3; ++c, from += N * stride) {
        V in[n];
#pragma GCC unroll 8
        for (int a = 0; a < N; ++a) in[a] = load_pack(from + a * stride);
        in[N] = load_pack(from + 1);
        V g = dot(line.A[i], in), d = kx * dot(line.K[i], in);
        if constexpr (first) {
          V left[n];
#pragma GCC unroll 8
          for (int a = 0; a < N; ++a) left[a] = load_pack(from + a * stride - 1);
          left[N] = in[0];
          g += dot(line.A[N], left);
          d += kx_left * dot(line.K[N], left);
        }
        gx[c * nn + k * n + j] = rmx * g;
        f[c * nn + k * n + j] = (weight * (c == 0 ? p : s)) * d;
      }
    }

  // Along z: column by column; q collects what d/dy acts on for f_y.
  V q[nn];
  for (int j = 0; j < n; ++j) {
    const T* const* lines = tile.w + j;
    const int offset = i * stride + e, component = N * stride;
    const T my = tile.my[j];
    V in[n], g[n];
#pragma GCC unroll 8
    for (int k = 0; k < n; ++k) in[k] = load_pack(lines[k * n] + offset + 2 * component);
#pragma GCC unroll 8
    for (int k = 0; k < n; ++k) {
      q[k * n + j] = (sum * tile.mz_element[k]) * gx[k * n + j] - dot(row.H[k], in);
      f[2 * nn + k * n + j] += my * dot(row.KZp[k], in);
    }
    if (j >= tile.j_end) continue;
#pragma GCC unroll 8
    for (int k = 0; k < n; ++k) {
      in[k] = load_pack(lines[k * n] + offset);
      g[k] = gx[2 * nn + k * n + j];
    }
#pragma GCC unroll 8
    for (int k = 0; k < n; ++k) f[k * n + j] += my * (dot(row.KZs[k], in) + dot(row.H[k], g));
#pragma GCC unroll 8
    for (int k = 0; k < n; ++k) in[k] = load_pack(lines[k * n] + offset + component);
#pragma GCC unroll 8
    for (int k = 0; k < n; ++k) f[nn + k * n + j] += my * dot(row.KZs[k], in);
  }

  // Along y: column by column; r collects what d/dz acts on for f_z.
  V r[nn];
  for (int k = 0; k < n; ++k) {
    const T* const* lines = tile.w + k * n;
    const int offset = i * stride + e, component = N * stride;
    const T mz = tile.mz[k];
    V in[n], g[n];
#pragma GCC unroll 8
    for (int j = 0; j < n; ++j) {
      in[j] = load_pack(lines[j] + offset + component);
      g[j] = q[k * n + j];
    }
#pragma GCC unroll 8
    for (int j = 0; j < n; ++j) {
      r[k * n + j] = tile.my_element[j] * gx[k * n + j] + dot(row.A[j], in);
      f[nn + k * n + j] += mz * dot(row.KYp[j], in) - dot(row.A[j], g);
    }
    if (k >= tile.k_end) continue;
#pragma GCC unroll 8
    for (int j = 0; j < n; ++j) {
      in[j] = load_pack(lines[j] + offset);
      g[j] = gx[nn + k * n + j];
    }
#pragma GCC unroll 8
    for (int j = 0; j < n; ++j) f[k * n + j] += mz * (dot(row.KYs[j], in) + dot(row.AY[j], g));
#pragma GCC unroll 8
    for (int j = 0; j < n; ++j) in[j] = load_pack(lines[j] + offset + 2 * component);
#pragma GCC unroll 8
    for (int j = 0; j < n; ++j) f[2 * nn + k * n + j] += mz * dot(row.KYs[j], in);
  }

  // Along z again, for f_z.
  for (int j = 0; j < n; ++j) {
    V g[n];
#pragma GCC unroll 8
    for (int k = 0; k < n; ++k) g[k] = r[k * n + j];
#pragma GCC unroll 8
    for (int k = 0; k < n; ++k) f[2 * nn + k * n + j] += dot(row.HT[k], g);
  }

  if (tile.y_end || (first && (e == 0 || (e <= tile.last_lane && tile.last_lane < e + Pack<T>::lanes))))
    add_end_terms<T, N>(tile, row, i, e, gx, f);

  for (int a = 0; a < nn; ++a)
#pragma GCC unroll 3
    for (int c = 0; c < 3; ++c) {
      T* to = tile.f[a] + (c * N + i) * stride + e;
      store_pack(to, tile.add[a] ? load_pack(to) + f[c * nn + a] : f[c * nn + a]);
    }
}

template <class T, int N>
void apply_tile(const Tile<T>& tile) {
  static const LineOperators<T, N> line;
  const RowMatrices<T, N> row(tile, line);
  Prefetcher<T> ahead(tile, 3 * N * tile.stride, (N + 1) * (N + 1) * N * tile.stride / Pack<T>::lanes);
  for (int e = 0; e < tile.stride; e += Pack<T>::lanes) {
    apply_node<T, N, true>(tile, line, row, 0, e, ahead);
    for (int i = 1; i < N; ++i) apply_node<T, N, false>(tile, line, row, i, e, ahead);
  }
}

}  // namespace

template <class T>
TileFunction<T> find_tile_function(int degree) {
  switch (degree) {
    case 3:
      return apply_tile<T, 3>;
    case 4:
      return apply_tile<T, 4>;
    case 5:
      return apply_tile<T, 5>;
    case 6:
      return apply_tile<T, 6>;
    default:
      throw ModelError("spectral elements: the degree must be in 3..6");
  }
}

template TileFunction<float> find_tile_function<float>(int);
template TileFunction<double> find_tile_function<double>(int);

}  // namespace easydyn::soil

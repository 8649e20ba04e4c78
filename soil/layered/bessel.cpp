#include "soil/layered/bessel.hpp"

#include <math.h>  // j0, j1, y0, y1: not in <cmath>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>

#include "soil/simd.hpp"

namespace easydyn::soil {
namespace {

using Eigen::Index;
using V = pack<double>;
constexpr double pi = std::numbers::pi;
constexpr double split = 10;  // between both forms
constexpr int lanes = Pack<double>::lanes;

/// Chebyshev series on [-1, 1].
template <std::size_t N>
struct Series {
  std::array<double, N> c;

  template <class Function>
  explicit Series(const Function& f) {
    constexpr int samples = 64;
    c.fill(0);
    for (int i = 0; i < samples; ++i) {
      const double angle = pi * (i + 0.5) / samples, value = f(std::cos(angle));
      for (std::size_t m = 0; m < N; ++m)
        c[m] += (m == 0 ? 1.0 : 2.0) / samples * value * std::cos(angle * static_cast<double>(m));
    }
  }
  /// Clenshaw's recurrence; t2 = 2 t.
  V operator()(V t2) const {
    V b1{}, b2{};
#pragma GCC unroll 32
    for (std::size_t m = N - 1; m > 0; --m) {
      const V b = c[m] + t2 * b1 - b2;
      b2 = b1;
      b1 = b;
    }
    return c[0] + 0.5 * t2 * b1 - b2;
  }
};

struct Coefficients {
  // t = 2 (x / split)^2 - 1 and t = 2 (split / x)^2 - 1
  Series<22> J0{[](double t) { return ::j0(near(t)); }};
  Series<22> J1{[](double t) { return ::j1(near(t)) / near(t); }};  // J1 / x
  Series<14> P0{[](double t) { return far(t, 0).first; }}, Q0{[](double t) { return far(t, 0).second; }};
  Series<14> P1{[](double t) { return far(t, 1).first; }}, Q1{[](double t) { return far(t, 1).second; }};

 private:
  static double near(double t) { return split * std::sqrt((t + 1) / 2); }
  static std::pair<double, double> far(double t, int n) {  // P, x Q
    const double x = split / std::sqrt((t + 1) / 2), scale = std::sqrt(pi * x / 2);
    const double angle = x - (2 * n + 1) * pi / 4, c = std::cos(angle), s = std::sin(angle);
    const double J = n == 0 ? ::j0(x) : ::j1(x), Y = n == 0 ? ::y0(x) : ::y1(x);
    return {scale * (J * c + Y * s), x * scale * (Y * c - J * s)};
  }
};

/// Taylor's series in y^2 of sin y / y (first = 1) and cos y (first = 0), |y| <= pi / 2.
V sum_taylor(V y2, int first) {
  V sum{};
  sum += 1.0;
#pragma GCC unroll 16
  for (int m = 10; m > 0; --m) {
    const double divisor = (2 * m + first) * (2 * m + first - 1);
    sum = 1.0 - y2 * (sum * (1 / divisor));
  }
  return sum;
}

struct SinCos {
  V s, c;
};
SinCos compute_sin_cos(V x) {
  typedef long long Bits __attribute__((vector_size(simd_bytes)));
  constexpr double round = 6755399441055744.0;  // 1.5 x 2^52: adding it rounds to whole numbers
  constexpr double pi_high = 3.14159265346825122833,
                   pi_low = 1.21542010130123852e-10;  // pi, 33 bits and the rest
  const V shifted = x * (1 / pi) + round, multiple = shifted - round;
  const V y = (x - multiple * pi_high) - multiple * pi_low, y2 = y * y;
  Bits parity;
  std::memcpy(&parity, &shifted, sizeof parity);
  parity <<= 63;  // odd multiples of pi change both signs
  V s = y * sum_taylor(y2, 1), c = sum_taylor(y2, 0);
  Bits bits;
  for (V* value : {&s, &c}) {
    std::memcpy(&bits, value, sizeof bits);
    bits ^= parity;
    std::memcpy(value, &bits, sizeof bits);
  }
  return {s, c};
}

struct Pair {
  V J0, J1;
};

Pair compute_near(const Coefficients& of, V x) {
  const V t2 = x * x * (4 / (split * split)) - 2.0;
  return {of.J0(t2), x * of.J1(t2)};
}

Pair compute_far(const Coefficients& of, V x) {
  V scale;
  for (int l = 0; l < lanes; ++l) scale[l] = std::sqrt(x[l]);
  const V inverse = 1.0 / x, t2 = inverse * inverse * (4 * split * split) - 2.0;
  scale *= inverse * (1 / std::sqrt(pi));
  const auto [s, c] = compute_sin_cos(x);
  // cos and sin of x - pi / 4 and x - 3 pi / 4 times sqrt(2)
  return {scale * (of.P0(t2) * (c + s) - inverse * of.Q0(t2) * (s - c)),
          scale * (of.P1(t2) * (s - c) + inverse * of.Q1(t2) * (s + c))};
}

// The last, shorter group is filled up with `fill`.
template <class Function>
void update_groups(const double* x, Index count, double fill, double* J0, double* J1, const Function& f) {
  Index i = 0;
  for (; i + lanes <= count; i += lanes) {
    const Pair J = f(load_pack(x + i));
    store_pack(J0 + i, J.J0);
    store_pack(J1 + i, J.J1);
  }
  if (i == count) return;
  V rest{};
  rest += fill;
  for (int l = 0; i + l < count; ++l) rest[l] = x[i + l];
  const Pair J = f(rest);
  for (int l = 0; i + l < count; ++l) {
    J0[i + l] = J.J0[l];
    J1[i + l] = J.J1[l];
  }
}

}  // namespace

void update_bessel(const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Ref<Eigen::VectorXd> J0,
                   Eigen::Ref<Eigen::VectorXd> J1) {
  static const Coefficients coefficients;
  const Index beyond = std::lower_bound(x.data(), x.data() + x.size(), split) - x.data();
  update_groups(x.data(), beyond, 0, J0.data(), J1.data(), [](V v) { return compute_near(coefficients, v); });
  update_groups(x.data() + beyond, x.size() - beyond, split, J0.data() + beyond, J1.data() + beyond,
                [](V v) { return compute_far(coefficients, v); });
}

}  // namespace easydyn::soil

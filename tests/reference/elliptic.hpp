#pragma once

#include <cmath>

/// Jacobi's elliptic functions by the arithmetic-geometric mean (Abramowitz & Stegun, 16.4 and 17.6).
namespace reference {

/// Complete integral of the first kind, by the complementary modulus k' = sqrt(1 - k^2).
inline double complete_elliptic_integral(double k_complement) {
  double a = 1, b = k_complement;
  for (int i = 0; i < 12; ++i) {
    const double mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
  }
  return M_PI / (2 * a);
}

/// The amplitude am(u, k): sn = sin(am), cn = cos(am). The complementary modulus keeps its digits near k = 1.
inline double jacobi_amplitude(double u, double k, double k_complement) {
  constexpr int n = 12;
  double a[n + 1] = {1}, b = k_complement, c[n + 1] = {k};
  for (int i = 0; i < n; ++i) {
    a[i + 1] = (a[i] + b) / 2;
    c[i + 1] = (a[i] - b) / 2;
    b = std::sqrt(a[i] * b);
  }
  double phi = std::ldexp(a[n] * u, n);
  for (int i = n; i > 0; --i) phi = (phi + std::asin(c[i] / a[i] * std::sin(phi))) / 2;
  return phi;
}

}  // namespace reference

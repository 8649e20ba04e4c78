#pragma once
// Private to track: cells of spectra are integrated, not sampled.

#include <array>

namespace easydyn::track {

/// Integral of f from a to b by Gauss's rule with 5 points: exact for polynomials up to degree 9.
template <class Function>
double integrate_gauss(double a, double b, Function&& f) {
  constexpr std::array x = {0.0, 0.5384693101056831, 0.9061798459386640};
  constexpr std::array w = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
  const double middle = 0.5 * (a + b), half = 0.5 * (b - a);
  return half * (w[0] * f(middle) + w[1] * (f(middle - half * x[1]) + f(middle + half * x[1])) +
                 w[2] * (f(middle - half * x[2]) + f(middle + half * x[2])));
}

}  // namespace easydyn::track

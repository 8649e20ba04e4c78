#pragma once

#include "track/profile.hpp"

namespace easydyn::track {

/// Smooth passage from 0 to 1, twice continuously differentiable: T(t) = 10 t^3 - 15 t^4 + 6 t^5 for 0 <= t <= 1,
/// where t = (x - x0) / length, 0 before and 1 behind. Its derivatives are with respect to x.
/// @param length  [m], >= 0; 0: a jump at x0, which belongs to the side ahead
inline ProfilePoint smooth_step(double x, double x0, double length) {
  if (x < x0) return {};
  if (x >= x0 + length) return {1, 0, 0};
  const double t = (x - x0) / length, u = 1 - t;
  return {t * t * t * (10 + t * (6 * t - 15)), 30 * t * t * u * u / length,
          60 * t * u * (1 - 2 * t) / (length * length)};
}

/// Product of two functions of x with its derivatives.
inline ProfilePoint product(const ProfilePoint& a, const ProfilePoint& b) {
  return {a.r * b.r, a.dr * b.r + a.r * b.dr, a.ddr * b.r + 2 * a.dr * b.dr + a.r * b.ddr};
}

/// Factor that brings a profile up from 0 at `begin` and down to 0 at `end`, over the given lengths [m]; 0
/// outside. A length of 0 is a jump.
struct Taper {
  double begin = 0, end = 0;
  double begin_length = 0, end_length = 0;

  ProfilePoint at(double x) const {
    if (x < begin || x > end) return {};
    const ProfilePoint up = smooth_step(x, begin, begin_length), down = smooth_step(-x, -end, end_length);
    return product(up, {down.r, -down.dr, down.ddr});
  }
};

}  // namespace easydyn::track

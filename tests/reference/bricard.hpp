#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

/// Motion of Bricard's mechanism of six equal rods with perpendicular axes (the edges of a cube, at the start) from a
/// closed form of its configuration: shares nothing with loops and frames.
///
/// The six joints lie by threes on two circles of radii a and b about one axis, h apart along it. Rods of length 1 and
/// axes across each other, each normal to both its rods, demand
///
///   a^2 + b^2 - a b + h^2 = 1        h^2 = 2 (a - b/2) (b - a/2)        =>   a b = 2/3,  (a - b)^2 + h^2 = 1/3
///
/// so that one angle s describes every position: a - b = sin(s) / sqrt(3), h = cos(s) / sqrt(3), cube at s = 0. The
/// axis in the first joint lies along (1, 0, -h / (2 b - a)) where the joint is at (a, 0, h).
namespace reference {

/// Value and two derivatives of a function of s.
struct Taylor {
  double f = 0, f1 = 0, f2 = 0;
  friend Taylor operator+(const Taylor& a, const Taylor& b) { return {a.f + b.f, a.f1 + b.f1, a.f2 + b.f2}; }
  friend Taylor operator-(const Taylor& a, const Taylor& b) { return {a.f - b.f, a.f1 - b.f1, a.f2 - b.f2}; }
  friend Taylor operator*(const Taylor& a, const Taylor& b) {
    return {a.f * b.f, a.f1 * b.f + a.f * b.f1, a.f2 * b.f + 2 * a.f1 * b.f1 + a.f * b.f2};
  }
  /// f^p of this.
  Taylor power(double p) const {
    const double g = std::pow(f, p), g1 = p * std::pow(f, p - 1), g2 = p * (p - 1) * std::pow(f, p - 2);
    return {g, g1 * f1, g2 * f1 * f1 + g1 * f2};
  }
};
using TaylorVector = std::array<Taylor, 3>;
inline Taylor dot(const TaylorVector& a, const TaylorVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline TaylorVector cross(const TaylorVector& a, const TaylorVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Five rods of 1 kg and 1 m between the joints 0 to 5, the sixth, from joint 5 to joint 0, is the ground: joint 0 at the
/// origin with its axis along y, joint 5 at (0, 0, 1). Gravity along -y; at rest at s = 0.
class Bricard {
 public:
  static constexpr double g = 9.81;

  /// Joints in ground axes.
  static std::array<TaylorVector, 6> joints(double s) {
    const Taylor h{std::cos(s) / std::sqrt(3), -std::sin(s) / std::sqrt(3), -std::cos(s) / std::sqrt(3)};
    const Taylor d{std::sin(s) / std::sqrt(3), std::cos(s) / std::sqrt(3), -std::sin(s) / std::sqrt(3)};
    const Taylor half{0.5}, sum = (d * d + Taylor{8.0 / 3}).power(0.5), a = half * (sum + d),
                            b = half * (sum - d);
    std::array<TaylorVector, 6> P;
    for (std::size_t i = 0; i < 6; ++i) {
      const double angle = M_PI / 3 * static_cast<double>(i);
      const Taylor r = i % 2 ? b : a;
      P[i] = {r * Taylor{std::cos(angle)}, r * Taylor{std::sin(angle)}, i % 2 ? Taylor{} : h};
    }
    // Ground axes: z along the sixth rod, y along the axis of joint 0.
    const Taylor slope = h * (Taylor{2} * b - a).power(-1), scale = (Taylor{1} + slope * slope).power(-0.5);
    TaylorVector z;
    for (std::size_t k = 0; k < 3; ++k) z[k] = P[5][k] - P[0][k];
    const TaylorVector y{scale, Taylor{}, Taylor{-1} * scale * slope}, x = cross(y, z), origin = P[0];
    for (TaylorVector& p : P) {
      const TaylorVector c{p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]};
      p = {dot(c, x), dot(c, y), dot(c, z)};
    }
    return P;
  }

  /// s.. from the energy T = M(s) s.^2 / 2 and V(s): M s.. + M' s.^2 / 2 + V' = 0. A rod with ends A and B has
  /// T = (A.^2 + A. B. + B.^2) / 6.
  static double acceleration(double s, double rate) {
    const auto P = joints(s);
    double M = 0, M1 = 0, V1 = 0;
    for (std::size_t i = 0; i < 5; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Taylor &A = P[i][k], &B = P[i + 1][k];
        M += (A.f1 * A.f1 + A.f1 * B.f1 + B.f1 * B.f1) / 3;
        M1 += (2 * A.f1 * A.f2 + A.f2 * B.f1 + A.f1 * B.f2 + 2 * B.f1 * B.f2) / 3;
      }
      V1 += g * (P[i][1].f1 + P[i + 1][1].f1) / 2;
    }
    return -(M1 * rate * rate / 2 + V1) / M;
  }

  /// One step of the classical Runge-Kutta method.
  void step(double dt) {
    const double a1 = acceleration(s, rate), v2 = rate + dt / 2 * a1,
                 a2 = acceleration(s + dt / 2 * rate, v2), v3 = rate + dt / 2 * a2,
                 a3 = acceleration(s + dt / 2 * v2, v3), v4 = rate + dt * a3,
                 a4 = acceleration(s + dt * v3, v4);
    s += dt / 6 * (rate + 2 * v2 + 2 * v3 + v4);
    rate += dt / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }

  double s = 0, rate = 0;
};

}  // namespace reference

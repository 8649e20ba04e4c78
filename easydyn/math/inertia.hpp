#pragma once

#include <Eigen/Core>

namespace easydyn {

/// Mass [kg] and inertia about the centre of mass, in body axes [kg m^2].
/// A body's frame has its origin at the centre of mass.
struct Inertia {
  double mass = 0;
  Eigen::Matrix3d J = Eigen::Matrix3d::Zero();

  Inertia() = default;
  /// Point mass, or for plane motion a body with the same moment of inertia J about every axis.
  Inertia(double mass_, double J_ = 0) : mass(mass_), J(J_ * Eigen::Matrix3d::Identity()) {}  // NOLINT
  /// Principal moments.
  Inertia(double mass_, double Jxx, double Jyy, double Jzz)
      : mass(mass_), J(Eigen::Vector3d(Jxx, Jyy, Jzz).asDiagonal()) {}
  Inertia(double mass_, const Eigen::Matrix3d& J_) : mass(mass_), J(J_) {}

  /// Homogeneous box with edges a, b, c along x, y, z [m].
  static Inertia box(double mass, double a, double b, double c) {
    return {mass, mass * (b * b + c * c) / 12, mass * (a * a + c * c) / 12, mass * (a * a + b * b) / 12};
  }
  /// Homogeneous cylinder of radius r and length l along y (a wheel) [m].
  static Inertia cylinder_y(double mass, double r, double l) {
    const double transverse = mass * (3 * r * r + l * l) / 12;
    return {mass, transverse, mass * r * r / 2, transverse};
  }
  /// Thin rod of length l along z [m].
  static Inertia rod_z(double mass, double l) { return {mass, mass * l * l / 12, mass * l * l / 12, 0}; }
  /// Homogeneous sphere of radius r [m].
  static Inertia sphere(double mass, double r) { return {mass, 0.4 * mass * r * r}; }
};

}  // namespace easydyn

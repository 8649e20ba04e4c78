#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

/// Six-dimensional vectors of rigid-body mechanics, all in world axes and about one common point O that is
/// fixed in space (chosen near the mechanism at each evaluation, so that no digit is lost far from the
/// origin). Reference: R. Featherstone, Rigid Body Dynamics Algorithms, Springer, 2008, ch. 2.
namespace easydyn::spatial {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Motion: angular velocity w [rad/s] and velocity v [m/s] of the body-fixed point that passes through O.
struct Twist {
  Vector3d w = Vector3d::Zero(), v = Vector3d::Zero();
  Twist& operator+=(const Twist& b) {
    w += b.w;
    v += b.v;
    return *this;
  }
  friend Twist operator*(double a, const Twist& b) { return {a * b.w, a * b.v}; }
};

/// Force: moment about O [N m] and force [N].
struct Wrench {
  Vector3d moment = Vector3d::Zero(), force = Vector3d::Zero();
  Wrench& operator+=(const Wrench& b) {
    moment += b.moment;
    force += b.force;
    return *this;
  }
  Wrench& operator-=(const Wrench& b) {
    moment -= b.moment;
    force -= b.force;
    return *this;
  }
};

/// Power of a wrench on a twist.
inline double dot(const Twist& a, const Wrench& f) {
  return a.w.dot(f.moment) + a.v.dot(f.force);
}

/// Rate of a motion vector b carried along by the motion a:  a x b.
inline Twist cross(const Twist& a, const Twist& b) {
  return {a.w.cross(b.w), a.w.cross(b.v) + a.v.cross(b.w)};
}
/// Rate of a force vector f carried along by the motion a:  a x* f.
inline Wrench cross(const Twist& a, const Wrench& f) {
  return {a.w.cross(f.moment) + a.v.cross(f.force), a.w.cross(f.force)};
}

/// Inertia about O: mass [kg], first moment m c [kg m], rotational inertia about O [kg m^2].
struct Inertia {
  double mass = 0;
  Vector3d first = Vector3d::Zero();
  Matrix3d second = Matrix3d::Zero();

  /// Of a body with inertia J_C (world axes) about its centre of mass at c = p_OC.
  static Inertia of_body(double mass, const Vector3d& c, const Matrix3d& J_C) {
    return {mass, mass * c, J_C + mass * (c.dot(c) * Matrix3d::Identity() - c * c.transpose())};
  }
  Inertia& operator+=(const Inertia& b) {
    mass += b.mass;
    first += b.first;
    second += b.second;
    return *this;
  }
  /// Momentum of the motion a.
  friend Wrench operator*(const Inertia& I, const Twist& a) {
    return {I.second * a.w + I.first.cross(a.v), I.mass * a.v + a.w.cross(I.first)};
  }
};

}  // namespace easydyn::spatial

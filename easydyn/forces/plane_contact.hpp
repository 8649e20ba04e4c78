#pragma once

#include <Eigen/Core>
#include <string>

#include "easydyn/forces/friction.hpp"
#include "easydyn/mbs/frame.hpp"

namespace easydyn {

/// Contact of points, spheres and cylinders of a body with a plane: the ground, a table, a moving wall.
///
///   N = k p^n (1 + c p.) >= 0           along the plane's normal; p depth of the lowest point P [m]
///   T = -mu(|v|) N v / |v|              v sliding velocity of the body's material point at P
///
/// (Hunt & Crossley, J. Appl. Mech. 42, 1975): N starts from zero, never pulls; for slow impacts the coefficient of
/// restitution is e = 1 - 2 c v / 3 with the speed v at the touch. n = 3/2 for a sphere after Hertz, 1 linear. The
/// plane is z = 0 of its frame, the normal its z axis; the body is on the side z > 0.
/// Potential energy k p^(n+1) / (n+1), dissipated power (N - k p^n) p. + |T v|.
/// An integrator must resolve the duration of the impact, about pi sqrt(m / k) for n = 1.
class PlaneContact {
 public:
  struct Data {
    double stiffness = 0;       ///< k [N/m^n], > 0
    double exponent = 1;        ///< n, >= 1
    double damping = 0;         ///< c [s/m], >= 0
    FrictionLaw friction = {};  ///< mu
  };

  /// @throws ModelError naming the element, the value and the range
  PlaneContact(std::string name, const Data& data);

  // Each applies the contact forces of one element, in System::forces(); force() and depth() then speak of it.

  /// A point of the body, in its axes [m].
  void apply_point(const Frame& plane, const Frame& body, const Eigen::Vector3d& p_B = {0, 0, 0});
  /// A sphere, its centre in the body's axes. @param radius  [m], > 0
  void apply_sphere(const Frame& plane, const Frame& body, const Eigen::Vector3d& centre_B, double radius);
  /// A cylinder: four points of the rim of each end, of which one is the lowest. Lying it rests on two points,
  /// standing on four. @param half_length  from the centre to an end along the axis [m], >= 0: a disc
  void apply_cylinder(const Frame& plane, const Frame& body, const Eigen::Vector3d& centre_B,
                      const Eigen::Vector3d& axis_B, double radius, double half_length);

  /// Sum on the body, world axes, of the last call [N].
  const Eigen::Vector3d& force() const { return force_; }
  double depth() const { return depth_; }  ///< largest p of the last call, negative: distance [m]
  const std::string& name() const { return name_; }

 private:
  void begin();
  void touch(const Frame& plane, const Frame& body, const Eigen::Vector3d& p_0P);
  std::string name_;
  Data data_;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();
  double depth_ = 0;
};

}  // namespace easydyn

#pragma once

#include <Eigen/Core>
#include <string>

#include "easydyn/math/characteristic.hpp"
#include "easydyn/mbs/frame.hpp"

namespace easydyn {

/// Nonlinear spring and damper in parallel between a point A of one frame and a point B of another.
///
///   F = f(l - l0) + g(l.)           along the line AB, tension positive
///
/// f and g by table or function (`Characteristic`): a progressive spring, a damper with blow-off. l > 0.
/// Potential energy: the integral of f from 0; dissipated power g(l.) l.
class NonlinearSpringDamper {
 public:
  /// @param spring       f(u) [N] of the stretch u = l - l0 [m]
  /// @param damper       g(v) [N] of the rate v = l. [m/s]
  /// @param free_length  l0 [m], >= 0
  NonlinearSpringDamper(std::string name, Characteristic spring, Characteristic damper, double free_length);
  /// Without a damper.
  NonlinearSpringDamper(std::string name, Characteristic spring, double free_length);

  /// Applies the force, in System::forces(). Points in the axes of their frames [m].
  /// @throws ModelError if A and B coincide or the force is not finite
  void apply(const Frame& frame_A, const Eigen::Vector3d& p_A, const Frame& frame_B,
             const Eigen::Vector3d& p_B);

  double force() const { return force_; }    ///< at the last evaluation [N], tension positive
  double length() const { return length_; }  ///< at the last evaluation [m]
  const std::string& name() const { return name_; }

 private:
  std::string name_;
  Characteristic spring_, damper_;
  double free_length_;
  double force_ = 0, length_ = 0;
};

}  // namespace easydyn

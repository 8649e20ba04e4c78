#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "easydyn/forces/stops.hpp"
#include "easydyn/mbs/frame.hpp"

namespace easydyn {

/// Linear torsional spring and damper about an axis of a frame A, between A and a frame B.
///
///   M = k (phi - phi0) + d phi.          on B against the turn, on A along it
///
/// phi is the angle by which B is turned about the axis relative to A [rad]: the coordinate of the joint, where there
/// is one, or measured from the frames (then between -pi and pi). phi. is the relative angular velocity along the
/// axis: give an axis about which B turns relative to A. Stops may bound phi.
/// Potential energy k (phi - phi0)^2 / 2, dissipated power d phi.^2, and those of the stops.
class TorsionalSpringDamper {
 public:
  /// @param stiffness   k [N m/rad], >= 0
  /// @param damping     d [N m s/rad], >= 0
  /// @param free_angle  phi0 [rad]
  /// @throws ModelError naming the element, the value and the range
  TorsionalSpringDamper(std::string name, double stiffness, double damping, double free_angle = 0);

  /// Bounds the angle. @throws ModelError
  TorsionalSpringDamper& set_stops(const Stops& stops);

  /// Applies the moments, in System::forces(). @param axis_A  in the axes of A, need not have unit length
  void apply(const Frame& frame_A, const Frame& frame_B, const Eigen::Vector3d& axis_A, double angle);
  /// The same with the angle measured from the frames.
  void apply(const Frame& frame_A, const Frame& frame_B, const Eigen::Vector3d& axis_A);

  double moment() const { return moment_; }  ///< M at the last evaluation [N m]
  double angle() const { return angle_; }    ///< phi at the last evaluation [rad]
  const std::string& name() const { return name_; }

 private:
  std::string name_;
  double stiffness_, damping_, free_angle_;
  std::optional<Stops> stops_;
  double moment_ = 0, angle_ = 0;
};

/// Angle [rad], between -pi and pi, of the turn of frame B relative to frame A about an axis of A (the twist of the
/// relative rotation about the axis, whatever else it does).
double compute_twist_angle(const Frame& frame_A, const Frame& frame_B, const Eigen::Vector3d& axis_A);

}  // namespace easydyn

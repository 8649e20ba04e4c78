#pragma once

#include <Eigen/Core>
#include <string>

#include "easydyn/mbs/frame.hpp"

namespace easydyn {

/// An actuator: a force between two points or a moment between two frames of the size that a controller or a drive
/// asks for. What it brings in is supplied power: F l. or M w, negative where it brakes.
class Actuator {
 public:
  explicit Actuator(std::string name) : name_(std::move(name)) {}

  /// Pushes the points A and B apart with the force F [N] (negative: pulls), in System::forces().
  /// @throws ModelError if A and B coincide or F is not finite
  void apply_force(const Frame& frame_A, const Eigen::Vector3d& p_A, const Frame& frame_B,
                   const Eigen::Vector3d& p_B, double F);
  /// Turns B about an axis of A with the moment M [N m]; the reverse on A. @throws ModelError if M is not finite
  void apply_moment(const Frame& frame_A, const Frame& frame_B, const Eigen::Vector3d& axis_A, double M);

  double effort() const { return effort_; }  ///< F or M at the last evaluation [N, N m]
  double rate() const { return rate_; }      ///< l. or w at the last evaluation [m/s, rad/s]
  double power() const { return effort_ * rate_; }
  const std::string& name() const { return name_; }

 private:
  std::string name_;
  double effort_ = 0, rate_ = 0;
};

}  // namespace easydyn

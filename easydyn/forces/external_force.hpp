#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>

#include "easydyn/mbs/frame.hpp"

namespace easydyn {

/// A force or a moment from outside, given by a function: wind, a hammer, a rotating unbalance.
///
///     ExternalForce push{"push", [](double t, const Eigen::Vector3d&, const Eigen::Vector3d&) {
///       return Eigen::Vector3d(t < 0.1 ? 50.0 : 0.0, 0, 0); }};
///     void forces() override { push.apply(cart, {0, 0, 0}); }
///
/// Its power F . v (M . w) is supplied power.
class ExternalForce {
 public:
  /// F [N] in world axes, of the time [s] and of position [m] and velocity [m/s] of the point.
  using Function =
      std::function<Eigen::Vector3d(double t, const Eigen::Vector3d& p_0P, const Eigen::Vector3d& v_0P)>;

  ExternalForce(std::string name, Function force) : name_(std::move(name)), function_(std::move(force)) {}

  /// Applies the force at the point P of the frame [m], in System::forces(). @throws ModelError if not finite
  void apply(const Frame& frame, const Eigen::Vector3d& p_P = {0, 0, 0});

  const Eigen::Vector3d& force() const { return force_; }  ///< at the last evaluation [N]
  const std::string& name() const { return name_; }

 private:
  std::string name_;
  Function function_;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();
};

/// A moment from outside, given by a function of the time and of the angular velocity.
class ExternalMoment {
 public:
  /// M [N m] in world axes, of the time [s] and the angular velocity [rad/s] of the frame.
  using Function = std::function<Eigen::Vector3d(double t, const Eigen::Vector3d& w_0F)>;

  ExternalMoment(std::string name, Function moment) : name_(std::move(name)), function_(std::move(moment)) {}

  /// Applies the moment, in System::forces(). @throws ModelError if not finite
  void apply(const Frame& frame);

  const Eigen::Vector3d& moment() const { return moment_; }  ///< at the last evaluation [N m]
  const std::string& name() const { return name_; }

 private:
  std::string name_;
  Function function_;
  Eigen::Vector3d moment_ = Eigen::Vector3d::Zero();
};

}  // namespace easydyn

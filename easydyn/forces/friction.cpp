#include "easydyn/forces/friction.hpp"

#include "easydyn/forces/account.hpp"
#include "easydyn/require.hpp"

namespace easydyn {

using Eigen::Vector3d;

double FrictionLaw::coefficient(double speed) const {
  const double mu_s = sticking < 0 ? sliding : sticking, x = speed / stribeck_speed;
  return (sliding + (mu_s - sliding) * std::exp(-x * x)) * std::tanh(speed / creep_speed);
}

void FrictionLaw::check(const std::string& object) const {
  require_not_negative(object, "sliding friction", sliding, "");
  require(sticking == -1 || sticking >= sliding, object, "sticking friction", sticking, "",
          ">= sliding friction");
  require_positive(object, "creep speed", creep_speed, "m/s");
  require_positive(object, "Stribeck speed", stribeck_speed, "m/s");
}

Friction::Friction(std::string name, const FrictionLaw& law) : name_(std::move(name)), law_(law) {
  law.check("friction \"" + name_ + "\"");
}

Vector3d Friction::axis_0(const Frame& frame_A, const Vector3d& axis_A) const {
  const double length = axis_A.norm();
  require(length > 0, "friction \"" + name_ + "\"", "length of the axis", length, "", "> 0");
  return frame_A.direction(axis_A / length);
}

void Friction::apply_sliding(const Frame& frame_A, const Frame& frame_B, const Vector3d& axis_A,
                             double normal_force) {
  require_not_negative("friction \"" + name_ + "\"", "normal force", normal_force, "N");
  const Vector3d axis = axis_0(frame_A, axis_A), p = frame_B.origin();
  const double v = axis.dot(frame_B.velocity_at(p) - frame_A.velocity_at(p));
  force_ = -law_.coefficient(v) * normal_force;
  frame_B.add_force(force_ * axis, p);
  frame_A.add_force(-force_ * axis, p);
  account(frame_A, frame_B, 0, -force_ * v);
}

void Friction::apply_turning(const Frame& frame_A, const Frame& frame_B, const Vector3d& axis_A,
                             double moment_scale) {
  require_not_negative("friction \"" + name_ + "\"", "radius times normal force", moment_scale, "N m");
  const Vector3d axis = axis_0(frame_A, axis_A);
  const double w = axis.dot(frame_B.angular_velocity() - frame_A.angular_velocity());
  force_ = -law_.coefficient(w) * moment_scale;
  frame_B.add_moment(force_ * axis);
  frame_A.add_moment(-force_ * axis);
  account(frame_A, frame_B, 0, -force_ * w);
}

}  // namespace easydyn

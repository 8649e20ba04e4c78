#include "easydyn/forces/torsional_spring_damper.hpp"

#include <Eigen/Geometry>
#include <numbers>

#include "easydyn/forces/account.hpp"
#include "easydyn/require.hpp"

namespace easydyn {

using Eigen::Vector3d;

double compute_twist_angle(const Frame& frame_A, const Frame& frame_B, const Vector3d& axis_A) {
  const Eigen::Quaterniond turn(Eigen::Matrix3d(frame_A.rotation().transpose() * frame_B.rotation()));
  const double angle = 2 * std::atan2(turn.vec().dot(axis_A.normalized()), turn.w());
  return std::remainder(angle, 2 * std::numbers::pi);
}

TorsionalSpringDamper::TorsionalSpringDamper(std::string name, double stiffness, double damping,
                                             double free_angle)
    : name_(std::move(name)), stiffness_(stiffness), damping_(damping), free_angle_(free_angle) {
  const std::string object = "torsional spring \"" + name_ + "\"";
  require_not_negative(object, "stiffness", stiffness, "N m/rad");
  require_not_negative(object, "damping", damping, "N m s/rad");
  require_finite(object, "free angle", free_angle, "rad");
}

TorsionalSpringDamper& TorsionalSpringDamper::set_stops(const Stops& stops) {
  stops.check("torsional spring \"" + name_ + "\"", "rad");
  stops_ = stops;
  return *this;
}

void TorsionalSpringDamper::apply(const Frame& frame_A, const Frame& frame_B, const Vector3d& axis_A,
                                  double angle) {
  const double length = axis_A.norm();
  require(length > 0, "torsional spring \"" + name_ + "\"", "length of the axis", length, "", "> 0");
  const Vector3d axis = frame_A.direction(axis_A / length);
  angle_ = angle;
  const double rate = axis.dot(frame_B.angular_velocity() - frame_A.angular_velocity());
  const double turn = angle - free_angle_;
  const Stops::Force stop = stops_ ? stops_->compute_force(angle, rate) : Stops::Force{};
  moment_ = stiffness_ * turn + damping_ * rate - stop.force;
  frame_A.add_moment(moment_ * axis);
  frame_B.add_moment(-moment_ * axis);
  account(frame_A, frame_B, 0.5 * stiffness_ * turn * turn + stop.potential,
          damping_ * rate * rate + stop.dissipated);
}

void TorsionalSpringDamper::apply(const Frame& frame_A, const Frame& frame_B, const Vector3d& axis_A) {
  apply(frame_A, frame_B, axis_A, compute_twist_angle(frame_A, frame_B, axis_A));
}

}  // namespace easydyn

#include "easydyn/forces/actuator.hpp"

#include "easydyn/forces/account.hpp"
#include "easydyn/forces/line_of_action.hpp"
#include "easydyn/require.hpp"

namespace easydyn {

using Eigen::Vector3d;

void Actuator::apply_force(const Frame& frame_A, const Vector3d& p_A, const Frame& frame_B,
                           const Vector3d& p_B, double F) {
  require_finite("actuator \"" + name_ + "\"", "force", F, "N");
  const LineOfAction line("actuator", name_, frame_A, p_A, frame_B, p_B);
  effort_ = F;
  rate_ = line.rate;
  line.pull(-F);
  account(frame_A, frame_B, 0, 0, power());
}

void Actuator::apply_moment(const Frame& frame_A, const Frame& frame_B, const Vector3d& axis_A, double M) {
  require_finite("actuator \"" + name_ + "\"", "moment", M, "N m");
  const double length = axis_A.norm();
  require(length > 0, "actuator \"" + name_ + "\"", "length of the axis", length, "", "> 0");
  const Vector3d axis = frame_A.direction(axis_A / length);
  effort_ = M;
  rate_ = axis.dot(frame_B.angular_velocity() - frame_A.angular_velocity());
  frame_B.add_moment(M * axis);
  frame_A.add_moment(-M * axis);
  account(frame_A, frame_B, 0, 0, power());
}

}  // namespace easydyn

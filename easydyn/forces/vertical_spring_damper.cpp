#include "easydyn/forces/vertical_spring_damper.hpp"

#include "easydyn/forces/account.hpp"
#include "easydyn/require.hpp"

namespace easydyn {

using Eigen::Vector3d;

VerticalSpringDamper::VerticalSpringDamper(std::string name, double stiffness, double damping, double height,
                                           double preload)
    : name_(std::move(name)), stiffness_(stiffness), damping_(damping), height_(height), preload_(preload) {
  const std::string object = "spring \"" + name_ + "\"";
  require_not_negative(object, "stiffness", stiffness, "N/m");
  require_not_negative(object, "damping", damping, "N s/m");
  require_finite(object, "height", height, "m");
  require_finite(object, "preload", preload, "N");
}

void VerticalSpringDamper::apply(const Frame& frame_A, const Vector3d& p_A, const Frame& frame_B,
                                 const Vector3d& p_B) {
  const Vector3d p_0A = frame_A.point(p_A), p_0B = frame_B.point(p_B);
  const double rate = (frame_B.velocity_at(p_0B) - frame_A.velocity_at(p_0A)).z();
  extension_ = p_0B.z() - p_0A.z() - height_;
  force_ = preload_ - stiffness_ * extension_ - damping_ * rate;
  frame_A.add_force({0, 0, -force_}, p_0A);
  frame_B.add_force({0, 0, force_}, p_0B);

  account(frame_A, frame_B, 0.5 * stiffness_ * extension_ * extension_ - preload_ * extension_,
          damping_ * rate * rate);
}

}  // namespace easydyn

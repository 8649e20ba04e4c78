#include "easydyn/forces/spring_damper.hpp"

#include <fmt/format.h>

#include "easydyn/error.hpp"
#include "easydyn/mbs/motion_tree.hpp"
#include "easydyn/require.hpp"

namespace easydyn {

using Eigen::Vector3d;

SpringDamper::SpringDamper(std::string name, double stiffness, double damping, double free_length)
    : name_(std::move(name)), stiffness_(stiffness), damping_(damping), free_length_(free_length) {
  const std::string object = "spring \"" + name_ + "\"";
  require_not_negative(object, "stiffness", stiffness, "N/m");
  require_not_negative(object, "damping", damping, "N s/m");
  require_not_negative(object, "free length", free_length, "m");
}

void SpringDamper::apply(const Frame& frame_A, const Vector3d& p_A, const Frame& frame_B,
                         const Vector3d& p_B) {
  const Vector3d p_0A = frame_A.point(p_A), p_0B = frame_B.point(p_B);
  const Vector3d p_AB = p_0B - p_0A;
  length_ = p_AB.norm();
  if (!(length_ > 0)) throw ModelError(fmt::format("spring \"{}\": its ends coincide, no direction", name_));

  const Vector3d e = p_AB / length_;
  const double rate = e.dot(frame_B.velocity_at(p_0B) - frame_A.velocity_at(p_0A));
  force_ = stiffness_ * (length_ - free_length_) + damping_ * rate;
  frame_A.add_force(force_ * e, p_0A);
  frame_B.add_force(-force_ * e, p_0B);

  MotionTree* tree = frame_A.tree() ? frame_A.tree() : frame_B.tree();
  if (tree) {
    const double stretch = length_ - free_length_;
    tree->energy().potential += 0.5 * stiffness_ * stretch * stretch;
    tree->energy().dissipated += damping_ * rate * rate;
  }
}

}  // namespace easydyn

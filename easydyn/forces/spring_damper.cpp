#include "easydyn/forces/spring_damper.hpp"

#include <fmt/format.h>

#include "easydyn/error.hpp"
#include "easydyn/mbs/motion_tree.hpp"

namespace easydyn {

using Eigen::Vector3d;

SpringDamper::SpringDamper(std::string name, double stiffness, double damping, double free_length)
    : name_(std::move(name)), stiffness_(stiffness), damping_(damping), free_length_(free_length) {
  if (!(stiffness >= 0))
    throw ModelError(fmt::format("spring \"{}\": k = {} N/m, must be >= 0", name_, stiffness));
  if (!(damping >= 0))
    throw ModelError(fmt::format("spring \"{}\": d = {} N s/m, must be >= 0", name_, damping));
  if (!(free_length >= 0))
    throw ModelError(fmt::format("spring \"{}\": free length = {} m, must be >= 0", name_, free_length));
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

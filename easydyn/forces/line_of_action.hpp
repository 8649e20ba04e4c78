#pragma once
// Private to easydyn/forces: what elements between two points have in common.

#include <fmt/format.h>

#include <string_view>

#include "easydyn/error.hpp"
#include "easydyn/mbs/frame.hpp"

namespace easydyn {

/// The line from the point A of one frame to the point B of another: its length and its rate.
struct LineOfAction {
  const Frame &frame_A, &frame_B;
  Eigen::Vector3d p_0A, p_0B, direction;
  double length, rate;

  /// @throws ModelError if A and B coincide
  LineOfAction(std::string_view kind, std::string_view name, const Frame& A, const Eigen::Vector3d& p_A,
               const Frame& B, const Eigen::Vector3d& p_B)
      : frame_A(A), frame_B(B), p_0A(A.point(p_A)), p_0B(B.point(p_B)) {
    const Eigen::Vector3d p_AB = p_0B - p_0A;
    length = p_AB.norm();
    if (!(length > 0))
      throw ModelError(fmt::format("{} \"{}\": its ends coincide, no direction", kind, name));
    direction = p_AB / length;
    rate = direction.dot(B.velocity_at(p_0B) - A.velocity_at(p_0A));
  }

  /// Pulls the ends together with the force F [N].
  void pull(double F) const {
    frame_A.add_force(F * direction, p_0A);
    frame_B.add_force(-F * direction, p_0B);
  }
};

}  // namespace easydyn

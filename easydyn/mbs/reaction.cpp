#include "easydyn/mbs/system.hpp"

namespace easydyn {

Frame Reaction::cut(const Frame& frame) const {
  if (!system_->cuts_open_) return frame;
  const int slot = system_->reactions_[static_cast<std::size_t>(number_)].slot;
  const auto still = [slot](int i) { return Expr::of_parts(0, 0, 0, Gradient::unit(slot + i)); };
  return frame * translate(still(0), still(1), still(2)) * rotate_x(still(3)) * rotate_y(still(4)) *
         rotate_z(still(5));
}

const Eigen::Vector3d& Reaction::force() const {
  return system_->reactions_[static_cast<std::size_t>(number_)].force;
}

const Eigen::Vector3d& Reaction::moment() const {
  return system_->reactions_[static_cast<std::size_t>(number_)].moment;
}

}  // namespace easydyn

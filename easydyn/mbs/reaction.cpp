#include <fmt/format.h>

#include "easydyn/error.hpp"
#include "easydyn/mbs/system.hpp"

namespace easydyn {

Frame Reaction::cut(const Frame& frame) const {
  if (!system_->cuts_open_) return frame;
  System::ReactionData& data = system_->reactions_[static_cast<std::size_t>(number_)];
  if (!system_->tree_.is_in_trial()) ++data.cuts;
  const int slot = data.slot;
  const auto still = [slot](int i) { return Expr::of_parts(0, 0, 0, Gradient::unit(slot + i)); };
  return frame * translate(still(0), still(1), still(2)) * rotate_x(still(3)) * rotate_y(still(4)) *
         rotate_z(still(5));
}

void Reaction::require_known() const {
  const System::ReactionData& data = system_->reactions_[static_cast<std::size_t>(number_)];
  if (!data.is_known)
    throw ModelError(
        fmt::format("reaction \"{}\" is not known yet: call System::compute_reactions first", data.name));
}

const Eigen::Vector3d& Reaction::force() const {
  require_known();
  return system_->reactions_[static_cast<std::size_t>(number_)].force;
}

const Eigen::Vector3d& Reaction::moment() const {
  require_known();
  return system_->reactions_[static_cast<std::size_t>(number_)].moment;
}

}  // namespace easydyn

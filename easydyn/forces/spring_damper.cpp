#include "easydyn/forces/spring_damper.hpp"

#include "easydyn/forces/account.hpp"
#include "easydyn/forces/line_of_action.hpp"
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

SpringDamper& SpringDamper::set_stops(const Stops& stops) {
  stops.check("spring \"" + name_ + "\"", "m");
  stops_ = stops;
  return *this;
}

void SpringDamper::apply(const Frame& frame_A, const Vector3d& p_A, const Frame& frame_B,
                         const Vector3d& p_B) {
  const LineOfAction line("spring", name_, frame_A, p_A, frame_B, p_B);
  length_ = line.length;
  const double stretch = line.length - free_length_;
  const Stops::Force stop = stops_ ? stops_->compute_force(line.length, line.rate) : Stops::Force{};
  force_ = stiffness_ * stretch + damping_ * line.rate - stop.force;
  line.pull(force_);
  account(frame_A, frame_B, 0.5 * stiffness_ * stretch * stretch + stop.potential,
          damping_ * line.rate * line.rate + stop.dissipated);
}

}  // namespace easydyn

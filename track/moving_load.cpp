#include "track/moving_load.hpp"

#include "easydyn/mbs/motion_tree.hpp"
#include "easydyn/require.hpp"

namespace easydyn::track {

MovingLoad::MovingLoad(std::string name, double load) : TrackContact(std::move(name)), load_(load) {
  require_finite("moving load \"" + this->name() + "\"", "load", load, "N");
}

void MovingLoad::apply(double x, double speed, const FlexibleTrack& track, EnergyAccounts& energy) {
  Port rail = track.touch_rail(x);
  rail.add_force(load_);
  energy.supplied += load_ * (rail.velocity() + speed * rail.slope());
  x_ = x;
  force_ = load_;
}

}  // namespace easydyn::track

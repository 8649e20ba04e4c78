#include "track/hanging_sleepers.hpp"

namespace easydyn::track {

void apply_unilateral_ballast(Port port, const UnilateralBallast& ballast, EnergyAccounts& energy) {
  const double compression = port.displacement(), rate = port.velocity();
  port.add_force(-ballast.force(compression, rate));
  energy.potential += ballast.energy(compression);
  energy.dissipated += ballast.dissipated_power(compression, rate);
}

void apply_hanging_sleepers(const FlexibleTrack& track, EnergyAccounts& energy) {
  const TrackModel& model = track.model();
  for (const int j : model.hanging_sleepers())
    apply_unilateral_ballast(track.touch(model.ballast_shape(j)), model.unilateral_ballast(j), energy);
}

}  // namespace easydyn::track

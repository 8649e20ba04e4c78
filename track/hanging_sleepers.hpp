#pragma once

#include "easydyn/mbs/motion_tree.hpp"
#include "track/flexible_track.hpp"

namespace easydyn::track {

/// Adds the reaction of one hanging sleeper's ballast to a port that touches what stands above the ballast with +1
/// and what lies below it with -1, and keeps the accounts: energy k_b c^2 / 2, dissipated power.
void apply_unilateral_ballast(Port port, const UnilateralBallast& ballast, EnergyAccounts& energy);

/// Adds the ballast of all hanging sleepers of a track (`SupportVariation::gap` > 0), which is not in the track's
/// matrices; within System::forces(), at each evaluation. One port per hanging sleeper.
///
///     void forces() override { ...; track::apply_hanging_sleepers(track, energy()); }
///
/// Dead load. Displacements count from the track at rest without vehicle, and gravity acts on the vehicle only. The
/// gap is therefore the clearance that is left there, when the sleeper hangs at the rail by its own weight, as a
/// feeler gauge measures it. The weight of the hanging sleeper and its share of the rail are in that state already,
/// carried by the neighbours; they do not appear again. The reaction of a hanging sleeper is all that its ballast
/// gets, so that it is never negative; those of the others come on top of their dead load.
///
/// @param energy  System::energy()
void apply_hanging_sleepers(const FlexibleTrack& track, EnergyAccounts& energy);

}  // namespace easydyn::track

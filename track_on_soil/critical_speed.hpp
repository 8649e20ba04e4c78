#pragma once

#include <optional>

#include "soil/layered/rayleigh_modes.hpp"
#include "soil/site.hpp"
#include "track/track_data.hpp"

namespace easydyn::track_on_soil {

/// Critical speed of a track on layered ground: phase speed at which the bending wave of the track without the ground
/// (track::compute_free_track_wave) is as fast as the fundamental Rayleigh mode of the elastic ground without the track
/// (soil::find_crossing). A stiff track meets the ground at long waves, which run in its stiffer depth; on a homogeneous
/// half-space the speed is that of its Rayleigh wave, whatever the track.
///
/// Limits: those of both waves. It is where the response to a moving load is largest within some percent
/// (docs/accuracy.md), not a resonance of the coupled system; a ground whose fundamental mode leaks away at the crossing
/// (soft below stiff) may have none. The frequency is that of the waves, in a ground-fixed place.
/// @throws ModelError if track or site are impossible
std::optional<soil::ModeCrossing> compute_critical_speed(const track::TrackData& data,
                                                         const soil::Site& site);

/// Speed of the Rayleigh wave in a half-space of the uppermost layer [m/s].
double compute_upper_rayleigh_speed(const soil::Site& site);

}  // namespace easydyn::track_on_soil

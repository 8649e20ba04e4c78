#pragma once

#include <Eigen/Core>
#include <optional>

#include "soil/layered/rayleigh_modes.hpp"
#include "soil/site.hpp"
#include "track/track_data.hpp"

namespace easydyn::track_on_soil {

/// Where the bending wave of the track without the ground (track::compute_free_track_wave) is as fast as the fundamental
/// Rayleigh mode of the elastic ground without the track (soil::find_crossing): a quick estimate of the critical speed. A
/// stiff track meets the ground at long waves, which run in its stiffer depth; on a homogeneous half-space the speed is
/// that of its Rayleigh wave, whatever the track.
///
/// Limits: those of both waves. On a half-space it is right within 4 %; on the layers of the bundled sites it is 4 % below to
/// 13 % above the speed of compute_deflection_over_speed(), and 32 to 38 % above with ballast in shear (docs/accuracy.md).
/// There is none where one wave stays slower than the other, or where the mode leaks away (soft below stiff).
/// @throws ModelError if track or site are impossible
std::optional<soil::ModeCrossing> find_mode_crossing(const track::TrackData& data, const soil::Site& site);

/// How far a constant load pushes the rail down, by its speed.
struct DeflectionOverSpeed {
  Eigen::VectorXd speed;                 ///< of the load [m/s], ascending
  Eigen::VectorXd deflection;            ///< largest over the track, per unit load [m/N]
  std::optional<double> critical_speed;  ///< where it is largest [m/s], to about 1 %; nothing if at an end
};

/// The critical speed of the track on the ground, both coupled: compute_moving_load_response() over speeds from a third of
/// the slowest to the fastest Rayleigh wave of the layers, more closely about the maximum, whose place is that of a
/// parabola through three speeds.
/// @param threads  0: one per core
/// @throws ModelError if track or site are impossible
DeflectionOverSpeed compute_deflection_over_speed(const track::TrackData& data, const soil::Site& site,
                                                  int threads = 0);

/// Speed of the Rayleigh wave in a half-space of the uppermost layer [m/s].
double compute_upper_rayleigh_speed(const soil::Site& site);

}  // namespace easydyn::track_on_soil

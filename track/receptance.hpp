#pragma once

#include <Eigen/Core>
#include <span>

#include "track/track_model.hpp"

namespace easydyn::track {

/// Static deflection of the track: K q = f. @throws SolverError if K is singular
Eigen::VectorXd compute_static_response(const TrackModel& track, const Eigen::VectorXd& load);

/// Steady harmonic response: (K + i w C - w^2 M) q = f exp(i w t), one column per frequency.
/// @param load         f, real amplitude [N]
/// @param frequencies  w / 2 pi [Hz], >= 0
/// @throws SolverError if the system is singular at a frequency (an undamped resonance)
Eigen::MatrixXcd compute_harmonic_response(const TrackModel& track, const Eigen::VectorXd& load,
                                           std::span<const double> frequencies);

/// Receptance of the rail: deflection at x_response per unit harmonic force at x_load [m/N], downward.
Eigen::VectorXcd compute_rail_receptance(const TrackModel& track, double x_load, double x_response,
                                         std::span<const double> frequencies);
/// Displacement of sleeper j per unit harmonic force on the rail at x_load [m/N], downward; also the deflection of the
/// rail there per unit force on the sleeper.
Eigen::VectorXcd compute_sleeper_receptance(const TrackModel& track, double x_load, int j,
                                            std::span<const double> frequencies);
/// Displacement of sleeper j per unit harmonic force on sleeper i [m/N], downward; i = j as a hammer measures it.
/// @throws ModelError if the track has no such sleeper
Eigen::VectorXcd compute_receptance_between_sleepers(const TrackModel& track, int i, int j,
                                                     std::span<const double> frequencies);

/// Decay rate of vibration along the rail, as it is measured (EN 15461): from the receptances A at places x_n ahead of
/// a force at x_0,
///
///   D = 4.343 / sum_n |A(x_n) / A(x_0)|^2 dx_n   [dB/m]
///
/// x_n are one element of the rail apart, up to where the absorbing bays begin, dx_0 half an element. A wave that
/// decays as exp(-b x) has D = 8.686 b. The near field adds to A(x_0) only: where the wave decays little, D of a rail is
/// up to twice that of the wave (`PeriodicTrack::compute_waves`). What does not decay over the length X ahead shows
/// D = 4.343 / X.
/// @param x_load  x_0 [m]; at least one bay must follow before the absorbing ones
/// @throws ModelError if not, SolverError as compute_harmonic_response
Eigen::VectorXd compute_decay_rate(const TrackModel& track, double x_load,
                                   std::span<const double> frequencies);

}  // namespace easydyn::track

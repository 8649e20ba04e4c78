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

}  // namespace easydyn::track

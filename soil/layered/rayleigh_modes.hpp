#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "soil/layered/layered_ground.hpp"

namespace easydyn::soil {

/// Phase speeds c [m/s] of the Rayleigh modes of the elastic ground (real parts of its moduli at that frequency), slowest
/// first: the fundamental mode, then the higher ones. They are the roots of WavenumberResponse::compute_dispersion_function() at k =
/// 2 pi f / c below the shear wave speed of the half-space; faster waves leak into it and are no modes. Modes guided by a
/// slow layer so deep that the surface does not feel them (e^-45) are left out.
/// @param frequency  [Hz], > 0
std::vector<double> compute_rayleigh_speeds(const LayeredGround& ground, double frequency);

/// Lowest frequency [Hz] up to `highest` at which the fundamental mode is as slow as `speed` [m/s]: a load that moves
/// at that speed radiates from there on; NaN if it is faster throughout (or slower at `lowest`, which is returned then).
double find_radiation_frequency(const LayeredGround& ground, double speed, double lowest, double highest);

/// Where a wave of something that lies on the ground, e.g. a track, is as fast as the ground's fundamental mode.
struct ModeCrossing {
  double frequency;  ///< [Hz]
  double speed;      ///< phase speed of both [m/s]
};

/// Lowest frequency at which a wave, slower than the fundamental mode before, catches up with it; nothing if it never does
/// among its samples. Between samples the wave follows a power law.
/// @param frequency, speed  of the wave [Hz], [m/s], > 0; at least 2, ascending in frequency
/// @throws ModelError if they do not fit
std::optional<ModeCrossing> find_crossing(const LayeredGround& ground, const Eigen::VectorXd& frequency,
                                          const Eigen::VectorXd& speed);

}  // namespace easydyn::soil

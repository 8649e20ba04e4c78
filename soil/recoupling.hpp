#pragma once

#include <Eigen/Core>

namespace easydyn::soil {

/// Distance between two displacement histories, relative to the soil's:
///
///   l2 = |u_f - u_soil| / |u_soil|  (all times and footprints),   peak = max |u_f - u_soil| / max |u_soil|
///
/// Both are infinite if the soil does not move but the foundation does, 0 if neither moves.
struct RelativeDifference {
  double l2 = 0, peak = 0;
};

/// The accuracy of a track foundation (coupled lumped masses) in one very run: how far its displacement u_f
/// is from the one that its reactions cause in the soil.
struct RecouplingError {
  RelativeDifference total;
  RelativeDifference quasi_static;  ///< below 2 Hz; depends on how far away the soil model ends
  RelativeDifference dynamic;       ///< above 2 Hz
  int footprints = 0;               ///< that were compared: those with the full load (taper = 1)
  double from = 0, to = 0;          ///< [s] time that was compared
};

/// Frequency that separates the quasi-static from the dynamic part [Hz].
inline constexpr double recoupling_split_frequency = 2;

/// The part of every column below `frequency` [Hz] (zero phase, half a cosine of the logarithm over the
/// octave around it); the rest is the other part, and both add up to the signal.
Eigen::MatrixXd compute_slow_part(const Eigen::Ref<const Eigen::MatrixXd>& signals, double step,
                                  double frequency);

/// Values of every column of `signals`, given at uniform `time`, at other times inside that range, by cubics
/// through four neighbours.
Eigen::MatrixXd interpolate(const Eigen::VectorXd& time, const Eigen::Ref<const Eigen::MatrixXd>& signals,
                            const Eigen::VectorXd& at);

/// Compares both displacements (downward, one column per footprint, the same order) over the time that they
/// share and up to the highest frequency of the soil model.
/// @param soil_time, soil_displacement         uniform times [s]; mean displacement of each footprint [m]
/// @param track_time, foundation_displacement  uniform times [s]; u_f of the track's foundation [m]
/// @param taper                                factor on the load of each footprint in the soil model
/// @param highest_frequency                    [Hz]
/// @throws ModelError if sizes disagree, no time is shared or no footprint bears its full load
RecouplingError compute_recoupling_error(const Eigen::VectorXd& soil_time,
                                         const Eigen::MatrixXd& soil_displacement,
                                         const Eigen::VectorXd& track_time,
                                         const Eigen::MatrixXd& foundation_displacement,
                                         const Eigen::VectorXd& taper, double highest_frequency);

}  // namespace easydyn::soil

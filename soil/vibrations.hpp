#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "easydyn/parameter.hpp"
#include "easydyn/results/result_file.hpp"
#include "soil/indicators.hpp"
#include "soil/site.hpp"

namespace easydyn::soil {

/// The same motion from the semi-analytical layered half-space, at times of its own: nt times.
struct SemiAnalyticalMotion {
  Eigen::VectorXd time;                    ///< nt [s], uniform
  Eigen::MatrixXd vx, vy, vz;              ///< nt x nr [m/s], z up
  Eigen::MatrixXd footprint_displacement;  ///< nt x nl [m], downward
};

/// What a prediction says: nt times, nr receivers, nl loaded footprints.
struct Vibrations {
  Eigen::VectorXd time;                    ///< nt [s], uniform
  std::vector<Receiver> receivers;         ///< nr
  Eigen::MatrixXd vx, vy, vz;              ///< nt x nr [m/s], z up
  std::vector<Indicators> indicators;      ///< nr
  Eigen::VectorXd footprint_x;             ///< nl [m]
  Eigen::MatrixXd footprint_displacement;  ///< nt x nl [m], mean over each footprint, downward
  Eigen::VectorXd footprint_taper;         ///< nl: factor on each load
  double highest_frequency = 0;            ///< [Hz]; nothing above it is claimed (roll-off to 1.25 x)
  std::vector<Parameter> parameters;       ///< site, mesh, boundary, time step
  std::string method;                      ///< how the motion was computed, e.g. "finite elements, all loads"
  std::string site_text;                   ///< the site file, as read
  std::optional<SemiAnalyticalMotion> semi_analytical;  ///< for comparison
};

/// Fills `indicators` from the velocities.
void update_indicators(Vibrations& vibrations);

/// Writes `vibrations.h5` (docs/formats.md).
/// @throws ModelError if sizes disagree or a value is not finite; InputError if the file cannot be written
void write_vibrations(const std::filesystem::path& path, const Vibrations& vibrations,
                      const results::Provenance& provenance);

/// @throws InputError naming the file, the dataset and what is wrong
Vibrations read_vibrations(const std::filesystem::path& path);

}  // namespace easydyn::soil

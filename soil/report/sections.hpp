#pragma once

// Private to soil/report: the parts of the page.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "easydyn/results/result_file.hpp"
#include "easydyn/visu/report.hpp"
#include "soil/recoupling.hpp"

namespace easydyn::soil::report {

/// Reference of velocity levels [m/s]: L_v = 20 log10(v_rms / reference).
inline constexpr double level_reference = 5e-8;

/// Step 1: vehicle, rail profile, contact forces, deflections, ballast reactions, vehicle accelerations, energies.
void add_track_section(visu::Report& report, const results::ResultReader& track);

/// The foundation against the compliance of the ground that it was fitted to, if the file holds them.
void add_foundation(visu::Report& report, const results::ResultReader& track);

/// Step 2: velocities, spectra, decay with distance, indicators. @param track  of step 1, or null
void add_ground_section(visu::Report& report, const results::ResultReader& ground,
                        const results::ResultReader* track);
std::vector<visu::KeyFigure> ground_key_figures(const results::ResultReader& ground);

/// Phase speed of the ground's Rayleigh modes against frequency, as a part of the section on the ground; with the free
/// wave of the track and where both cross, and what a moving load makes of it, if step 1 holds them.
void add_dispersion(visu::Report& report, const results::ResultReader& ground,
                    const results::ResultReader* track);

/// Step 2 against the semi-analytical motion, if the file holds it (`soil run --verify`).
void add_verification_section(visu::Report& report, const results::ResultReader& ground);

/// Where both steps meet: displacement of the soil under each sleeper against the track's foundation.
struct Comparison {
  Eigen::VectorXd track_time, soil_time;  ///< [s]
  Eigen::VectorXd x, taper;               ///< of the footprints that lie under a sleeper [m], [1]
  Eigen::MatrixXd foundation, soil;       ///< downward displacement, one column per footprint [m]
  double highest_frequency = 0;           ///< of the soil model [Hz]
  RecouplingError error;
  /// The same with the layered half-space in the place of the soil model, if the file holds it (--verify).
  std::optional<RecouplingError> semi_analytical_error;
  Eigen::VectorXd semi_analytical_time;  ///< [s]
  Eigen::MatrixXd semi_analytical_soil;  ///< as `soil`
};

/// Nothing if the files do not hold both displacements (a track on rigid ground).
/// @throws ModelError if no footprint lies under a sleeper, or as compute_recoupling_error()
std::optional<Comparison> compare_displacements(const results::ResultReader& track,
                                                const results::ResultReader& ground);
void add_recoupling_section(visu::Report& report, const Comparison& comparison);
visu::KeyFigure recoupling_key_figure(const Comparison& comparison);

}  // namespace easydyn::soil::report

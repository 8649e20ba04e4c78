#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "easydyn/parameter.hpp"
#include "easydyn/results/provenance.hpp"
#include "easydyn/visu/report.hpp"
#include "easydyn/visu/scene.hpp"
#include "track/clm_calibration.hpp"
#include "track/free_track_wave.hpp"
#include "track/passage.hpp"
#include "track/profile.hpp"

namespace easydyn::track {

/// A figure that a run wants to show in its report.
struct SummaryFigure {
  std::string name;
  double value = 0;
  std::string unit;
};

/// Heights of a rail profile, positive up: of the centre of a wheel that rolls over it.
struct ProfileSamples {
  Eigen::VectorXd x, height;  ///< np each [m]; x ascending
  double wheel_radius = 0;    ///< of that wheel [m]
};

/// @param spacing  at most [m], > 0; the ends are among the samples
/// @throws ModelError unless first_x < last_x, spacing > 0 and the profile accepts the wheel
ProfileSamples sample_profile(const Profile& profile, double wheel_radius, double first_x, double last_x,
                              double spacing = 0.02);

/// What `results.h5` holds beside the channels of a passage, for the report. All but the description is optional.
struct PassageReport {
  std::string description;                  ///< what was run, one sentence
  std::vector<Parameter> parameters = {};   ///< with their sources
  std::vector<SummaryFigure> summary = {};  ///< key figures
  std::optional<visu::Scene> scene = {};    ///< the animated passage
  std::string drawing = {};                 ///< of the vehicle, SVG (visu::Report::add_drawing)
  std::vector<visu::Table> tables =
      {};  ///< of the vehicle: axle loads, mass balance, modes, each with a caption
  Eigen::VectorXd static_loads =
      {};  ///< nw, of the contacts, or empty [N]: what dynamic load factors refer to
  std::optional<ProfileSamples> profile = {};  ///< of the rail under the train
  std::optional<ClmFit> foundation_fit = {};   ///< of the foundation to the ground that it stands for
  std::optional<FreeTrackWave> free_wave = {};
  /// Largest deflection of the rail per unit of a constant load on the ground itself [m/N], by the load's speed [m/s].
  Eigen::VectorXd load_speed = {}, load_deflection = {};
  double critical_speed = 0;  ///< where it is largest [m/s]; 0: not known
};

/// Writes `results.h5` of a passage: every channel and what the report needs; docs/formats.md.
/// @throws InputError if the file cannot be written, ModelError on a value that is not finite, an unsound scene, or
///         static loads that are not one per contact
void write_passage(const std::filesystem::path& path, const Passage& passage, const PassageReport& report,
                   const results::Provenance& provenance);

/// Writes `channels.csv`: contact forces, rail, sleeper and foundation displacement and ballast reaction at
/// the recorded sleeper nearest to x, and the vertical acceleration of every body.
void write_passage_channels(const std::filesystem::path& path, const Passage& passage, double x);

}  // namespace easydyn::track

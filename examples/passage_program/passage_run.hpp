#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "examples/passage_program/passage_program.hpp"
#include "examples/passage_program/site_of_run.hpp"
#include "examples/passage_program/train_on_track.hpp"
#include "track/passage_files.hpp"

namespace easydyn::examples {

/// What the command line says.
struct PassageProgramOptions {
  std::vector<double> speeds;  // [km/h]
  double step_height = 0;      // [mm]
  std::string irregularity;
  unsigned seed = 1;
  std::filesystem::path profile;
  double wheel_flat = 0;  // length [mm]
  std::string detail = "full", foundation = "clm";
  std::filesystem::path site;  // empty: the bundled foundation
  double time_step = 1e-4;     // [s]
  double loaded = 14;          // half the length [m]
  std::filesystem::path output;
};

/// Where the train runs: from before the loaded part, all wheels on the rough rail when the first one gets there, until
/// the last one has left it.
struct Course {
  double reach;        ///< farthest wheel from the train's origin [m]
  double start, stop;  ///< of the origin, where the recording begins and ends [m]
  double run_in;       ///< of the way before that [m]
  double rough_begin;  ///< of the unevenness [m]
};

/// One passage of a program at one speed, with all that it needs.
struct PassageRun {
  /// @param speed  [m/s]
  /// @throws ModelError on impossible data, InputError on a profile that cannot be read
  PassageRun(const PassageProgram& program, const PassageProgramOptions& options, double speed);

  void compute(const std::function<void(double fraction)>& progress = {});

  // What compute() found.
  std::vector<track::SummaryFigure> summarise() const;
  double largest_load_factor() const;
  double energy_imbalance() const;  ///< largest error of the balance over the work supplied

  Eigen::VectorXd static_loads() const;  ///< of the contacts [N]
  /// Speeds near those at which waves in the track or in the ground keep up with the train; an irregularity without the
  /// short waves that excite up to 80 Hz.
  std::vector<std::string> warn() const;

  bool is_rough;
  double speed;                  ///< [m/s]
  double rayleigh_speed;         ///< of the upper layer of the ground [m/s]; 0: not known
  double critical_speed;         ///< of the track on that ground [m/s]; 0: not known
  double shortest_wave = 0;      ///< of the irregularity [m]; 0: none
  bool has_wide_margin = false;  ///< of track before and behind the wheels, as where they lift off
  Course course;
  track::TrackData data;
  std::shared_ptr<const track::Profile> profile;
  std::unique_ptr<TrainOnTrack> system;
  track::PassageOptions passage_options;
  track::Passage passage;
};

/// One speed: results.h5, surface_loads.h5 and channels.csv. @returns exit status
/// @param site  that --site names, or nothing
int run_passage(const PassageProgram& program, const PassageProgramOptions& options,
                const std::optional<SiteOfRun>& site, const std::string& command);
/// Every speed as a passage of its own, as many at a time as there are cores: sweep.html. @returns exit status
int run_speed_sweep(const PassageProgram& program, const PassageProgramOptions& options);

}  // namespace easydyn::examples

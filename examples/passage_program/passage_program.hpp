#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "track/profile.hpp"
#include "track/track_data.hpp"
#include "vehicles/rail_vehicle.hpp"
#include "vehicles/vehicle_scene.hpp"

namespace easydyn::examples {

/// A program of a train over a track, step 1 of a prediction: what is its own. The rest, the command line, the passage and
/// the files for the ground and the report, is shared (`run_passage_program`).
struct PassageProgram {
  std::string name, title;
  vehicles::RailVehicle vehicle;
  track::TrackData track;

  // ---- defaults of its options ----
  double speed = 30;  ///< [km/h]
  double least_speed = 1, top_speed = 120;
  double step_height = 0;             ///< of a rail step at x = 0 [mm]
  std::string irregularity = "none";  ///< a spectrum by name (track/irregularity_spectrum.hpp)
  double time_step = 1e-4;            ///< [s]

  // ---- where ----
  double loaded = 14;   ///< the ground is loaded from -loaded to loaded about x = 0 [m]
  double approach = 2;  ///< of the first wheel to the loaded part, and of the last one away from it [m]
  /// Of track solved before and behind the wheels, the absorbing ends included [m]; 14 m more where wheels may lift off.
  double margin = 32;

  /// Rayleigh speed of the upper layer of the site that the foundation stands for [m/s]; 0: unknown.
  double rayleigh_speed = 0;
  double critical_speed = 0;  ///< of the track on the layers of that site [m/s]; 0: unknown

  vehicles::DrawingHeights heights = {};
  double picture_width = 26;  ///< of the animation [m]
  std::string followed;       ///< body that the camera follows
};

/// Options, one passage or a sweep of speeds, files. With --site, foundation and speeds of waves are those of a site file.
/// @returns  exit status: 0 done, 1 an error, 2 wrong options
int run_passage_program(const PassageProgram& program, int argc, char** argv);

}  // namespace easydyn::examples

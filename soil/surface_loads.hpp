#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "easydyn/results/result_file.hpp"

namespace easydyn::soil {

/// Where a load pushes: along +x, along +y, downward.
enum class LoadDirection { x, y, down };

/// A rectangle of the ground surface under uniform vertical pressure or horizontal traction, or a point.
struct Footprint {
  double x = 0, y = 0;           ///< centre [m]
  double length = 0, width = 0;  ///< along x, along y [m], > 0; both 0: a point
  LoadDirection direction = LoadDirection::down;
  int source = 0;  ///< which of several files it came from; each of them is tapered by itself

  bool is_point() const { return length == 0 && width == 0; }
};

/// Load histories on the ground surface: force(i, j) [N], positive along the footprint's direction (downward
/// where nothing is said), at time(i) [s] on footprint j.
/// The step is uniform. The one format between a source (train, pile driver, machine) and the ground.
struct SurfaceLoads {
  Eigen::VectorXd time;
  std::vector<Footprint> footprints;
  Eigen::MatrixXd force;
};

/// @throws ModelError if sizes disagree, the time is not uniform or a value is not finite
void write_surface_loads(const std::filesystem::path& path, const SurfaceLoads& loads,
                         const results::Provenance& provenance);
/// @throws InputError naming the file, the dataset and what is wrong
SurfaceLoads read_surface_loads(const std::filesystem::path& path);

/// Loads of several sources on one clock, with the smallest of their steps: what begins later is brought in as
/// LoadHistory does it, what ends earlier is held, samples of another step are interpolated by its splines. One
/// source is returned as it is.
/// @param preload_time  [s] see LoadHistory
/// @throws ModelError if there is none, or a force is not finite
SurfaceLoads join_surface_loads(const std::vector<SurfaceLoads>& sources, double preload_time = 0.5);
/// The same for files, in their order.  @throws InputError naming the file, the dataset and what is wrong
SurfaceLoads read_surface_loads(const std::vector<std::filesystem::path>& paths, double preload_time = 0.5);

}  // namespace easydyn::soil

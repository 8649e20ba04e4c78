#pragma once

#include <Eigen/Core>

#include "soil/surface_loads.hpp"

namespace easydyn::soil {

/// Forces of the surface loads at any time: natural cubic spline through the samples, last value held after
/// the end, first value brought in smoothly (C2) over `preload_time` before the start.
class LoadHistory {
 public:
  /// @throws ModelError if the sizes disagree, the step is not uniform or a value is not finite
  LoadHistory(const SurfaceLoads& loads, double preload_time);

  double first_time() const { return time_(0); }  ///< [s]
  double last_time() const { return time_(time_.size() - 1); }
  /// Forces on the footprints at time t [N], positive downward.
  void update_forces(double t, Eigen::VectorXd& out) const;

 private:
  double preload_time_, step_;
  Eigen::VectorXd time_;
  Eigen::MatrixXd force_, curvature_;  // nl x nt
};

/// Factor on each load so that the loaded track fades out at both ends: raised cosine of the distance of the
/// footprint's centre from the first or last centre over `taper_length` [m], 0 at that centre. A load that
/// appeared at the first sleeper at full strength would send a spurious pulse. All ones where all footprints
/// have the same x, or taper_length = 0. Each Footprint::source for itself: a machine beside a track is not an end of it.
/// @throws ModelError if the loaded track is shorter than two tapers
Eigen::VectorXd compute_taper(const std::vector<Footprint>& footprints, double taper_length);

}  // namespace easydyn::soil

#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "soil/layered/layered_ground.hpp"
#include "soil/surface_loads.hpp"

namespace easydyn::soil {

/// A unit force, uniformly spread over a rectangle of the surface around the origin or concentrated in a point, and
/// where its response is wanted.
struct FootprintRequest {
  double length = 0, width = 0;  ///< [m] along x, along y; both 0: a point load
  double source_depth = 0;       ///< [m] of a point load, >= 0; rectangles lie on the surface
  LoadDirection direction = LoadDirection::down;
  std::vector<std::array<double, 3>> points;  ///< x, y, z [m], z <= 0: displacement there
  std::vector<Footprint> means;               ///< mean displacement over these, for a load on a rectangle
  int threads = 0;                            ///< 0: one per core
};

/// Frequency responses, one row per frequency.
struct FootprintResponse {
  Eigen::MatrixXcd ux, uy, uz;  ///< nf x points [m/N], z up
  Eigen::MatrixXcd mean;        ///< nf x means [m/N], downward
  /// nf x means [m/N] along x and y, of horizontal loads only: those of a vertical one follow by reciprocity.
  Eigen::MatrixXcd mean_x, mean_y;
};

/// Response of a layered ground to a load on one footprint at the circular frequencies w (RadialResponse says which,
/// and how). The point load's response is integrated over the rectangle in space: the singular static part in closed
/// form on the surface, what is left by Gauss's rule; means over a second rectangle over the difference of both
/// places. Error about 1e-6 of the response.
/// @throws ModelError if a size, depth or place is out of range, or the ground is undamped at a frequency
FootprintResponse compute_footprint_response(const LayeredGround& ground, const FootprintRequest& request,
                                             const Eigen::VectorXcd& w);

/// Compliances H_0n [m/N] of a row of equal footprints along x: mean downward displacement of footprint n per unit force on
/// footprint 0, n = 0 ... count - 1; the matrix of all of them is H_|i-j|.
/// @param frequencies  [Hz], ascending, > 0 where a layer is elastic
/// @returns frequencies x count
Eigen::MatrixXcd compute_compliances(const LayeredGround& ground, double length, double width, double spacing,
                                     int count, const Eigen::VectorXd& frequencies, int threads = 0);

}  // namespace easydyn::soil

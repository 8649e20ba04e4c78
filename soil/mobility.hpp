#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <string>
#include <vector>

#include "soil/site.hpp"
#include "soil/surface_loads.hpp"

namespace easydyn::soil {

/// Impulse responses to a horizontal load, as those of Mobility to the vertical one.
struct HorizontalResponse {
  Eigen::MatrixXd hx, hy, hz;  ///< samples x places [m/(N s)], for dx, dy >= 0; z up
  /// samples x shifts [m/(N s)], for dx, dy >= 0: mean displacement of a footprint there along x, along y and downward.
  /// What a vertical load does along x and y follows by reciprocity.
  Eigen::MatrixXd mean_x, mean_y, mean;
};

/// Impulse responses of a ground to one footprint: all that a train's vibration needs where the ground does not vary
/// along the track, since the response to any other footprint is the same, shifted. By symmetry only distances |dx|, |dy|
/// from the footprint's centre are held; symmetry_signs() gives the others.
///
/// Displacement u(t) [m] under a vertical force F(t), downward, is u = int h(t - s) F(s) ds. The h are band-limited:
/// unchanged up to `roll_off` (1.25) times the highest frequency, nothing from 1.75 times it.
struct Mobility {
  double length = 0, width = 0;               ///< [m] of the footprint, along x and y
  double highest_frequency = 0;               ///< [Hz]
  double step = 0;                            ///< [s] of the samples
  int before = 0;                             ///< samples before t = 0: the first one is at -before step
  std::vector<std::array<double, 3>> places;  ///< |dx|, |dy|, z [m] of the receivers, z <= 0
  std::vector<std::array<double, 2>> shifts;  ///< |dx|, |dy| [m] of the neighbouring footprints
  Eigen::MatrixXd hx, hy, hz;                 ///< samples x places [m/(N s)], for dx, dy >= 0; z up
  Eigen::MatrixXd mean;  ///< samples x shifts [m/(N s)]: mean downward displacement of a footprint there
  /// Of the loads along x and along y, where there are such.
  std::map<LoadDirection, HorizontalResponse> horizontal;

  double farthest() const;  ///< [m] of places and shifts
  double window() const;    ///< [s] of the samples after t = 0
};

/// Signs of u_x, u_y, u_z at (dx, dy) over those at (|dx|, |dy|): the mirror image about x = 0 turns u_x and a load along x
/// round, that about y = 0 u_y and a load along y.
std::array<double, 3> symmetry_signs(LoadDirection direction, double dx, double dy);

/// "footprint 3", or, where there are several sources, "footprint 3 of load file 2".
std::string name_footprint(const std::vector<Footprint>& footprints, std::size_t index);

/// Distances between the footprints of the loads and the receivers, and among the footprints, each once (to 1e-6 m), and the
/// directions of the loads, as empty responses.
/// @throws ModelError if the footprints differ in size
Mobility list_distances(const std::vector<Footprint>& footprints, const std::vector<Receiver>& receivers);

/// Time that impulse responses need to die out at the farthest of these distances [s].
double estimate_window(double slowest_cs, const Mobility& distances);

}  // namespace easydyn::soil

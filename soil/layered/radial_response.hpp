#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "soil/layered/layered_ground.hpp"

namespace easydyn::soil {

/// Distances from a point load, graded towards it, with an interpolation between them: panels of 20 Chebyshev
/// points, as long as their distance from 0 but short enough for the waves.
class RadialGrid {
 public:
  /// @param smallest            [m] > 0: nothing changes below it
  /// @param largest             [m] > smallest
  /// @param largest_wavenumber  [1/m] of the waves
  RadialGrid(double smallest, double largest, double largest_wavenumber);

  static constexpr int points_per_panel = 20;
  const Eigen::VectorXd& nodes() const { return nodes_; }
  double largest() const { return edges_.back(); }
  /// First node and weights of the panel that holds r, 0 <= r <= largest().
  struct Weights {
    Eigen::Index first;
    Eigen::Matrix<double, points_per_panel, 1> values;
  };
  Weights compute_weights(double r) const;

 private:
  std::vector<double> edges_;
  Eigen::VectorXd nodes_;
};

/// Displacement [m/N] of the ground at one depth under a unit point load: functions of the distance at the nodes of a
/// grid (rows), real and imaginary parts at each frequency (columns 2 i and 2 i + 1).
///
///   vertical load, downward:  u_z = zz (downward),  u_r = xz
///   load along x:             u_x = sum - difference cos 2 theta,  u_y = -difference sin 2 theta,
///                             u_z = -zx cos theta (downward)
///
/// where, with G of WavenumberCompliance,
///
///   zz = H0[G_zz], xz = H1[G_xz], sum = H0[(G_xx + G_yy) / 2], difference = H2[(G_xx - G_yy) / 2], zx = H1[G_zx],
///   Hn[g] = 1 / (2 pi) int g(k) Jn(k r) k dk.
///
/// With `static_part` the response of the static half-space of the uppermost layer's complex modulus has been taken off
/// (compute_static_point_response() / mu), so that what is left is finite at r = 0.
struct RadialResponse {
  bool static_part = false;
  Eigen::MatrixXd zz, xz, sum, difference, zx;
};

/// What compute_radial_responses() is to compute.
struct RadialRequest {
  double source_depth = 0;              ///< [m] >= 0
  std::vector<double> receiver_depths;  ///< [m] >= 0
  bool vertical = true, horizontal = false;
  double smallest = 0;  ///< [m] > 0: variations over shorter distances are smoothed out
  int threads = 0;      ///< 0: one per core
};

/// Point-load responses at one depth after the other.
///
/// The integral over the wavenumber is taken on the real axis by Gauss-Legendre panels of 16 points, short
/// enough for the nearest pole or branch point (waves lie off the axis by their damping or by Im w) and for the
/// Bessel function at the largest distance; from 1.5 times the wavenumber of the slowest waves on it ends smoothly over a
/// width of 72 / r (error about 1e-8). Frequencies within an octave share their panels.
/// Cost: about 1 us per wavenumber, frequency and three layers, and a product of matrices (distances x wavenumbers x
/// frequencies); the numbers of wavenumbers and distances grow with the largest distance over the shortest wavelength.
/// @param w  circular frequencies [rad/s], ascending in Re w >= 0; Im w <= 0
/// @throws ModelError if waves are undamped at a frequency: damping ratio 0 in a layer and Im w = 0
std::vector<RadialResponse> compute_radial_responses(const LayeredGround& ground,
                                                     const RadialRequest& request, const RadialGrid& grid,
                                                     const Eigen::VectorXcd& w);

}  // namespace easydyn::soil

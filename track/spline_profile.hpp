#pragma once

#include <string>
#include <vector>

#include "track/profile.hpp"
#include "track/taper.hpp"

namespace easydyn::track {

/// What a profile given by points is before its first and behind its last point.
enum class BeyondPoints {
  held,  ///< the height of the nearest end goes on
  zero   ///< r = 0; the profile is tapered to it, or its end points are zero themselves
};

struct SplineProfileOptions {
  BeyondPoints beyond = BeyondPoints::held;
  /// With `zero`: over this length inside each end the profile is multiplied by a smooth step
  /// (`track/taper.hpp`) [m].
  double taper = 0;
};

/// Measured profile: the cubic spline through points (x_i, r_i), twice continuously differentiable between them,
/// with the slope 0 at both ends, so that what lies beyond joins with a continuous slope. The points are met
/// exactly; nothing is resampled or smoothed. Interpolation error h^4 max|r''''| 5/384 for smooth data at the
/// spacing h.
///
/// It is taken as the path of the wheel centre; where it is as sharp as a wheel, `RolledProfile` filters it.
class SplineProfile : public Profile {
 public:
  /// @param name  for messages
  /// @param x     [m], strictly ascending, at least 4
  /// @param r     [m], up, as many
  /// @throws ModelError naming the point; with `zero` and without taper, unless r is 0 at both ends
  SplineProfile(std::string name, std::vector<double> x, std::vector<double> r,
                const SplineProfileOptions& options = {});

  ProfilePoint at(double x, double wheel_radius) const override;

  const std::vector<double>& x() const { return x_; }  ///< of the points [m]
  const std::vector<double>& r() const { return r_; }  ///< [m]

 private:
  std::size_t piece_of(double x) const;

  std::string name_;
  std::vector<double> x_, r_, slope_;  // at the points
  bool is_held_, is_tapered_;
  Taper taper_;
  double pieces_per_metre_;
};

}  // namespace easydyn::track

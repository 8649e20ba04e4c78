#pragma once

#include <string>
#include <vector>

#include "track/profile.hpp"

namespace easydyn::track {

/// A running surface of straight pieces, level before its first and behind its last point, as a rigid wheel
/// rolls over it (exact, without a table):
///
///   r_R(x) = max of  y_v - R + sqrt(R^2 - (x - x_v)^2)           on the corner v, |x - x_v| < R
///                    y(c) - R + R / sqrt(1 + m^2)                 on a piece of slope m, touched at
///                    c = x + R m / sqrt(1 + m^2) between its ends
///
/// Two points at the same x make a vertical edge; a slot deeper than the wheel can dip is a gap.
///
/// Where the wheel passes from one point of contact to another without rolling between them, r' jumps up: a
/// rigid wheel takes the velocity v (r'_ahead - r'_behind) at once, an impact that only the contact's stiffness
/// softens. r' and r'' are those of the side ahead (x + 0) there. Left out, as in `StepProfile`: the inclination
/// of the force.
class PolylineProfile : public Profile {
 public:
  struct Point {
    double x, y;  ///< [m], y up
  };

  /// @param name    for messages
  /// @param points  at least one, x ascending (equal: a vertical edge)
  /// @throws ModelError naming the point
  PolylineProfile(std::string name, std::vector<Point> points);

  /// @throws ModelError unless wheel_radius > highest - lowest point
  ProfilePoint at(double x, double wheel_radius) const override;

 private:
  std::string name_;
  std::vector<Point> points_;
  double height_ = 0;  // highest - lowest point
};

}  // namespace easydyn::track

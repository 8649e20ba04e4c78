#pragma once

#include <memory>
#include <vector>

#include "track/profile.hpp"

namespace easydyn::track {

/// How a wheel departs from a circle, as the rise of its centre while it rolls over a flat rigid rail without
/// slipping:
/// r [m, up] with its derivatives with respect to the distance rolled, which is R times the angle.
class WheelShape {
 public:
  virtual ~WheelShape() = default;
  /// @param angle         that the wheel has rolled [rad], any
  /// @param wheel_radius  R [m], > 0
  virtual ProfilePoint at(double angle, double wheel_radius) const = 0;
};

/// A flat of length l, once per revolution, the middle of it on the rail at angle = 0, 2 pi, ...
///
/// Fresh (sharp ends): the wheel pivots about the first corner of the chord, drops onto the chord, and pivots
/// about the second; with s = R angle from the middle
///   r = sqrt(R^2 - (l/2 - |s|)^2) - R       |s| < l/2
/// deepest -R + sqrt(R^2 - l^2/4), about -l^2/(8R), at s = 0, where the slope jumps by 2 (l/2) / sqrt(R^2 -
/// l^2/4), about l/R: there a rigid wheel takes the velocity v l/R at once. The arc cut off is longer than the
/// chord by l^3/(24 R^2), 25 um for 50 mm at R = 0.46 m, which the revolution of 2 pi R leaves out.
///
/// Rounded by wear: r = -d/2 (1 + cos(2 pi s / l)), |s| < l/2, d = l^2/(8R) unless given; smooth over the same
/// length (M-h).
///
/// Valid while the force keeps the wheel rolling; at high speed it leaves the rail over the flat, which the
/// contact finds by itself.
class WheelFlat : public WheelShape {
 public:
  /// @param length  l [m], > 0; below the diameter of every wheel
  /// @param angle   of the middle of the flat on the wheel [rad]
  /// @throws ModelError naming the value and the range
  static WheelFlat fresh(double length, double angle = 0);
  /// @param depth  d [m], >= 0; 0: l^2/(8R)
  static WheelFlat rounded(double length, double depth = 0, double angle = 0);

  ProfilePoint at(double angle, double wheel_radius) const override;
  double depth(double wheel_radius) const;  ///< fall of the wheel centre at the middle of the flat [m]

 private:
  WheelFlat(bool is_rounded, double length, double depth, double angle);
  bool is_rounded_;
  double length_, depth_, angle_;
};

/// Out-of-roundness by orders of a polygon: r = sum_k A_k cos(k angle - phase_k). Long waves against the contact
/// are assumed: A k^2 / R far below 1.
class OutOfRoundness : public WheelShape {
 public:
  struct Order {
    int order;         ///< k, waves per circumference, >= 1
    double amplitude;  ///< A [m]
    double phase = 0;  ///< [rad]
  };
  /// @throws ModelError naming the value and the range
  explicit OutOfRoundness(std::vector<Order> orders);
  ProfilePoint at(double angle, double wheel_radius) const override;

 private:
  std::vector<Order> orders_;
};

/// Several departures of one wheel, added: several flats, or a flat of a wheel that is out of round.
class WheelShapeSum : public WheelShape {
 public:
  explicit WheelShapeSum(std::vector<std::shared_ptr<const WheelShape>> parts);
  ProfilePoint at(double angle, double wheel_radius) const override;

 private:
  std::vector<std::shared_ptr<const WheelShape>> parts_;
};

}  // namespace easydyn::track

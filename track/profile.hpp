#pragma once

#include <memory>
#include <vector>

namespace easydyn::track {

/// Height of a vertical profile and its derivatives with respect to x.
struct ProfilePoint {
  double r = 0;    ///< [m], positive **up**
  double dr = 0;   ///< dr/dx [1]
  double ddr = 0;  ///< d2r/dx2 [1/m]
};

/// Vertical profile of the unloaded rail as a wheel sees it: the height, positive **up**, of the path of the
/// centre of a rigid wheel of radius R rolling over it. One profile serves wheels of all sizes: each filters
/// it by its own radius. At x(t) the path has the rate v dr and the acceleration v^2 ddr + a dr.
class Profile {
 public:
  virtual ~Profile() = default;
  /// @param x             of the wheel centre [m]
  /// @param wheel_radius  [m], > 0
  virtual ProfilePoint at(double x, double wheel_radius) const = 0;
};

/// A perfect rail: r = 0.
class FlatProfile : public Profile {
 public:
  ProfilePoint at(double, double) const override { return {}; }
};

/// A vertical step of the running surface at x0: for a train in the direction of +x, up by h > 0 or down by h
/// < 0.
///
/// Up (s = x - x0): the wheel runs on the low side until its rim touches the edge, where its centre is the
/// distance
///   a = sqrt(2 R h - h^2)                               (Pythagoras: a^2 + (R - h)^2 = R^2)
/// short of it; then it pivots about the edge, its centre on a circle of radius R about it:
///   r = 0                        s <= -a
///   r = h - R + sqrt(R^2 - s^2)  -a < s < 0     r' = -s / sqrt(R^2 - s^2),  r'' = -R^2 / (R^2 - s^2)^(3/2)
///   r = h                        s >= 0
/// Down: the mirror image, r = R' path with h -> |h|, s -> -s, lowered by |h|.
///
/// The path is continuous. Its slope is too at the edge (r' = 0), but jumps from 0 to a / (R - h) at first
/// touch (up), and from -a / (R - h) to 0 at landing (down): there a rigid wheel takes the velocity v a / (R
/// - h) at once, an impact that only the contact's stiffness softens. R = 0.32 m, h = 1 mm: a = 25.3 mm,
/// slope 0.079. On the ramp the curvature is about -1/R. r' and r'' are those of the side ahead (x + 0) where
/// they jump.
///
/// Left out: the force is taken vertical and under the wheel centre, while it is inclined by up to asin(a /
/// R) (4.5 degrees in the example: 0.3 % of its vertical part) and acts up to a ahead of the centre.
class StepProfile : public Profile {
 public:
  /// @param x0      position of the step [m]
  /// @param height  h [m]; |h| must stay below the radius of every wheel
  /// @throws ModelError if a value is not finite
  StepProfile(double x0, double height);
  /// @throws ModelError unless wheel_radius > |h|
  ProfilePoint at(double x, double wheel_radius) const override;
  /// Length of the ramp a [m].
  double ramp_length(double wheel_radius) const;

 private:
  double x0_, height_;
};

/// Sum of profiles. Exact where at most one of them is not straight; defects closer than their ramps would in
/// truth shield each other from a large wheel.
class ProfileSum : public Profile {
 public:
  explicit ProfileSum(std::vector<std::shared_ptr<const Profile>> parts);
  ProfilePoint at(double x, double wheel_radius) const override;

 private:
  std::vector<std::shared_ptr<const Profile>> parts_;
};

}  // namespace easydyn::track

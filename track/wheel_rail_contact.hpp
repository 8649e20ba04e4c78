#pragma once

#include <memory>
#include <string>

#include "easydyn/mbs/body.hpp"
#include "track/flexible_track.hpp"
#include "track/hertz_contact.hpp"
#include "track/profile.hpp"
#include "track/track_contact.hpp"
#include "track/wheel_shape.hpp"

namespace easydyn::track {

/// How a wheel shape is mounted.
struct WheelShapeOptions {
  double phase = 0;  ///< angle rolled at x = 0 [rad]: the wheel's angle is x / R + phase
  /// The shape comes up from a round wheel by a smooth step (`track/taper.hpp`) over this length, from this
  /// place on: a train then starts without a jolt. Length 0: the shape is there everywhere.
  double fade_begin = 0, fade_length = 0;  ///< [m]
};

/// The contact between one wheel pair and the rail at the moving place x(t) below the wheel.
///
///   delta = delta_Q + r(x) - w(x, t) - z          F = K delta^(3/2), delta > 0
///
/// z [m, up] is the height of the wheel above its place in the loaded state, in which the contact carries the
/// static load Q with the indentation delta_Q; w [m, down] is the deflection of the rail, r [m, up] the path
/// of the wheel over the profile; a wheel with a shape of its own adds to it the rise of its centre at the angle
/// x / R + phase. Both wheels of a pair have the same shape. F pushes the wheel up and the rail down, both at x.
///
/// Energy: the contact stores 2/5 K delta^(5/2). Since it moves along the rail at v = x., it exchanges the
/// power F v (r' - w') with the drive that keeps the speed; this enters the account of supplied power.
/// r' holds that of the wheel's shape.
class WheelRailContact : public TrackContact {
 public:
  /// @param wheel_radius  filters the profile [m], > 0
  /// @param static_load   Q [N], >= 0
  /// @param profile       shared by all wheels, not null
  /// @throws ModelError naming the contact, the value and the range
  WheelRailContact(std::string name, const HertzContact& law, double wheel_radius, double static_load,
                   std::shared_ptr<const Profile> profile);

  /// Gives the wheels a shape of their own; null: round ones. Before a run.
  /// @throws ModelError if an option is out of its range
  void set_wheel_shape(std::shared_ptr<const WheelShape> shape, const WheelShapeOptions& options = {});

  /// Applies the contact force; within System::forces().
  void apply(const Body& wheel, const FlexibleTrack& track);
  /// The same on a rail that does not move, w = 0.
  void apply(const Body& wheel);

  /// Path r of the wheel centre at x over a rail at rest: profile and wheel shape.
  ProfilePoint path_at(double x) const;

  double static_load() const { return static_load_; }

  Force force_after(double change, double rate_change) const override;
  /// The wheel of the last evaluation.
  const Body* body() const override { return wheel_; }

 private:
  struct RailMotion {
    double deflection = 0, slope = 0;  // w, w'
  };
  void apply_to_wheel(const Body& wheel, const RailMotion& rail);

  HertzContact law_;
  double radius_, static_load_, static_indentation_;
  std::shared_ptr<const Profile> profile_;
  std::shared_ptr<const WheelShape> shape_;
  WheelShapeOptions shape_options_;
  // At the last evaluation.
  double indentation_ = 0;
  const Body* wheel_ = nullptr;
};

}  // namespace easydyn::track

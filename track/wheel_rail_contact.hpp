#pragma once

#include <memory>
#include <string>

#include "easydyn/mbs/body.hpp"
#include "track/flexible_track.hpp"
#include "track/hertz_contact.hpp"
#include "track/profile.hpp"
#include "track/track_contact.hpp"

namespace easydyn::track {

/// The contact between one wheel pair and the rail at the moving place x(t) below the wheel.
///
///   delta = delta_Q + r(x) - w(x, t) - z          F = K delta^(3/2), delta > 0
///
/// z [m, up] is the height of the wheel above its place in the loaded state, in which the contact carries the
/// static load Q with the indentation delta_Q; w [m, down] is the deflection of the rail, r [m, up] the path
/// of the wheel over the profile. F pushes the wheel up and the rail down, both at x.
///
/// Energy: the contact stores 2/5 K delta^(5/2). Since it moves along the rail at v = x., it exchanges the
/// power F v (r' - w') with the drive that keeps the speed; this enters the account of supplied power.
class WheelRailContact : public TrackContact {
 public:
  /// @param wheel_radius  filters the profile [m], > 0
  /// @param static_load   Q [N], >= 0
  /// @param profile       shared by all wheels, not null
  /// @throws ModelError naming the contact, the value and the range
  WheelRailContact(std::string name, const HertzContact& law, double wheel_radius, double static_load,
                   std::shared_ptr<const Profile> profile);

  /// Applies the contact force; within System::forces().
  void apply(const Body& wheel, const FlexibleTrack& track);

  const std::string& name() const { return name_; }
  double static_load() const { return static_load_; }
  double force() const { return force_; }  ///< at the last evaluation [N]
  double x() const { return x_; }          ///< at the last evaluation [m]
  bool is_closed() const { return force_ > 0; }

  Force force_after(double change, double rate_change) const override;
  /// The wheel of the last evaluation.
  const Body* body() const override { return wheel_; }

 private:
  std::string name_;
  HertzContact law_;
  double radius_, static_load_, static_indentation_;
  std::shared_ptr<const Profile> profile_;
  // At the last evaluation.
  double force_ = 0, x_ = 0, indentation_ = 0;
  const Body* wheel_ = nullptr;
};

}  // namespace easydyn::track

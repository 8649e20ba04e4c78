#include "track/wheel_rail_contact.hpp"

#include "easydyn/require.hpp"

namespace easydyn::track {

WheelRailContact::WheelRailContact(std::string name, const HertzContact& law, double wheel_radius,
                                   double static_load, std::shared_ptr<const Profile> profile)
    : name_(std::move(name)),
      law_(law),
      radius_(wheel_radius),
      static_load_(static_load),
      static_indentation_(law.indentation_under(static_load)),
      profile_(std::move(profile)) {
  const std::string object = "contact \"" + name_ + "\"";
  require_positive(object, "wheel radius", wheel_radius, "m");
  require_not_negative(object, "static load", static_load, "N");
  if (!profile_) throw ModelError(object + ": there is no rail profile");
}

void WheelRailContact::apply(const Body& wheel, const FlexibleTrack& track) {
  wheel_ = &wheel;
  x_ = wheel.position().x();
  const double speed = wheel.velocity().x();
  const ProfilePoint path = profile_->at(x_, radius_);
  Port rail = track.touch_rail(x_);

  const double delta =
      static_indentation_ + HertzContact::indentation(wheel.position().z(), rail.displacement(), path.r);
  indentation_ = delta;
  force_ = law_.force(delta);
  rail.add_force(force_);
  wheel.add_force({0, 0, force_}, wheel.position());

  EnergyAccounts& energy = wheel.frame().tree()->energy();
  energy.potential += law_.energy(delta);
  energy.supplied += force_ * speed * (path.dr - rail.slope());
}

TrackContact::Force WheelRailContact::force_after(double change, double) const {
  const double delta = indentation_ + change;
  return {law_.force(delta), law_.stiffness(delta), 0};
}

}  // namespace easydyn::track

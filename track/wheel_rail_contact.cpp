#include "track/wheel_rail_contact.hpp"

#include <utility>

#include "easydyn/require.hpp"
#include "track/taper.hpp"

namespace easydyn::track {

WheelRailContact::WheelRailContact(std::string name, const HertzContact& law, double wheel_radius,
                                   double static_load, std::shared_ptr<const Profile> profile)
    : TrackContact(std::move(name)),
      law_(law),
      radius_(wheel_radius),
      static_load_(static_load),
      static_indentation_(law.indentation_under(static_load)),
      profile_(std::move(profile)) {
  const std::string object = "contact \"" + this->name() + "\"";
  require_positive(object, "wheel radius", wheel_radius, "m");
  require_not_negative(object, "static load", static_load, "N");
  if (!profile_) throw ModelError(object + ": there is no rail profile");
}

void WheelRailContact::set_wheel_shape(std::shared_ptr<const WheelShape> shape,
                                       const WheelShapeOptions& options) {
  const std::string object = "contact \"" + this->name() + "\", wheel shape";
  require_finite(object, "phase", options.phase, "rad");
  require_finite(object, "fade_begin", options.fade_begin, "m");
  require_not_negative(object, "fade_length", options.fade_length, "m");
  if (shape) shape->at(0, radius_);  // refuses a radius that does not fit it
  shape_ = std::move(shape);
  shape_options_ = options;
}

ProfilePoint WheelRailContact::path_at(double x) const {
  ProfilePoint path = profile_->at(x, radius_);
  if (shape_) {
    ProfilePoint own = shape_->at(x / radius_ + shape_options_.phase, radius_);
    if (shape_options_.fade_length > 0)
      own = product(smooth_step(x, shape_options_.fade_begin, shape_options_.fade_length), own);
    path.r += own.r;
    path.dr += own.dr;
    path.ddr += own.ddr;
  }
  return path;
}

void WheelRailContact::apply(const Body& wheel, const FlexibleTrack& track) {
  Port rail = track.touch_rail(wheel.position().x());
  apply_to_wheel(wheel, {rail.displacement(), rail.slope()});
  rail.add_force(force_);
}

void WheelRailContact::apply(const Body& wheel) {
  apply_to_wheel(wheel, {});
}

void WheelRailContact::apply_to_wheel(const Body& wheel, const RailMotion& rail) {
  wheel_ = &wheel;
  x_ = wheel.position().x();
  const double speed = wheel.velocity().x();
  const ProfilePoint path = path_at(x_);
  const double delta =
      static_indentation_ + HertzContact::indentation(wheel.position().z(), rail.deflection, path.r);
  indentation_ = delta;
  force_ = law_.force(delta);
  wheel.add_force({0, 0, force_}, wheel.position());

  EnergyAccounts& energy = wheel.frame().tree()->energy();
  energy.potential += law_.energy(delta);
  energy.supplied += force_ * speed * (path.dr - rail.slope);
}

TrackContact::Force WheelRailContact::force_after(double change, double) const {
  const double delta = indentation_ + change;
  return {law_.force(delta), law_.stiffness(delta), 0};
}

}  // namespace easydyn::track

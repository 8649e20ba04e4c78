#include "track/profile.hpp"

#include <cmath>
#include <utility>

#include "easydyn/require.hpp"

namespace easydyn::track {

StepProfile::StepProfile(double x0, double height) : x0_(x0), height_(height) {
  require_finite("step in the rail", "position", x0, "m");
  require_finite("step in the rail", "height", height, "m");
}

double StepProfile::ramp_length(double wheel_radius) const {
  const double h = std::abs(height_);
  if (!(wheel_radius > h))
    require(false, "step in the rail", "wheel radius", wheel_radius, "m",
            fmt::format("> |height| = {:g} m", h));
  return std::sqrt(h * (2 * wheel_radius - h));
}

ProfilePoint StepProfile::at(double x, double wheel_radius) const {
  const double a = ramp_length(wheel_radius), R = wheel_radius, s = x - x0_;
  const bool up = height_ > 0;
  // before and behind the ramp; the ramp includes its first point, not its last
  if (up ? s < -a : s < 0) return {};
  if (up ? s >= 0 : s >= a) return {height_, 0, 0};
  // on the circle about the edge; the top of the circle is r = h (up) or r = 0 (down)
  const double root = std::sqrt(R * R - s * s);
  const double top = up ? height_ : 0;
  return {top - s * s / (R + root), -s / root, -R * R / (root * root * root)};
}

ProfileSum::ProfileSum(std::vector<std::shared_ptr<const Profile>> parts) : parts_(std::move(parts)) {
  for (const auto& part : parts_)
    if (!part) throw ModelError("sum of profiles: a part is null");
}

ProfilePoint ProfileSum::at(double x, double wheel_radius) const {
  ProfilePoint sum;
  for (const auto& part : parts_) {
    const ProfilePoint p = part->at(x, wheel_radius);
    sum.r += p.r;
    sum.dr += p.dr;
    sum.ddr += p.ddr;
  }
  return sum;
}

}  // namespace easydyn::track

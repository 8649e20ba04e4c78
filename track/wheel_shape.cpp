#include "track/wheel_shape.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "easydyn/require.hpp"

namespace easydyn::track {

namespace {
constexpr double two_pi = 2 * std::numbers::pi;
}

WheelFlat::WheelFlat(bool is_rounded, double length, double depth, double angle)
    : is_rounded_(is_rounded), length_(length), depth_(depth), angle_(angle) {
  require_positive("wheel flat", "length", length, "m");
  require_not_negative("wheel flat", "depth", depth, "m");
  require_finite("wheel flat", "angle", angle, "rad");
}

WheelFlat WheelFlat::fresh(double length, double angle) {
  return {false, length, 0, angle};
}

WheelFlat WheelFlat::rounded(double length, double depth, double angle) {
  return {true, length, depth, angle};
}

double WheelFlat::depth(double wheel_radius) const {
  return -at(angle_, wheel_radius).r;
}

ProfilePoint WheelFlat::at(double angle, double wheel_radius) const {
  const double R = wheel_radius, half = length_ / 2;
  if (!(R > half))
    require(false, "wheel flat", "wheel radius", R, "m", fmt::format("> length / 2 = {:g} m", half));
  const double s = R * std::remainder(angle - angle_, two_pi);  // from the middle of the flat
  if (std::abs(s) >= half) return {};
  if (is_rounded_) {
    const double a = (depth_ > 0 ? depth_ : length_ * length_ / (8 * R)) / 2, k = two_pi / length_;
    return {-a * (1 + std::cos(k * s)), a * k * std::sin(k * s), a * k * k * std::cos(k * s)};
  }
  // on the circle about the corner of the chord that stands on the rail
  const double u = s < 0 ? s + half : s - half, root = std::sqrt(R * R - u * u);
  return {-u * u / (R + root), -u / root, -R * R / (root * root * root)};
}

OutOfRoundness::OutOfRoundness(std::vector<Order> orders) : orders_(std::move(orders)) {
  for (const Order& o : orders_) {
    require(o.order >= 1, "out-of-roundness", "order", o.order, "", ">= 1");
    require_finite("out-of-roundness", fmt::format("amplitude of order {}", o.order), o.amplitude, "m");
    require_finite("out-of-roundness", fmt::format("phase of order {}", o.order), o.phase, "rad");
  }
}

ProfilePoint OutOfRoundness::at(double angle, double wheel_radius) const {
  ProfilePoint sum;
  for (const Order& o : orders_) {
    const double k = o.order / wheel_radius, c = o.amplitude * std::cos(o.order * angle - o.phase),
                 s = o.amplitude * std::sin(o.order * angle - o.phase);
    sum.r += c;
    sum.dr -= k * s;
    sum.ddr -= k * k * c;
  }
  return sum;
}

WheelShapeSum::WheelShapeSum(std::vector<std::shared_ptr<const WheelShape>> parts)
    : parts_(std::move(parts)) {
  for (const auto& part : parts_)
    if (!part) throw ModelError("sum of wheel shapes: a part is null");
}

ProfilePoint WheelShapeSum::at(double angle, double wheel_radius) const {
  ProfilePoint sum;
  for (const auto& part : parts_) {
    const ProfilePoint p = part->at(angle, wheel_radius);
    sum.r += p.r;
    sum.dr += p.dr;
    sum.ddr += p.ddr;
  }
  return sum;
}

}  // namespace easydyn::track

#include "track/defects.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "easydyn/require.hpp"
#include "track/polyline_profile.hpp"
#include "track/rolled_profile.hpp"

namespace easydyn::track {

namespace {

constexpr double pi = std::numbers::pi;
using Points = std::vector<PolylineProfile::Point>;

// Unfiltered surfaces.
class DippedSurface : public Profile {
 public:
  DippedSurface(double x0, const DippedJoint& joint) : x0_(x0), joint_(joint) {}
  ProfilePoint at(double x, double) const override {
    const double s = joint_.length / 2 - std::abs(x - x0_);  // from the nearer end of the dip
    if (s <= 0) return {};
    const double k = pi / joint_.length, d = joint_.depth, side = x < x0_ ? 1 : -1;
    return {-d * (1 - std::cos(k * s)), -side * d * k * std::sin(k * s), -d * k * k * std::cos(k * s)};
  }

 private:
  double x0_;
  DippedJoint joint_;
};

class PulseSurface : public Profile {
 public:
  PulseSurface(double x0, const Pulse& pulse) : x0_(x0), pulse_(pulse) {}
  ProfilePoint at(double x, double) const override {
    const double s = x - x0_, k = 2 * pi / pulse_.length, a = pulse_.height / 2;
    if (std::abs(s) >= pulse_.length / 2) return {};
    return {a * (1 + std::cos(k * s)), -a * k * std::sin(k * s), -a * k * k * std::cos(k * s)};
  }

 private:
  double x0_;
  Pulse pulse_;
};

// Turns a surface around x0.
Points mirrored(Points points, double x0) {
  std::reverse(points.begin(), points.end());
  for (auto& point : points) point.x = 2 * x0 - point.x;
  return points;
}

std::shared_ptr<const Profile> polyline(const std::string& name, Points points) {
  return std::make_shared<PolylineProfile>(name, std::move(points));
}

}  // namespace

std::shared_ptr<const Profile> dipped_joint(double x0, const DippedJoint& joint) {
  require_finite("dipped joint", "position", x0, "m");
  require_not_negative("dipped joint", "depth", joint.depth, "m");
  require_positive("dipped joint", "length", joint.length, "m");
  return std::make_shared<RolledProfile>("dipped joint", std::make_shared<DippedSurface>(x0, joint),
                                         RolledProfileOptions{.begin = x0 - joint.length / 2,
                                                              .end = x0 + joint.length / 2,
                                                              .breaks = {x0},
                                                              .step = std::min(2.5e-4, joint.length / 400)});
}

std::shared_ptr<const Profile> pulse(double x0, const Pulse& pulse) {
  require_finite("pulse", "position", x0, "m");
  require_finite("pulse", "height", pulse.height, "m");
  require_positive("pulse", "length", pulse.length, "m");
  return std::make_shared<RolledProfile>("pulse", std::make_shared<PulseSurface>(x0, pulse),
                                         RolledProfileOptions{.begin = x0 - pulse.length / 2,
                                                              .end = x0 + pulse.length / 2,
                                                              .breaks = {},
                                                              .step = std::min(2.5e-4, pulse.length / 400)});
}

std::shared_ptr<const Profile> rail_gap(double x0, const RailGap& gap) {
  require_finite("rail gap", "position", x0, "m");
  require_positive("rail gap", "width", gap.width, "m");
  require_finite("rail gap", "height difference", gap.height_difference, "m");
  const double h = gap.height_difference;
  // as deep as wide: no wheel with R > width reaches the floor
  const double floor = std::min(0.0, h) - gap.width;
  return polyline("rail gap", {{x0, 0}, {x0, floor}, {x0 + gap.width, floor}, {x0 + gap.width, h}});
}

std::shared_ptr<const Profile> switch_transfer(double x0, const SwitchTransfer& transfer) {
  require_finite("switch", "position", x0, "m");
  require_not_negative("switch", "depth", transfer.depth, "m");
  require_positive("switch", "length", transfer.length, "m");
  require_finite("switch", "height difference", transfer.height_difference, "m");
  const double l = transfer.length, d = transfer.depth;
  Points points = {{x0 - l, 0}, {x0, -d}, {x0, -d - transfer.height_difference}, {x0 + l, 0}};
  return polyline("switch", transfer.is_trailing ? mirrored(points, x0) : points);
}

std::shared_ptr<const Profile> crossing(double x0, const Crossing& crossing) {
  require_finite("crossing", "position", x0, "m");
  require_not_negative("crossing", "wing depth", crossing.wing_depth, "m");
  require_positive("crossing", "wing length", crossing.wing_length, "m");
  require_not_negative("crossing", "gap", crossing.gap, "m");
  require_not_negative("crossing", "nose depth", crossing.nose_depth, "m");
  require_positive("crossing", "nose length", crossing.nose_length, "m");
  const double landing = x0 + crossing.gap;
  Points points = {{x0 - crossing.wing_length, 0}, {x0, -crossing.wing_depth}};
  if (crossing.gap > 0) {
    const double floor = -std::max(crossing.wing_depth, crossing.nose_depth) - crossing.gap;
    points.insert(points.end(), {{x0, floor}, {landing, floor}});
  }
  points.insert(points.end(), {{landing, -crossing.nose_depth}, {landing + crossing.nose_length, 0}});
  return polyline("crossing", crossing.is_trailing ? mirrored(points, x0) : points);
}

}  // namespace easydyn::track

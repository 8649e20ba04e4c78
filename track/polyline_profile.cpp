#include "track/polyline_profile.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "easydyn/require.hpp"

namespace easydyn::track {

PolylineProfile::PolylineProfile(std::string name, std::vector<Point> points)
    : name_(std::move(name)), points_(std::move(points)) {
  const std::string object = "profile \"" + name_ + "\"";
  require(!points_.empty(), object, "number of points", 0, "", ">= 1");
  double low = points_[0].y, high = low;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    require_finite(object, fmt::format("position of point {}", i + 1), points_[i].x, "m");
    require_finite(object, fmt::format("height of point {}", i + 1), points_[i].y, "m");
    if (i > 0)
      require(points_[i].x >= points_[i - 1].x, object, fmt::format("position of point {}", i + 1),
              points_[i].x, "m", fmt::format(">= {:g} m, that of the point before", points_[i - 1].x));
    low = std::min(low, points_[i].y);
    high = std::max(high, points_[i].y);
  }
  height_ = high - low;
}

ProfilePoint PolylineProfile::at(double x, double wheel_radius) const {
  const double R = wheel_radius;
  if (!(R > height_))
    require(false, "profile \"" + name_ + "\"", "wheel radius", R, "m",
            fmt::format("> {:g} m, from its lowest to its highest point", height_));
  const Point &first = points_.front(), &last = points_.back();
  // beyond `reach` a corner lies lower on the wheel than the lowest point
  const double reach = std::sqrt(height_ * (2 * R - height_));
  if (x < first.x - reach) return {first.y, 0, 0};
  if (x > last.x + reach) return {last.y, 0, 0};

  ProfilePoint best{-INFINITY, 0, 0};
  const auto offer = [&best](const ProfilePoint& p) {
    if (p.r > best.r || (p.r == best.r && p.dr > best.dr)) best = p;
  };
  if (x <= first.x) offer({first.y, 0, 0});
  if (x >= last.x) offer({last.y, 0, 0});
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double s = points_[i].x - x;  // of the corner, ahead of the wheel centre
    if (std::abs(s) < R) {
      const double root = std::sqrt(R * R - s * s);
      offer({points_[i].y - s * s / (R + root), s / root, -R * R / (root * root * root)});
    }
    if (i + 1 == points_.size() || points_[i + 1].x == points_[i].x) continue;
    const double m = (points_[i + 1].y - points_[i].y) / (points_[i + 1].x - points_[i].x);
    const double n = std::sqrt(1 + m * m), c = x + R * m / n;
    if (c >= points_[i].x && c < points_[i + 1].x)
      offer({points_[i].y + m * (c - points_[i].x) - R * (m * m) / (n * (n + 1)), m, 0});
  }
  return best;
}

}  // namespace easydyn::track

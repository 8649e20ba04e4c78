#include "track/spline_profile.hpp"

#include <algorithm>
#include <utility>

#include "easydyn/require.hpp"

namespace easydyn::track {

SplineProfile::SplineProfile(std::string name, std::vector<double> x, std::vector<double> r,
                             const SplineProfileOptions& options)
    : name_(std::move(name)),
      x_(std::move(x)),
      r_(std::move(r)),
      is_held_(options.beyond == BeyondPoints::held),
      is_tapered_(options.taper > 0) {
  const std::string object = "profile \"" + name_ + "\"";
  const std::size_t n = x_.size();
  require(n >= 4, object, "number of points", static_cast<double>(n), "", ">= 4");
  require(r_.size() == n, object, "number of heights", static_cast<double>(r_.size()), "",
          fmt::format("{}, one per position", n));
  for (std::size_t i = 0; i < n; ++i) {
    require_finite(object, fmt::format("position of point {}", i + 1), x_[i], "m");
    require_finite(object, fmt::format("height of point {}", i + 1), r_[i], "m");
    if (i > 0)
      require(x_[i] > x_[i - 1], object, fmt::format("position of point {}", i + 1), x_[i], "m",
              fmt::format("> {:g} m, that of the point before", x_[i - 1]));
  }
  require_not_negative(object, "taper", options.taper, "m");
  require(2 * options.taper <= x_.back() - x_.front(), object, "taper", options.taper, "m",
          fmt::format("<= {:g} m, half of its length", (x_.back() - x_.front()) / 2));
  if (is_held_) {
    require(!is_tapered_, object, "taper", options.taper, "m", "0 where the ends are held");
  } else if (!is_tapered_) {
    for (const double end : {r_.front(), r_.back()})
      require(end == 0, object, "height of an end", end, "m", "0 without a taper, as it is zero beyond");
  }
  taper_ = {x_.front(), x_.back(), options.taper, options.taper};
  pieces_per_metre_ = static_cast<double>(n - 1) / (x_.back() - x_.front());

  // Slopes m_i of equal curvature on both sides of the points, tridiagonal, by elimination (Thomas); 0 at the ends:
  // m_{i-1} / h_{i-1} + 2 (1/h_{i-1} + 1/h_i) m_i + m_{i+1} / h_i
  //   = 3 ((r_i - r_{i-1}) / h_{i-1}^2 + (r_{i+1} - r_i) / h_i^2)
  slope_.assign(n, 0);
  std::vector<double> above(n, 0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = 1 / (x_[i] - x_[i - 1]), behind = 1 / (x_[i + 1] - x_[i]);
    const double right = 3 * ((r_[i] - r_[i - 1]) * before * before + (r_[i + 1] - r_[i]) * behind * behind);
    const double pivot = 2 * (before + behind) - before * above[i - 1];
    above[i] = behind / pivot;
    slope_[i] = (right - before * slope_[i - 1]) / pivot;
  }
  for (std::size_t i = n - 2; i >= 1; --i) slope_[i] -= above[i] * slope_[i + 1];
}

std::size_t SplineProfile::piece_of(double x) const {
  const std::size_t last = x_.size() - 2;
  // right at once where the points are equidistant
  const std::size_t guess = std::min(static_cast<std::size_t>((x - x_.front()) * pieces_per_metre_), last);
  if (x_[guess] <= x && x < x_[guess + 1]) return guess;
  const auto behind = std::upper_bound(x_.begin(), x_.end(), x);
  return std::min(static_cast<std::size_t>(behind - x_.begin()) - 1, last);
}

ProfilePoint SplineProfile::at(double x, double) const {
  if (!(x >= x_.front())) return {is_held_ ? r_.front() : 0, 0, 0};
  if (x > x_.back()) return {is_held_ ? r_.back() : 0, 0, 0};
  const std::size_t i = piece_of(x);
  const double h = x_[i + 1] - x_[i], t = (x - x_[i]) / h;
  const double rise = (r_[i + 1] - r_[i]) / h, a = slope_[i], b = slope_[i + 1];
  const double square = 3 * rise - 2 * a - b, cube = a + b - 2 * rise;
  const ProfilePoint spline{r_[i] + h * t * (a + t * (square + t * cube)),
                            a + t * (2 * square + 3 * t * cube), (2 * square + 6 * t * cube) / h};
  return is_tapered_ ? product(taper_.at(x), spline) : spline;
}

}  // namespace easydyn::track

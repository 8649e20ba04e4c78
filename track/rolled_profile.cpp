#include "track/rolled_profile.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "easydyn/require.hpp"

namespace easydyn::track {

// The wheel centre at x touches the surface at c.
struct RolledProfile::Contact {
  double x, c, r, dr;
};

// A cubic through heights and slopes at both ends.
struct RolledProfile::Piece {
  double x, length, r0, dr0, r1, dr1;
};

struct RolledProfile::Table {
  double radius;
  std::vector<Piece> pieces;
  std::vector<double> kinks;
  std::unique_ptr<const Table> next;
};

RolledProfile::~RolledProfile() {
  delete tables_.load();
}

RolledProfile::RolledProfile(std::string name, std::shared_ptr<const Profile> surface,
                             RolledProfileOptions options)
    : name_(std::move(name)), surface_(std::move(surface)), options_(std::move(options)) {
  const std::string object = "rolled profile \"" + name_ + "\"";
  if (!surface_) throw ModelError(object + ": there is no surface");
  const double begin = options_.begin, end = options_.end;
  require_finite(object, "begin", begin, "m");
  require(end > begin, object, "end", end, "m", fmt::format("> begin = {:g} m", begin));
  require(options_.step > 0 && options_.step <= (end - begin) / 4, object, "step", options_.step, "m",
          fmt::format("> 0 and <= {:g} m, a quarter of the length", (end - begin) / 4));
  require((end - begin) / options_.step < 1e7, object, "step", options_.step, "m",
          fmt::format("> {:g} m", (end - begin) / 1e7));
  for (const double b : options_.breaks)
    require(b >= begin && b <= end, object, "break", b, "m", fmt::format("{:g} m to {:g} m", begin, end));

  const auto cells = static_cast<std::size_t>(std::ceil((end - begin) / options_.step));
  x_ = options_.breaks;
  for (std::size_t i = 0; i < cells; ++i)
    x_.push_back(begin + (end - begin) * static_cast<double>(i) / static_cast<double>(cells));
  x_.push_back(end);
  std::sort(x_.begin(), x_.end());
  x_.erase(std::unique(x_.begin(), x_.end()), x_.end());
  for (const double x : x_) {
    double p = surface_->at(x, 1).r;
    if (std::find(options_.breaks.begin(), options_.breaks.end(), x) != options_.breaks.end())
      for (const double side : {std::nextafter(x, begin), std::nextafter(x, end)})
        p = std::max(p, surface_->at(side, 1).r);
    require_finite(object, fmt::format("height at x = {:g} m", x), p, "m");
    p_.push_back(p);
  }
  const auto [low, high] = std::minmax_element(p_.begin(), p_.end());
  height_ = *high - *low;
}

double RolledProfile::reach(double R) const {
  if (!(R > height_))
    require(false, "rolled profile \"" + name_ + "\"", "wheel radius", R, "m",
            fmt::format("> {:g} m, from its lowest to its highest point", height_));
  return std::sqrt(height_ * (2 * R - height_));
}

RolledProfile::Contact RolledProfile::touch(double x, double R) const {
  const double a = reach(R) + options_.step;
  const auto slope_at = [&](double c) { return (c - x) / std::sqrt(R * R - (c - x) * (c - x)); };
  const auto height_at = [&](double c, double p) {
    const double s = c - x;
    return p - s * s / (R + std::sqrt(R * R - s * s));
  };
  Contact best{x, x, -INFINITY, 0};
  const auto offer = [&](double c, double p) {
    const double r = height_at(c, p), dr = slope_at(c);
    if (r > best.r || (r == best.r && dr > best.dr)) best = {x, c, r, dr};
  };
  if (x <= x_.front()) offer(x, p_.front());
  if (x >= x_.back()) offer(x, p_.back());

  const double window = std::min(a, R);
  const auto first = std::upper_bound(x_.begin(), x_.end(), x - window) - x_.begin();
  const auto behind = std::lower_bound(x_.begin(), x_.end(), x + window) - x_.begin();
  for (auto j = first; j < behind; ++j)
    offer(x_[static_cast<std::size_t>(j)], p_[static_cast<std::size_t>(j)]);
  // A vertex misses the maximum beside it by (|p''| + 1/R) step^2 / 8 at most; look beside all that come so near.
  const double near_best = best.r - 4 * options_.step * options_.step / R;
  const double inset = 1e-6 * options_.step;  // to see the slopes inside a cell, not at a corner
  double cell_seen = -INFINITY;
  for (auto j = first; j < behind; ++j) {
    const auto v = static_cast<std::size_t>(j);
    if (height_at(x_[v], p_[v]) < near_best) continue;
    for (std::size_t left = v == 0 ? 0 : v - 1; left <= v && left + 1 < x_.size(); ++left) {
      if (x_[left] <= cell_seen) continue;
      cell_seen = x_[left];
      double low = x_[left] + inset, high = x_[left + 1] - inset;
      if (!(std::abs(low - x) < R && std::abs(high - x) < R)) continue;
      const auto gain = [&](double c) { return surface_->at(c, R).dr - slope_at(c); };
      if (!(gain(low) > 0 && gain(high) < 0)) continue;
      for (int i = 0; i < 40; ++i) {  // to the last digit
        const double middle = 0.5 * (low + high);
        (gain(middle) > 0 ? low : high) = middle;
      }
      const double c = 0.5 * (low + high);
      offer(c, surface_->at(c, R).r);
    }
  }
  return best;
}

ProfilePoint RolledProfile::compute(double x, double wheel_radius) const {
  const double R = wheel_radius;
  const Contact here = touch(x, R);
  // r'' = p'' g / (g - p'') on a smooth surface, -g on a corner; g = d(slope of the wheel)/ds
  const double root = std::sqrt(R * R - (here.c - x) * (here.c - x)), g = R * R / (root * root * root);
  if (here.c == x && (x <= x_.front() || x >= x_.back())) return {here.r, 0, 0};
  const auto& corners = options_.breaks;
  if (here.c == x_.front() || here.c == x_.back() ||
      std::find(corners.begin(), corners.end(), here.c) != corners.end())
    return {here.r, here.dr, -g};
  const double curvature = surface_->at(here.c, R).ddr;
  return {here.r, here.dr, curvature * g / (g - curvature)};
}

void RolledProfile::add_pieces(Table& table, const Contact& from, const Contact& to) const {
  if (to.c - from.c > 1.5 * options_.step) {  // the contact leaps, or hurries
    const double middle = 0.5 * (from.x + to.x);
    if (to.x - from.x > 1e-11 && middle > from.x && middle < to.x) {
      const Contact between = touch(middle, table.radius);
      add_pieces(table, from, between);
      add_pieces(table, between, to);
      return;
    }
    table.kinks.push_back(middle);
  }
  if (to.x > from.x) table.pieces.push_back({from.x, to.x - from.x, from.r, from.dr, to.r, to.dr});
}

const RolledProfile::Table& RolledProfile::table_of(double R) const {
  for (const Table* t = tables_.load(std::memory_order_acquire); t; t = t->next.get())
    if (t->radius == R) return *t;
  const std::lock_guard lock(making_);
  for (const Table* t = tables_.load(std::memory_order_acquire); t; t = t->next.get())
    if (t->radius == R) return *t;
  auto table = std::make_unique<Table>();
  table->radius = R;
  const double a = reach(R) + options_.step;
  const double begin = x_.front() - a, end = x_.back() + a;
  const auto cells = static_cast<std::size_t>(std::ceil((end - begin) / options_.step));
  Contact from = touch(begin, R);
  for (std::size_t i = 1; i <= cells; ++i) {
    const Contact to = touch(begin + (end - begin) * static_cast<double>(i) / static_cast<double>(cells), R);
    add_pieces(*table, from, to);
    from = to;
  }
  table->next.reset(tables_.load());
  tables_.store(table.get(), std::memory_order_release);
  return *table.release();
}

ProfilePoint RolledProfile::at(double x, double wheel_radius) const {
  const Table& table = table_of(wheel_radius);
  const Piece &first = table.pieces.front(), &last = table.pieces.back();
  if (!(x > first.x)) return {p_.front(), 0, 0};
  if (x >= last.x + last.length) return {p_.back(), 0, 0};
  const auto behind = std::upper_bound(table.pieces.begin(), table.pieces.end(), x,
                                       [](double place, const Piece& piece) { return place < piece.x; });
  const Piece& p = *(behind - 1);
  const double h = p.length, t = (x - p.x) / h;
  const double rise = (p.r1 - p.r0) / h, square = 3 * rise - 2 * p.dr0 - p.dr1,
               cube = p.dr0 + p.dr1 - 2 * rise;
  return {p.r0 + h * t * (p.dr0 + t * (square + t * cube)), p.dr0 + t * (2 * square + 3 * t * cube),
          (2 * square + 6 * t * cube) / h};
}

std::vector<double> RolledProfile::kinks(double wheel_radius) const {
  return table_of(wheel_radius).kinks;
}

}  // namespace easydyn::track

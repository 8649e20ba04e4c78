#include "easydyn/math/characteristic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "easydyn/error.hpp"

namespace easydyn {

namespace {

// Slope at an end from the two nearest pieces (three-point formula), cut so that the curve stays monotone.
double end_slope(double h0, double h1, double d0, double d1) {
  const double slope = ((2 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
  if (slope * d0 <= 0) return 0;
  if (d0 * d1 <= 0 && std::abs(slope) > 3 * std::abs(d0)) return 3 * d0;
  return slope;
}

}  // namespace

Characteristic Characteristic::table(const std::string& object, std::vector<double> x,
                                     std::vector<double> y) {
  if (x.size() != y.size() || x.size() < 2)
    throw ModelError(
        fmt::format("{}: a table of {} x and {} y, must be as many, at least 2", object, x.size(), y.size()));
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i]))
      throw ModelError(fmt::format("{}: point {} of the table is ({:g}, {:g}), must be finite", object, i + 1,
                                   x[i], y[i]));
    if (i > 0 && !(x[i] > x[i - 1]))
      throw ModelError(fmt::format("{}: x of point {} of the table is {:g}, must be > {:g}", object, i + 1,
                                   x[i], x[i - 1]));
  }

  Characteristic c;
  const std::size_t n = x.size();
  std::vector<double> h(n - 1), d(n - 1);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    h[i] = x[i + 1] - x[i];
    d[i] = (y[i + 1] - y[i]) / h[i];
  }
  c.slope_.resize(n);
  if (n == 2) {
    c.slope_[0] = c.slope_[1] = d[0];
  } else {
    c.slope_[0] = end_slope(h[0], h[1], d[0], d[1]);
    c.slope_[n - 1] = end_slope(h[n - 2], h[n - 3], d[n - 2], d[n - 3]);
    for (std::size_t i = 1; i + 1 < n; ++i) {
      // weighted harmonic mean; 0 at a turning point
      const double w1 = 2 * h[i] + h[i - 1], w2 = h[i] + 2 * h[i - 1];
      c.slope_[i] = d[i - 1] * d[i] <= 0 ? 0 : (w1 + w2) / (w1 / d[i - 1] + w2 / d[i]);
    }
  }
  c.integral_.assign(n, 0);
  for (std::size_t i = 0; i + 1 < n; ++i)
    c.integral_[i + 1] =
        c.integral_[i] + h[i] * (y[i] + y[i + 1]) / 2 + h[i] * h[i] * (c.slope_[i] - c.slope_[i + 1]) / 12;
  c.x_ = std::move(x);
  c.y_ = std::move(y);
  c.integral_at_zero_ = c.integral_from_start(0);
  return c;
}

Characteristic Characteristic::function(std::function<double(double)> y,
                                        std::function<double(double)> integral) {
  if (!y) throw ModelError("characteristic: the function is empty");
  Characteristic c;
  c.function_ = std::move(y);
  c.function_integral_ = std::move(integral);
  return c;
}

std::size_t Characteristic::piece_of(double x) const {
  const auto right = std::upper_bound(x_.begin() + 1, x_.end() - 1, x);
  return static_cast<std::size_t>(right - x_.begin()) - 1;
}

double Characteristic::value(double x) const {
  if (function_) return function_(x);
  if (x <= x_.front()) return y_.front() + slope_.front() * (x - x_.front());
  if (x >= x_.back()) return y_.back() + slope_.back() * (x - x_.back());
  const std::size_t i = piece_of(x);
  const double h = x_[i + 1] - x_[i], t = (x - x_[i]) / h, u = 1 - t;
  return u * u * ((1 + 2 * t) * y_[i] + t * h * slope_[i]) +
         t * t * ((1 + 2 * u) * y_[i + 1] - u * h * slope_[i + 1]);
}

double Characteristic::slope(double x) const {
  if (function_) {
    const double d = 1e-5 * (1 + std::abs(x));
    return (function_(x + d) - function_(x - d)) / (2 * d);
  }
  if (x <= x_.front()) return slope_.front();
  if (x >= x_.back()) return slope_.back();
  const std::size_t i = piece_of(x);
  const double h = x_[i + 1] - x_[i], t = (x - x_[i]) / h, u = 1 - t;
  return 6 * t * u * (y_[i + 1] - y_[i]) / h + u * (u - 2 * t) * slope_[i] + t * (t - 2 * u) * slope_[i + 1];
}

// Of a table, from its first point.
double Characteristic::integral_from_start(double x) const {
  if (x <= x_.front()) {
    const double s = x - x_.front();
    return s * (y_.front() + 0.5 * slope_.front() * s);
  }
  if (x >= x_.back()) {
    const double s = x - x_.back();
    return integral_.back() + s * (y_.back() + 0.5 * slope_.back() * s);
  }
  const std::size_t i = piece_of(x);
  const double h = x_[i + 1] - x_[i], t = (x - x_[i]) / h;
  const double t2 = t * t, t3 = t2 * t, t4 = t3 * t;
  return integral_[i] + h * (y_[i] * (t - t3 + t4 / 2) + h * slope_[i] * (t2 / 2 - 2 * t3 / 3 + t4 / 4) +
                             y_[i + 1] * (t3 - t4 / 2) + h * slope_[i + 1] * (t4 / 4 - t3 / 3));
}

double Characteristic::integral(double x) const {
  if (!function_) return integral_from_start(x) - integral_at_zero_;
  if (function_integral_) return function_integral_(x) - function_integral_(0);
  // Gauss-Legendre, 8 points on each part
  constexpr double place[4] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                               0.9602898564975363},
                   weight[4] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                0.1012285362903763};
  constexpr int parts = 16;
  const double half = x / (2 * parts);
  double sum = 0;
  for (int p = 0; p < parts; ++p) {
    const double middle = (2 * p + 1) * half;
    for (int k = 0; k < 4; ++k)
      sum += weight[k] * (function_(middle + place[k] * half) + function_(middle - place[k] * half));
  }
  return sum * half;
}

}  // namespace easydyn

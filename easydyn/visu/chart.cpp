#include "easydyn/visu/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "easydyn/error.hpp"
#include "easydyn/visu/json.hpp"

namespace easydyn::visu {

namespace {

using json::Value;

constexpr std::array<const char*, 6> stroke_names = {"line",  "dashed", "points", "line_and_points",
                                                     "steps", "bars"};

void require(bool condition, const std::string& message) {
  if (!condition) throw ModelError(message);
}

void check_curve(const std::string& name, const Axis& axis, const Eigen::VectorXd& x,
                 Eigen::Index size_of_y) {
  require(x.size() >= 1, fmt::format("{}: no points", name));
  require(x.size() == size_of_y, fmt::format("{}: {} values of x, {} of y", name, x.size(), size_of_y));
  require(x.allFinite(), fmt::format("{}: a value of x is not finite", name));
  for (Eigen::Index i = 1; i < x.size(); ++i)
    require(x(i) >= x(i - 1),
            fmt::format("{}: x must ascend, but x[{}] = {} follows {}", name, i, x(i), x(i - 1)));
  require(axis.scale == Scale::linear || x(0) > 0,
          fmt::format("{}: x[0] = {} on a logarithmic axis, must be > 0", name, x(0)));
}

Value to_value(const Axis& axis) {
  Value::Object object = {
      {"label", axis.label}, {"unit", axis.unit}, {"log", axis.scale == Scale::logarithmic}};
  if (axis.min) object.emplace_back("min", *axis.min);
  if (axis.max) object.emplace_back("max", *axis.max);
  if (!axis.ticks.empty()) object.emplace_back("ticks", Value::Array(axis.ticks.begin(), axis.ticks.end()));
  return object;
}

/// The chart's curves on their way to the page; those over the same x share it.
class Curves {
 public:
  int add_x(const Eigen::VectorXd& x, const std::vector<Eigen::Index>& kept) {
    std::string text = encoded(x, kept);
    const auto found = std::find(xs_.begin(), xs_.end(), text);
    if (found != xs_.end()) return int(found - xs_.begin());
    xs_.push_back(std::move(text));
    return int(xs_.size()) - 1;
  }

  static std::string encoded(const Eigen::VectorXd& values, const std::vector<Eigen::Index>& kept) {
    std::vector<float> floats;
    floats.reserve(kept.size());
    for (const Eigen::Index i : kept) floats.push_back(float(values(i)));
    return json::base64(floats);
  }

  Value xs() const { return Value::Array(xs_.begin(), xs_.end()); }

 private:
  std::vector<std::string> xs_;
};

}  // namespace

void check(const Chart& chart) {
  const std::string name = fmt::format("chart \"{}\"", chart.title);
  require(!chart.series.empty() || !chart.bands.empty(), name + ": nothing to draw");
  for (const Series& s : chart.series)
    check_curve(fmt::format("{}, series \"{}\"", name, s.name), chart.x, s.x, s.y.size());
  for (const Band& b : chart.bands) {
    check_curve(fmt::format("{}, band \"{}\"", name, b.name), chart.x, b.x, b.lower.size());
    check_curve(fmt::format("{}, band \"{}\"", name, b.name), chart.x, b.x, b.upper.size());
  }
  require(chart.height >= 100, fmt::format("{}: height = {} px, must be >= 100", name, chart.height));
  for (const Axis& axis : {chart.x, chart.y}) {
    require(!axis.min || !axis.max || *axis.min < *axis.max,
            fmt::format("{}: axis \"{}\" runs from {} to {}", name, axis.label, axis.min.value_or(0),
                        axis.max.value_or(0)));
    require(axis.scale == Scale::linear || !axis.min || *axis.min > 0,
            fmt::format("{}: axis \"{}\" is logarithmic and starts at {}, must be > 0", name, axis.label,
                        axis.min.value_or(0)));
  }
}

std::vector<Eigen::Index> thinned_indices(const Eigen::VectorXd& x, const Eigen::MatrixXd& y,
                                          int max_points) {
  const Eigen::Index n = x.size(), columns = y.cols();
  std::vector<Eigen::Index> kept;
  if (n <= max_points) {
    for (Eigen::Index i = 0; i < n; ++i) kept.push_back(i);
    return kept;
  }

  // of every slice: the first sample and, per curve, the extremes and one sample of every gap's two sides
  const Eigen::Index slices = std::max<Eigen::Index>(1, (max_points - 1) / (1 + 2 * columns));
  for (Eigen::Index s = 0; s < slices; ++s) {
    const Eigen::Index begin = s * n / slices, end = (s + 1) * n / slices;
    std::vector<Eigen::Index> slice = {begin};
    for (Eigen::Index c = 0; c < columns; ++c) {
      Eigen::Index low = -1, high = -1;
      for (Eigen::Index i = begin; i < end; ++i) {
        const bool gap = std::isnan(y(i, c));
        if (i > 0 && gap != std::isnan(y(i - 1, c))) slice.insert(slice.end(), {std::max(begin, i - 1), i});
        if (gap) continue;
        if (low < 0 || y(i, c) < y(low, c)) low = i;
        if (high < 0 || y(i, c) > y(high, c)) high = i;
      }
      if (low >= 0) slice.insert(slice.end(), {low, high});
    }
    std::sort(slice.begin(), slice.end());
    slice.erase(std::unique(slice.begin(), slice.end()), slice.end());
    kept.insert(kept.end(), slice.begin(), slice.end());
  }
  if (kept.back() != n - 1) kept.push_back(n - 1);
  return kept;
}

std::string to_json(const Chart& chart, int max_points) {
  check(chart);
  Curves curves;
  Value::Array series, bands;
  for (const Series& s : chart.series) {
    const auto kept = thinned_indices(s.x, s.y, max_points);
    series.push_back(json::object({{"name", s.name},
                                   {"stroke", stroke_names[size_t(s.stroke)]},
                                   {"colour", s.colour},
                                   {"x", curves.add_x(s.x, kept)},
                                   {"y", Curves::encoded(s.y, kept)}}));
  }
  for (const Band& b : chart.bands) {
    Eigen::MatrixXd edges(b.x.size(), 2);
    edges << b.lower, b.upper;
    const auto kept = thinned_indices(b.x, edges, max_points);
    bands.push_back(json::object({{"name", b.name},
                                  {"colour", b.colour},
                                  {"x", curves.add_x(b.x, kept)},
                                  {"lower", Curves::encoded(b.lower, kept)},
                                  {"upper", Curves::encoded(b.upper, kept)}}));
  }
  return json::object({{"title", chart.title},
                       {"x", to_value(chart.x)},
                       {"y", to_value(chart.y)},
                       {"height", chart.height},
                       {"xs", curves.xs()},
                       {"series", series},
                       {"bands", bands}})
      .text();
}

}  // namespace easydyn::visu

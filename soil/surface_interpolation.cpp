#include "soil/surface_interpolation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "easydyn/error.hpp"
#include "soil/gll.hpp"

namespace easydyn::soil {

namespace {

struct LineWeight {
  int node;
  double weight;
};

/// Integrals of the shape functions of a line of elements over [a, b].
std::vector<LineWeight> integrate_line(const GllRule& rule, const std::vector<double>& lines, double a,
                                       double b) {
  std::vector<LineWeight> result;
  for (std::size_t e = 0; e + 1 < lines.size(); ++e) {
    const double low = std::max(a, lines[e]), high = std::min(b, lines[e + 1]);
    if (!(low < high)) continue;
    const double h = lines[e + 1] - lines[e];
    const Eigen::VectorXd part =
        h / 2 * rule.integrate_shape(2 * (low - lines[e]) / h - 1, 2 * (high - lines[e]) / h - 1);
    for (int i = 0; i <= rule.degree; ++i) {
      const int node = static_cast<int>(e) * rule.degree + i;
      if (!result.empty() && result.back().node == node)
        result.back().weight += part(i);
      else
        result.push_back({node, part(i)});
    }
  }
  return result;
}

std::vector<LineWeight> interpolate_line(const GllRule& rule, const std::vector<double>& lines, double p) {
  const auto above = std::upper_bound(lines.begin(), lines.end(), p);
  const int e =
      std::clamp(static_cast<int>(above - lines.begin()) - 1, 0, static_cast<int>(lines.size()) - 2);
  const Eigen::VectorXd shape = rule.compute_shape(2 * (p - lines[e]) / (lines[e + 1] - lines[e]) - 1);
  std::vector<LineWeight> result;
  for (int i = 0; i <= rule.degree; ++i) result.push_back({e * rule.degree + i, shape(i)});
  return result;
}

/// Over a..b; folded back at 0 where the lattice ends there.
std::vector<LineWeight> integrate_folded(const GllRule& rule, const std::vector<double>& lines, double a,
                                         double b, bool folds) {
  if (!folds || (a >= 0 && b >= 0)) return integrate_line(rule, lines, a, b);
  std::vector<LineWeight> result = integrate_line(rule, lines, std::max(-b, 0.0), -a);
  if (b > 0)
    for (const LineWeight& w : integrate_line(rule, lines, 0, b)) result.push_back(w);
  return result;
}

void check_range(const char* axis, std::size_t number, double low, double high, std::array<double, 2> range) {
  if (!(low >= range[0] - 1e-9 && high <= range[1] + 1e-9))
    throw ModelError(
        fmt::format("footprint {}: {} = {:.6g}..{:.6g} m, must be in {:.6g}..{:.6g} m, the undamped ground",
                    number, axis, low, high, range[0], range[1]));
}

}  // namespace

FootprintWeights compute_footprint_weights(const Lattice& lattice, const Footprint& footprint,
                                           std::size_t number) {
  double x0 = footprint.x - footprint.length / 2;
  const double x1 = footprint.x + footprint.length / 2;
  double y0 = footprint.y - footprint.width / 2;
  const double y1 = footprint.y + footprint.width / 2;
  if (lattice.half_model) {
    if (!(std::abs(footprint.y) < 1e-9))
      throw ModelError(
          fmt::format("footprint {}: y = {} m, must be 0 in the half model (a load off the axis needs the "
                      "full model, option --full-model)",
                      number, footprint.y));
    y0 = 0;
  }
  if (lattice.quarter_model) {
    if (!(std::abs(footprint.x) < 1e-9))
      throw ModelError(
          fmt::format("footprint {}: x = {} m, must be 0 in the quarter model", number, footprint.x));
    x0 = 0;
  }
  check_range("x", number, x0, x1, lattice.interior_x());
  check_range("y", number, y0, y1, lattice.interior_y());

  const GllRule rule(lattice.degree);
  const int top = lattice.nz() * lattice.degree;
  FootprintWeights result;
  if (footprint.is_point()) {
    const double share = (lattice.half_model ? 0.5 : 1) * (lattice.quarter_model ? 0.5 : 1);
    for (const LineWeight& wy : interpolate_line(rule, lattice.y, footprint.y))
      for (const LineWeight& wx : interpolate_line(rule, lattice.x, footprint.x)) {
        const double weight = wx.weight * wy.weight;
        if (std::abs(weight) < 1e-14) continue;
        result.force.push_back({wx.node, wy.node, top, share * weight});
        result.mean.push_back({wx.node, wy.node, top, weight});
      }
    return result;
  }
  const double area = footprint.length * footprint.width, part = (x1 - x0) * (y1 - y0);
  for (const LineWeight& wy : integrate_line(rule, lattice.y, y0, y1))
    for (const LineWeight& wx : integrate_line(rule, lattice.x, x0, x1)) {
      result.force.push_back({wx.node, wy.node, top, wx.weight * wy.weight / area});
      result.mean.push_back({wx.node, wy.node, top, wx.weight * wy.weight / part});
    }
  return result;
}

std::vector<NodeWeight> compute_mean_weights(const Lattice& lattice, const Footprint& f, std::size_t number) {
  const double x[2] = {f.x - f.length / 2, f.x + f.length / 2}, y[2] = {f.y - f.width / 2, f.y + f.width / 2};
  // The ends and their images.
  const auto check = [&](const char* axis, const double(&ends)[2], bool folds, std::array<double, 2> range) {
    if (folds)
      check_range(axis, number, 0, std::max(std::abs(ends[0]), std::abs(ends[1])), range);
    else
      check_range(axis, number, ends[0], ends[1], range);
  };
  check("x", x, lattice.quarter_model, lattice.interior_x());
  check("y", y, lattice.half_model, lattice.interior_y());
  const GllRule rule(lattice.degree);
  const int top = lattice.nz() * lattice.degree;
  std::vector<NodeWeight> result;
  for (const LineWeight& wy : integrate_folded(rule, lattice.y, y[0], y[1], lattice.half_model))
    for (const LineWeight& wx : integrate_folded(rule, lattice.x, x[0], x[1], lattice.quarter_model))
      result.push_back({wx.node, wy.node, top, wx.weight * wy.weight / (f.length * f.width)});
  return result;
}

ReceiverWeights compute_receiver_weights(const Lattice& lattice, const Receiver& receiver) {
  auto [x, y, z] = receiver.position;
  ReceiverWeights result;
  if (lattice.half_model && y < 0) {
    y = -y;
    result.mirrored_y = true;
  }
  if (lattice.quarter_model && x < 0) {
    x = -x;
    result.mirrored_x = true;
  }
  const auto check = [&](const char* axis, double value, std::array<double, 2> range) {
    if (!(value >= range[0] - 1e-9 && value <= range[1] + 1e-9))
      throw ModelError(
          fmt::format("receiver \"{}\": {} = {} m, must be in {:.6g}..{:.6g} m, the undamped ground",
                      receiver.name, axis, value, range[0], range[1]));
  };
  check("x", x, lattice.interior_x());
  check("y", y, lattice.interior_y());
  check("z", z, lattice.interior_z());
  const GllRule rule(lattice.degree);
  for (const LineWeight& wz : interpolate_line(rule, lattice.z, z))
    for (const LineWeight& wy : interpolate_line(rule, lattice.y, y))
      for (const LineWeight& wx : interpolate_line(rule, lattice.x, x)) {
        const double weight = wx.weight * wy.weight * wz.weight;
        if (std::abs(weight) > 1e-14) result.nodes.push_back({wx.node, wy.node, wz.node, weight});
      }
  return result;
}

}  // namespace easydyn::soil

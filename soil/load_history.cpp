#include "soil/load_history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "easydyn/error.hpp"
#include "soil/site.hpp"

namespace easydyn::soil {

LoadHistory::LoadHistory(const SurfaceLoads& loads, double preload_time)
    : preload_time_(preload_time), time_(loads.time), force_(loads.force.transpose()) {
  const Eigen::Index nt = time_.size();
  if (nt < 2) throw ModelError(fmt::format("surface loads: {} times, at least 2 are needed", nt));
  if (loads.footprints.empty()) throw ModelError("surface loads: no footprints");
  if (loads.force.rows() != nt || loads.force.cols() != static_cast<Eigen::Index>(loads.footprints.size()))
    throw ModelError(fmt::format("surface loads: force is {} x {}, must be {} times x {} footprints",
                                 loads.force.rows(), loads.force.cols(), nt, loads.footprints.size()));
  if (!(preload_time >= 0)) throw ModelError(fmt::format("preload_time = {} s, must be >= 0", preload_time));
  step_ = (time_(nt - 1) - time_(0)) / static_cast<double>(nt - 1);
  if (!(step_ > 0)) throw ModelError("surface loads: the time must increase");
  for (Eigen::Index i = 0; i < nt; ++i)
    if (!(std::abs(time_(i) - time_(0) - static_cast<double>(i) * step_) < 1e-3 * step_))
      throw ModelError(fmt::format("surface loads: time({}) = {} s, the step must be uniform", i, time_(i)));
  if (!force_.allFinite()) throw ModelError("surface loads: a force is not finite");

  // Second derivatives c of the natural spline: c_{i-1} + 4 c_i + c_{i+1} = 6 (f_{i-1} - 2 f_i + f_{i+1}) /
  // h^2.
  curvature_ = Eigen::MatrixXd::Zero(force_.rows(), nt);
  Eigen::VectorXd factor = Eigen::VectorXd::Zero(nt);
  for (Eigen::Index i = 1; i + 1 < nt; ++i) {
    factor(i) = 1 / (4 - factor(i - 1));
    curvature_.col(i) =
        factor(i) * (6 / (step_ * step_) * (force_.col(i - 1) - 2 * force_.col(i) + force_.col(i + 1)) -
                     curvature_.col(i - 1));
  }
  for (Eigen::Index i = nt - 2; i >= 1; --i) curvature_.col(i) -= factor(i) * curvature_.col(i + 1);
}

void LoadHistory::update_forces(double t, Eigen::VectorXd& out) const {
  const Eigen::Index nt = time_.size();
  const double place = (t - time_(0)) / step_;
  if (place <= 0) {
    const double s =
        preload_time_ > 0 ? std::clamp(1 + (t - time_(0)) / preload_time_, 0.0, 1.0) : place == 0;
    out = s * s * s * (10 - 15 * s + 6 * s * s) * force_.col(0);
    return;
  }
  if (place >= static_cast<double>(nt - 1)) {
    out = force_.col(nt - 1);
    return;
  }
  const Eigen::Index i = static_cast<Eigen::Index>(place);
  const double b = place - static_cast<double>(i), a = 1 - b, h2 = step_ * step_ / 6;
  out = a * force_.col(i) + b * force_.col(i + 1) + (a * a * a - a) * h2 * curvature_.col(i) +
        (b * b * b - b) * h2 * curvature_.col(i + 1);
}

Eigen::VectorXd compute_taper(const std::vector<Footprint>& footprints, double taper_length) {
  Eigen::VectorXd taper = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(footprints.size()));
  if (!(taper_length >= 0))
    throw ModelError(fmt::format("site: taper_length = {} m, must be >= 0", taper_length));
  if (taper_length == 0) return taper;
  std::map<int, std::array<double, 2>> reach;  // of the centres of each source [m]
  for (const Footprint& footprint : footprints) {
    const auto [range, is_new] = reach.try_emplace(footprint.source, std::array{footprint.x, footprint.x});
    range->second = {std::min(range->second[0], footprint.x), std::max(range->second[1], footprint.x)};
  }
  for (const auto& [source, range] : reach) {
    const double length = range[1] - range[0];
    if (length >= 1e-9 && length < 2 * taper_length)
      throw ModelError(
          fmt::format("site: taper_length = {} m, must be in 0..{} m, half of the loaded track "
                      "(0: no taper; {} m unless [loads] says it)",
                      taper_length, length / 2, Site().taper_length));
  }
  for (Eigen::Index j = 0; j < taper.size(); ++j) {
    const Footprint& footprint = footprints[static_cast<std::size_t>(j)];
    const auto [first, last] = reach.at(footprint.source);
    const double distance = std::min(footprint.x - first, last - footprint.x);
    if (last - first >= 1e-9 && distance < taper_length)
      taper(j) = 0.5 - 0.5 * std::cos(M_PI * distance / taper_length);
  }
  return taper;
}

}  // namespace easydyn::soil

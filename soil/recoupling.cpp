#include "soil/recoupling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "easydyn/error.hpp"
#include "soil/frequency_filter.hpp"

namespace easydyn::soil {
namespace {

double compute_ratio(double difference, double reference) {
  return reference > 0 ? difference / reference
                       : (difference > 0 ? std::numeric_limits<double>::infinity() : 0);
}

RelativeDifference compare(const Eigen::MatrixXd& foundation, const Eigen::MatrixXd& soil) {
  const Eigen::MatrixXd difference = foundation - soil;
  return {.l2 = compute_ratio(difference.norm(), soil.norm()),
          .peak = compute_ratio(difference.lpNorm<Eigen::Infinity>(), soil.lpNorm<Eigen::Infinity>())};
}

void check_history(const char* name, const Eigen::VectorXd& time, const Eigen::MatrixXd& displacement,
                   Eigen::Index footprints) {
  if (time.size() < 4 || displacement.rows() != time.size() || displacement.cols() != footprints) {
    throw ModelError(fmt::format(
        "recoupling error: {} displacement is {} x {}, must be {} x {} (times, at least 4, by footprints)",
        name, displacement.rows(), displacement.cols(), time.size(), footprints));
  }
  if (!(time(time.size() - 1) > time(0)) || !displacement.allFinite()) {
    throw ModelError(
        fmt::format("recoupling error: {} displacement or its time is not finite or not in order", name));
  }
}

double uniform_step(const Eigen::VectorXd& time) {
  return (time(time.size() - 1) - time(0)) / static_cast<double>(time.size() - 1);
}

}  // namespace

Eigen::MatrixXd compute_slow_part(const Eigen::Ref<const Eigen::MatrixXd>& signals, double step,
                                  double frequency) {
  const auto response = [&](double f) -> std::complex<double> {
    const double part = f > 0 ? std::log2(f / frequency) + 0.5 : 0;  // 0 ... 1 across the octave
    return part <= 0 ? 1.0 : part >= 1 ? 0.0 : 0.5 * (1 + std::cos(std::numbers::pi * part));
  };
  Eigen::MatrixXd slow(signals.rows(), signals.cols());
  for (Eigen::Index j = 0; j < signals.cols(); ++j) {
    slow.col(j) = apply_filter(signals.col(j), step, response, RecordEnds::mirrored);
  }
  return slow;
}

Eigen::MatrixXd interpolate(const Eigen::VectorXd& time, const Eigen::Ref<const Eigen::MatrixXd>& signals,
                            const Eigen::VectorXd& at) {
  const Eigen::Index n = time.size();
  const double step = uniform_step(time);
  Eigen::MatrixXd values(at.size(), signals.cols());
  for (Eigen::Index i = 0; i < at.size(); ++i) {
    // Lagrange's cubic through the samples first ... first + 3, s = 0 ... 3 there.
    const double position = (at(i) - time(0)) / step;
    const auto first =
        std::clamp<Eigen::Index>(static_cast<Eigen::Index>(std::floor(position)) - 1, 0, n - 4);
    const double s = position - static_cast<double>(first);
    const Eigen::RowVector4d weights(-(s - 1) * (s - 2) * (s - 3) / 6, s * (s - 2) * (s - 3) / 2,
                                     -s * (s - 1) * (s - 3) / 2, s * (s - 1) * (s - 2) / 6);
    values.row(i) = weights * signals.middleRows<4>(first);
  }
  return values;
}

RecouplingError compute_recoupling_error(const Eigen::VectorXd& soil_time,
                                         const Eigen::MatrixXd& soil_displacement,
                                         const Eigen::VectorXd& track_time,
                                         const Eigen::MatrixXd& foundation_displacement,
                                         const Eigen::VectorXd& taper, double highest_frequency) {
  check_history("soil", soil_time, soil_displacement, taper.size());
  check_history("foundation", track_time, foundation_displacement, taper.size());

  // Footprints that bear their full load.
  std::vector<Eigen::Index> full;
  for (Eigen::Index j = 0; j < taper.size(); ++j) {
    if (taper(j) >= 1 - 1e-9) {
      full.push_back(j);
    }
  }
  if (full.empty()) {
    throw ModelError("recoupling error: no footprint bears its full load (taper = 1)");
  }

  // Common times: the samples of the soil that the track covers, too.
  const double step = uniform_step(soil_time);
  const double rounding = 1e-6 * step;
  std::vector<double> shared;
  for (const double t : soil_time) {
    if (t >= track_time(0) - rounding && t <= track_time(track_time.size() - 1) + rounding) {
      shared.push_back(t);
    }
  }
  if (shared.size() < 2) {
    throw ModelError(fmt::format("recoupling error: soil ({} to {} s) and track ({} to {} s) share no time",
                                 soil_time(0), soil_time(soil_time.size() - 1), track_time(0),
                                 track_time(track_time.size() - 1)));
  }
  const Eigen::VectorXd time =
      Eigen::Map<const Eigen::VectorXd>(shared.data(), static_cast<Eigen::Index>(shared.size()));

  const Eigen::MatrixXd soil = interpolate(soil_time, soil_displacement(Eigen::all, full), time);
  const Eigen::MatrixXd limited =
      limit_band(foundation_displacement(Eigen::all, full), uniform_step(track_time), highest_frequency);
  const Eigen::MatrixXd foundation = interpolate(track_time, limited, time);

  const Eigen::MatrixXd slow_soil = compute_slow_part(soil, step, recoupling_split_frequency);
  const Eigen::MatrixXd slow_foundation = compute_slow_part(foundation, step, recoupling_split_frequency);
  return {.total = compare(foundation, soil),
          .quasi_static = compare(slow_foundation, slow_soil),
          .dynamic = compare(foundation - slow_foundation, soil - slow_soil),
          .footprints = static_cast<int>(full.size()),
          .from = shared.front(),
          .to = shared.back()};
}

}  // namespace easydyn::soil

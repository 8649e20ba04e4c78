#include "soil/time_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "easydyn/error.hpp"

namespace easydyn::soil {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;

constexpr double full_band = 1.25, whole_band = 1.6;  // x highest_frequency: correction whole, none
constexpr Index block = 64;                           // frequencies at a time

/// The signals without a smooth line from their first to their last value, which knows no time error, continued by `more`
/// rows on both sides as mirrored about the end with the sign changed (value and slope go on), fading out.
Eigen::MatrixXd continue_signals(const Eigen::Ref<const Eigen::MatrixXd>& signals, Index more) {
  const Index n = signals.rows();
  const Eigen::ArrayXd place = Eigen::ArrayXd::LinSpaced(n, 0, 1);
  const Eigen::VectorXd rise = place.cube() * (10 - 15 * place + 6 * place.square());
  Eigen::MatrixXd result(n + 2 * more, signals.cols());
  result.middleRows(more, n) =
      signals - Eigen::VectorXd::Ones(n) * signals.row(0) - rise * (signals.row(n - 1) - signals.row(0));
  for (Index i = 1; i <= more; ++i) {
    const double fade =
        -0.5 - 0.5 * std::cos(std::numbers::pi * static_cast<double>(i) / static_cast<double>(more + 1));
    result.row(more - i) = fade * result.row(more + i);
    result.row(more + n - 1 + i) = fade * result.row(more + n - 1 - i);
  }
  return result;
}

void check_steps(Index rows, double step, double dt, double highest_frequency) {
  if (!(rows > 1 && step > 0 && dt > 0 && highest_frequency > 0))
    throw ModelError(fmt::format(
        "time error: {} rows, steps of {} s and {} s, highest frequency = {} Hz, must be > 1 row, > 0", rows,
        step, dt, highest_frequency));
}

/// Rows by which signals are continued: twenty periods of the highest frequency, or their own length.
Index count_more(const Eigen::Ref<const Eigen::MatrixXd>& signals, double step, double highest_frequency) {
  return std::min(signals.rows() - 1, static_cast<Index>(std::ceil(20 / (highest_frequency * step))));
}

/// Frequencies 1 / L, 2 / L ... of a record of length T < L, what the leapfrog makes of them, and their weights.
struct Frequencies {
  Eigen::VectorXd exact, leapfrog, weight;  // W, w [rad/s], 2 / L x share of the correction

  Frequencies(double length, double step, double dt, double highest_frequency) {
    const double end = std::min(
        {2 * std::numbers::pi * whole_band * highest_frequency, 0.9 * std::numbers::pi / step, 1.8 / dt});
    // Nothing wraps around: at the end of the band a signal arrives earlier by dw/dW.
    const double period = 1.25 * length / std::sqrt(1 - std::pow(end * dt / 2, 2)) + 4 / highest_frequency;
    const auto count = static_cast<Index>(end * period / (2 * std::numbers::pi));
    exact = 2 * std::numbers::pi / period * Eigen::ArrayXd::LinSpaced(count, 1, static_cast<double>(count));
    leapfrog = 2 / dt * (exact.array() * dt / 2).asin();
    const double begin = end * full_band / whole_band;
    weight = exact.unaryExpr([&](double W) {
      const double place = std::clamp((W - begin) / (end - begin), 0.0, 1.0);
      return (1 + std::cos(std::numbers::pi * place)) / period;
    });
  }
};

/// e^(-i w_k t_n), one row per frequency.
Eigen::MatrixXcd make_waves(const Eigen::Ref<const Eigen::VectorXd>& w, const Eigen::VectorXd& time) {
  return (w * time.transpose()).unaryExpr([](double phase) { return std::polar(1.0, -phase); });
}

Eigen::VectorXd make_times(double start, double step, Index count) {
  return Eigen::VectorXd::LinSpaced(count, start, start + step * static_cast<double>(count - 1));
}

}  // namespace

Eigen::MatrixXd add_time_error(const Eigen::Ref<const Eigen::MatrixXd>& signals, double step, double dt,
                               double highest_frequency) {
  check_steps(signals.rows(), step, dt, highest_frequency);
  const Index n = signals.rows(), more = count_more(signals, step, highest_frequency);
  const Eigen::VectorXd time = make_times(-step * static_cast<double>(more), step, n + 2 * more);
  const Frequencies frequencies(time(time.size() - 1) - time(0), step, dt, highest_frequency);
  const Eigen::MatrixXcd continued = (step * continue_signals(signals, more)).cast<Complex>();
  Eigen::MatrixXd result = signals;
  for (Index first = 0; first < frequencies.exact.size(); first += block) {
    const Index count = std::min(block, frequencies.exact.size() - first);
    const Eigen::ArrayXd W = frequencies.exact.segment(first, count);
    const Eigen::MatrixXcd exact = make_waves(W, time);
    Eigen::MatrixXcd change = make_waves(frequencies.leapfrog.segment(first, count), time.segment(more, n));
    change = (1 / (1 - (W * dt / 2).square()).sqrt()).matrix().cast<Complex>().asDiagonal() * change -
             exact.middleCols(more, n);
    const Eigen::MatrixXcd spectrum =
        frequencies.weight.segment(first, count).cast<Complex>().asDiagonal() * (exact * continued);
    result += (change.adjoint() * spectrum).real();
  }
  return result;
}

Eigen::MatrixXd remove_time_error(const Eigen::Ref<const Eigen::MatrixXd>& records, double start, double step,
                                  double dt, double highest_frequency, LeapfrogRecord kind) {
  check_steps(records.rows(), step, dt, highest_frequency);
  const Index n = records.rows(), more = count_more(records, step, highest_frequency);
  const Eigen::VectorXd time = make_times(start - step * static_cast<double>(more), step, n + 2 * more);
  const Frequencies frequencies(std::max(time(time.size() - 1), 0.0) - std::min(time(0), 0.0), step, dt,
                                highest_frequency);
  const Eigen::MatrixXcd continued = (step * continue_signals(records, more)).cast<Complex>();
  Eigen::MatrixXd result = records;
  for (Index first = 0; first < frequencies.exact.size(); first += block) {
    const Index count = std::min(block, frequencies.exact.size() - first);
    const Eigen::ArrayXd w = frequencies.leapfrog.segment(first, count);
    const Eigen::MatrixXcd exact = make_waves(frequencies.exact.segment(first, count), time);
    Eigen::MatrixXcd change = make_waves(w, time);
    if (kind == LeapfrogRecord::velocity)
      change = (1 / (w * dt / 2).cos()).matrix().cast<Complex>().asDiagonal() * change;
    change -= exact;
    const Eigen::MatrixXcd spectrum =
        frequencies.weight.segment(first, count).cast<Complex>().asDiagonal() * (change * continued);
    result += (exact.middleCols(more, n).adjoint() * spectrum).real();
  }
  return result;
}

}  // namespace easydyn::soil

#include "soil/layered/mobility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <unsupported/Eigen/FFT>

#include "easydyn/error.hpp"
#include "easydyn/require.hpp"
#include "soil/frequency_filter.hpp"
#include "soil/layered/footprint_response.hpp"
#include "soil/layered/parallel_loop.hpp"

namespace easydyn::soil {
namespace {

using Eigen::Index;
constexpr double pi = std::numbers::pi;
constexpr double fold_back = 1e-3;  // what is left of motion after the window
constexpr double band_end = 1.75;   // over the highest frequency
constexpr double periods_before =
    16;  // of the highest frequency before t = 0: the band limit has no sharp start

double round_distance(double distance) {
  return std::round(std::abs(distance) * 1e6) / 1e6;
}

// 1 to the end of the loads' roll-off, then down to 0 as an error function: short in time.
double compute_band(double relative_frequency) {
  const double part = (relative_frequency - roll_off) / (band_end - roll_off);
  return part <= 0 ? 1 : part >= 1 ? 0 : 0.5 * std::erfc(3 * (2 * part - 1));
}

// Real signals from the lower half of their spectra, sampled at f_i = i / window; times e^(eta t), from -before.
Eigen::MatrixXd transform_to_time(const Eigen::MatrixXcd& spectra, Index samples, Index before, double step,
                                  double eta, int threads) {
  Eigen::MatrixXd signals(samples, spectra.cols());
  Eigen::VectorXd growth(samples);
  for (Index i = 0; i < samples; ++i)
    growth(i) = std::exp(eta * step * static_cast<double>(i - before)) / step;
  for_each_chunk(spectra.cols(), threads, [&](Index begin, Index end) {
    Eigen::FFT<double> transform;
    transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
    Eigen::VectorXcd padded = Eigen::VectorXcd::Zero(samples / 2 + 1);
    Eigen::VectorXd signal(samples);
    for (Index c = begin; c < end; ++c) {
      padded.head(spectra.rows()) = spectra.col(c);
      padded(0) = padded(0).real();
      transform.inv(signal.data(), padded.data(), static_cast<int>(samples));
      signals.col(c).head(before) = growth.head(before).cwiseProduct(signal.tail(before));
      signals.col(c).tail(samples - before) =
          growth.tail(samples - before).cwiseProduct(signal.head(samples - before));
    }
  });
  return signals;
}

}  // namespace

Mobility list_distances(const std::vector<Footprint>& footprints, const std::vector<Receiver>& receivers) {
  if (footprints.empty()) throw ModelError("superposition: no footprint");
  const Footprint& first = footprints.front();
  Mobility mobility;
  mobility.length = first.length;
  mobility.width = first.width;
  std::set<std::array<double, 3>> places;
  std::set<std::array<double, 2>> shifts;
  for (std::size_t j = 0; j < footprints.size(); ++j) {
    const Footprint& f = footprints[j];
    if (std::abs(f.length - first.length) > 1e-6 || std::abs(f.width - first.width) > 1e-6) {
      throw ModelError(
          fmt::format("superposition: footprint {} is {} m x {} m, must be {} m x {} m like the first", j + 1,
                      f.length, f.width, first.length, first.width));
    }
    if (f.direction != LoadDirection::down) {
      throw ModelError(
          fmt::format("superposition: footprint {} is loaded horizontally, must be vertically", j + 1));
    }
    for (const Receiver& r : receivers) {
      places.insert(
          {round_distance(r.position[0] - f.x), round_distance(r.position[1] - f.y), r.position[2]});
    }
    for (const Footprint& g : footprints)
      shifts.insert({round_distance(g.x - f.x), round_distance(g.y - f.y)});
  }
  mobility.places.assign(places.begin(), places.end());
  mobility.shifts.assign(shifts.begin(), shifts.end());
  return mobility;
}

double estimate_window(const LayeredGround& ground, const Mobility& distances) {
  double farthest = 0;
  for (const auto& p : distances.places) farthest = std::max(farthest, std::hypot(p[0], p[1], p[2]));
  for (const auto& s : distances.shifts) farthest = std::max(farthest, std::hypot(s[0], s[1]));
  // Rayleigh waves, c_R > 0.86 c_S, slower by dispersion; then echoes of the layers.
  return 1.5 * farthest / (0.8 * ground.slowest_cs()) + 1;
}

void update_mobility(const LayeredGround& ground, double highest_frequency, Mobility& mobility, double window,
                     int threads) {
  require_positive("mobility", "highest frequency", highest_frequency, "Hz");
  require_not_negative("mobility", "window", window, "s");
  if (window == 0) window = estimate_window(ground, mobility);
  mobility.highest_frequency = highest_frequency;
  mobility.step = 1 / (4 * highest_frequency);
  mobility.before = static_cast<int>(periods_before / highest_frequency / mobility.step);
  const Index samples =
      compute_fast_length(mobility.before + static_cast<Index>(std::ceil(window / mobility.step)));
  window = static_cast<double>(samples) * mobility.step;
  const double eta = -std::log(fold_back) / window;
  const Index count = static_cast<Index>(std::ceil(band_end * highest_frequency * window));
  Eigen::VectorXcd w(count);
  for (Index i = 0; i < count; ++i) w(i) = {2 * pi * static_cast<double>(i) / window, -eta};

  FootprintRequest request;
  request.length = mobility.length;
  request.width = mobility.width;
  request.points = mobility.places;
  request.threads = threads;
  for (const auto& shift : mobility.shifts) {
    request.means.push_back({shift[0], shift[1], mobility.length, mobility.width});
  }
  FootprintResponse response = compute_footprint_response(ground, request, w);
  for (Eigen::MatrixXcd* spectra : {&response.ux, &response.uy, &response.uz, &response.mean}) {
    for (Index i = 0; i < count; ++i) {
      spectra->row(i) *= compute_band(static_cast<double>(i) / window / highest_frequency);
    }
  }
  const auto to_time = [&](const Eigen::MatrixXcd& spectra) {
    return transform_to_time(spectra, samples, mobility.before, mobility.step, eta, count_threads(threads));
  };
  mobility.hx = to_time(response.ux);
  mobility.hy = to_time(response.uy);
  mobility.hz = to_time(response.uz);
  mobility.mean = to_time(response.mean);
}

}  // namespace easydyn::soil

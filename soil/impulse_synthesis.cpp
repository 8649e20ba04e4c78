#include "soil/impulse_synthesis.hpp"

#include <cmath>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "soil/frequency_filter.hpp"
#include "soil/parallel_loop.hpp"

namespace easydyn::soil {
namespace {

using Eigen::Index;
constexpr double pi = std::numbers::pi;
constexpr double fold_back = 1e-3;     // what is left of motion after the window
constexpr double band_end = 1.75;      // over the highest frequency
constexpr double periods_before = 16;  // of the highest frequency before t = 0

double compute_band(double relative_frequency) {
  const double part = (relative_frequency - roll_off) / (band_end - roll_off);
  return part <= 0 ? 1 : part >= 1 ? 0 : 0.5 * std::erfc(3 * (2 * part - 1));
}

}  // namespace

ImpulseSynthesis::ImpulseSynthesis(double highest_frequency, double window, int threads)
    : highest_frequency_(highest_frequency),
      step_(1 / (4 * highest_frequency)),
      threads_(count_threads(threads)) {
  before_ = static_cast<Index>(periods_before / highest_frequency / step_);
  samples_ = compute_fast_length(before_ + static_cast<Index>(std::ceil(window / step_ - 1e-6)));
  period_ = static_cast<double>(samples_) * step_;
  eta_ = -std::log(fold_back) / period_;
  w_.resize(static_cast<Index>(std::ceil(band_end * highest_frequency * period_)));
  for (Index i = 0; i < w_.size(); ++i) w_(i) = {2 * pi * static_cast<double>(i) / period_, -eta_};
}

double ImpulseSynthesis::window() const {
  return step_ * static_cast<double>(samples_ - before_);
}

void ImpulseSynthesis::update(Mobility& mobility, const Eigen::MatrixXcd& ux, const Eigen::MatrixXcd& uy,
                              const Eigen::MatrixXcd& uz, const Eigen::MatrixXcd& mean) const {
  mobility.highest_frequency = highest_frequency_;
  mobility.step = step_;
  mobility.before = static_cast<int>(before_);
  mobility.hx = transform(ux);
  mobility.hy = transform(uy);
  mobility.hz = transform(uz);
  mobility.mean = transform(mean);
}

// Real signals from the lower half of their spectra, from t = -before on.
Eigen::MatrixXd ImpulseSynthesis::transform(const Eigen::MatrixXcd& spectra) const {
  Eigen::VectorXd band(w_.size()), growth(samples_);
  for (Index i = 0; i < w_.size(); ++i)
    band(i) = compute_band(static_cast<double>(i) / period_ / highest_frequency_);
  for (Index i = 0; i < samples_; ++i)
    growth(i) = std::exp(eta_ * step_ * static_cast<double>(i - before_)) / step_;
  Eigen::MatrixXd signals(samples_, spectra.cols());
  for_each_chunk(spectra.cols(), threads_, [&](Index begin, Index end) {
    Eigen::FFT<double> fft;
    fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
    Eigen::VectorXcd padded = Eigen::VectorXcd::Zero(samples_ / 2 + 1);
    Eigen::VectorXd signal(samples_);
    const Index after = samples_ - before_;
    for (Index c = begin; c < end; ++c) {
      padded.head(spectra.rows()) = band.cwiseProduct(spectra.col(c));
      padded(0) = padded(0).real();
      fft.inv(signal.data(), padded.data(), static_cast<int>(samples_));
      signals.col(c).head(before_) = growth.head(before_).cwiseProduct(signal.tail(before_));
      signals.col(c).tail(after) = growth.tail(after).cwiseProduct(signal.head(after));
    }
  });
  return signals;
}

}  // namespace easydyn::soil

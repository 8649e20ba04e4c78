#include "soil/frequency_filter.hpp"

#include <cassert>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace easydyn::soil {
namespace {

Eigen::FFT<double> make_transform() {
  Eigen::FFT<double> transform;
  transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  return transform;
}

}  // namespace

Eigen::Index compute_fast_length(Eigen::Index n) {
  for (Eigen::Index length = std::max<Eigen::Index>(n + n % 2, 2);; length += 2) {
    Eigen::Index rest = length;
    for (const Eigen::Index prime : {2, 3, 5}) {
      while (rest % prime == 0) {
        rest /= prime;
      }
    }
    if (rest == 1) {
      return length;
    }
  }
}

Eigen::VectorXcd compute_spectrum(const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Index length) {
  assert(length >= x.size() && length % 2 == 0);
  Eigen::VectorXd padded = Eigen::VectorXd::Zero(length);
  padded.head(x.size()) = x;
  Eigen::VectorXcd spectrum(length / 2 + 1);
  make_transform().fwd(spectrum.data(), padded.data(), static_cast<int>(length));
  return spectrum;
}

Eigen::VectorXd apply_filter(const Eigen::Ref<const Eigen::VectorXd>& signal, double step,
                             const std::function<std::complex<double>(double f)>& response, RecordEnds ends,
                             double settling) {
  assert(step > 0);
  const Eigen::Index n = signal.size();
  if (n == 0) {
    return signal;
  }
  // Continue the record beyond its time.
  Eigen::VectorXd padded;
  if (ends == RecordEnds::zero) {
    const auto extra = static_cast<Eigen::Index>(std::ceil(settling / step));
    padded = Eigen::VectorXd::Zero(compute_fast_length(n + extra));
    padded.head(n) = signal;
  } else {
    const Eigen::Index half = compute_fast_length(n);
    padded.resize(2 * half);
    padded.head(n) = signal;
    padded.segment(n, half - n).setConstant(signal(n - 1));
    padded.tail(half) = padded.head(half).reverse();
  }

  // Multiply by the response; frequency 0 and the highest one are real.
  const Eigen::Index length = padded.size();
  Eigen::VectorXcd spectrum = compute_spectrum(padded, length);
  for (Eigen::Index k = 0; k < spectrum.size(); ++k) {
    spectrum(k) *= response(static_cast<double>(k) / (static_cast<double>(length) * step));
  }
  spectrum(0) = spectrum(0).real();
  spectrum(length / 2) = spectrum(length / 2).real();
  make_transform().inv(padded.data(), spectrum.data(), static_cast<int>(length));
  return padded.head(n);
}

Eigen::MatrixXd limit_band(const Eigen::Ref<const Eigen::MatrixXd>& signals, double step,
                           double highest_frequency) {
  const auto response = [&](double f) -> std::complex<double> {
    const double part = (f / highest_frequency - 1) / (roll_off - 1);  // 0 ... 1 in the roll-off
    return part <= 0 ? 1.0 : part >= 1 ? 0.0 : 0.5 * (1 + std::cos(std::numbers::pi * part));
  };
  Eigen::MatrixXd limited(signals.rows(), signals.cols());
  for (Eigen::Index j = 0; j < signals.cols(); ++j) {
    limited.col(j) = apply_filter(signals.col(j), step, response, RecordEnds::mirrored);
  }
  return limited;
}

}  // namespace easydyn::soil

#pragma once

#include <Eigen/Core>
#include <complex>
#include <functional>

namespace easydyn::soil {

/// What a record is taken to be outside its time.
enum class RecordEnds {
  zero,     ///< at rest before and after: a vibration
  mirrored  ///< reflected in time at both ends: a load or displacement that starts or ends away from zero
};

/// Smallest even number >= n that has no prime factor but 2, 3 and 5: lengths that transform fast.
Eigen::Index compute_fast_length(Eigen::Index n);

/// Spectrum X_k = sum_n x_n exp(-2 pi i k n / N), k = 0 ... N / 2, of x continued by zeros to N = `length`.
Eigen::VectorXcd compute_spectrum(const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Index length);

/// A filter given by its frequency response H(f), f >= 0 [Hz], applied in the frequency domain: the analogue
/// response exactly, at any time step.
/// @param step     of the signal [s], > 0
/// @param settling [s] in which the filter's own response dies out (ends `zero` only; the record is continued
///                 by so much, so that nothing wraps around)
Eigen::VectorXd apply_filter(const Eigen::Ref<const Eigen::VectorXd>& signal, double step,
                             const std::function<std::complex<double>(double f)>& response, RecordEnds ends,
                             double settling = 0);

/// Where limit_band() has nothing left, over the highest frequency.
inline constexpr double roll_off = 1.25;

/// Zero-phase low-pass of every column (`mirrored` ends): 1 up to `highest_frequency`, then half a cosine
/// down to 0 at `roll_off` times that, so that all that is claimed passes unchanged.
Eigen::MatrixXd limit_band(const Eigen::Ref<const Eigen::MatrixXd>& signals, double step,
                           double highest_frequency);

}  // namespace easydyn::soil

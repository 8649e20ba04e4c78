#include "soil/kb_value.hpp"

#include <cassert>
#include <cmath>
#include <numbers>

#include "soil/frequency_filter.hpp"

namespace easydyn::soil {

std::complex<double> kb_filter_response(double f) {
  constexpr double f_weighting = 5.6, f_low = 0.8, f_high = 100;  // [Hz]
  if (f == 0) {
    return 0;
  }
  const auto butterworth_low_pass = [](std::complex<double> s) {
    return 1.0 / (1.0 + std::numbers::sqrt2 * s + s * s);
  };
  const std::complex<double> i(0, 1);
  // The high-pass is the low-pass of the reciprocal frequency.
  return 1.0 / (1.0 + f_weighting / (i * f)) * butterworth_low_pass(f_low / (i * f)) *
         butterworth_low_pass(i * f / f_high);
}

Eigen::VectorXd compute_running_rms(const Eigen::Ref<const Eigen::VectorXd>& x, double step, double tau) {
  assert(step > 0 && tau > 0);
  // Exact for x^2 linear between samples: y_1 = e y_0 + w_0 x_0^2 + w_1 x_1^2.
  const double r = step / tau, e = std::exp(-r);
  const double w1 = 1 - (1 - e) / r, w0 = (1 - e) / r - e;
  Eigen::VectorXd rms(x.size());
  double mean_square = 0;
  for (Eigen::Index n = 0; n < x.size(); ++n) {
    if (n > 0) {
      mean_square = e * mean_square + w0 * x(n - 1) * x(n - 1) + w1 * x(n) * x(n);
    }
    rms(n) = std::sqrt(mean_square);
  }
  return rms;
}

Eigen::VectorXd compute_kb_f(const Eigen::Ref<const Eigen::VectorXd>& velocity, double step) {
  constexpr double reference_velocity = 1e-3;  // [m/s]
  constexpr double settling = 5;               // [s]: the slowest pole of the filter is at 0.8 Hz
  constexpr double tau = 0.125;                // [s]
  const Eigen::VectorXd kb =
      apply_filter(velocity / reference_velocity, step, kb_filter_response, RecordEnds::zero, settling);
  return compute_running_rms(kb, step, tau);
}

}  // namespace easydyn::soil

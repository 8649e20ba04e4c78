#include "soil/third_octave.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "soil/frequency_filter.hpp"

namespace easydyn::soil {

Eigen::VectorXd third_octave_centres() {
  Eigen::VectorXd centres(21);
  for (Eigen::Index i = 0; i < centres.size(); ++i) {
    centres(i) = std::pow(10.0, 0.1 * static_cast<double>(i));
  }
  return centres;
}

Eigen::VectorXd compute_third_octave_rms(const Eigen::Ref<const Eigen::VectorXd>& signal, double step,
                                         double highest_frequency) {
  assert(signal.size() > 0 && step > 0);
  const Eigen::Index length = compute_fast_length(signal.size());
  const Eigen::VectorXcd spectrum = compute_spectrum(signal, length);
  const double line_width = 1 / (static_cast<double>(length) * step);
  const double limit = std::min(highest_frequency, 0.5 / step) * (1 + 1e-9);  // an edge on the limit counts

  const Eigen::VectorXd centres = third_octave_centres();
  Eigen::VectorXd rms(centres.size());
  for (Eigen::Index b = 0; b < centres.size(); ++b) {
    const double low = centres(b) * std::pow(10.0, -0.05), high = centres(b) * std::pow(10.0, 0.05);
    if (high > limit) {
      rms(b) = std::numeric_limits<double>::quiet_NaN();
      continue;
    }
    // Sum of squares by Parseval: 2 / N |X_k|^2 of each line, as far as it lies in the band.
    double energy = 0;
    const auto first = std::max<Eigen::Index>(1, std::lround(low / line_width));
    const auto last = std::min<Eigen::Index>(length / 2 - 1, std::lround(high / line_width));
    for (Eigen::Index k = first; k <= last; ++k) {
      const double left = std::max(low, (static_cast<double>(k) - 0.5) * line_width);
      const double right = std::min(high, (static_cast<double>(k) + 0.5) * line_width);
      energy +=
          2 * std::norm(spectrum(k)) / static_cast<double>(length) * std::max(0.0, right - left) / line_width;
    }
    rms(b) = std::sqrt(energy / static_cast<double>(signal.size()));
  }
  return rms;
}

}  // namespace easydyn::soil

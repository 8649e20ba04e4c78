#include "soil/indicators.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "soil/kb_value.hpp"
#include "soil/third_octave.hpp"

namespace easydyn::soil {
namespace {

// Maximum of the parabola through the largest value and its neighbours.
double interpolate_maximum(const Eigen::Ref<const Eigen::VectorXd>& values) {
  Eigen::Index n = 0;
  const double largest = values.maxCoeff(&n);
  if (n == 0 || n == values.size() - 1) {
    return largest;
  }
  const double slope = 0.5 * (values(n + 1) - values(n - 1));
  const double curvature = values(n + 1) - 2 * largest + values(n - 1);
  return curvature < 0 ? largest - 0.5 * slope * slope / curvature : largest;
}

}  // namespace

double compute_peak(const Eigen::Ref<const Eigen::VectorXd>& signal) {
  return signal.size() == 0 ? 0 : std::max({0.0, interpolate_maximum(signal), interpolate_maximum(-signal)});
}

double compute_resultant_peak(const Eigen::Ref<const Eigen::VectorXd>& x,
                              const Eigen::Ref<const Eigen::VectorXd>& y,
                              const Eigen::Ref<const Eigen::VectorXd>& z) {
  const Eigen::VectorXd square = x.array().square() + y.array().square() + z.array().square();
  return square.size() == 0 ? 0 : std::sqrt(interpolate_maximum(square));
}

double compute_vdb(const Eigen::Ref<const Eigen::VectorXd>& velocity, double step) {
  assert(step > 0);
  constexpr double window = 1;           // [s]
  constexpr double reference = 2.54e-8;  // [m/s] = 1e-6 in/s
  const auto samples = std::max<Eigen::Index>(1, std::lround(window / step));

  // Sum of squares over each window, from running sums.
  Eigen::VectorXd sum(velocity.size() + 1);
  sum(0) = 0;
  for (Eigen::Index n = 0; n < velocity.size(); ++n) {
    sum(n + 1) = sum(n) + velocity(n) * velocity(n);
  }
  double largest = 0;
  for (Eigen::Index end = 1; end < sum.size(); ++end) {
    largest = std::max(largest, sum(end) - sum(std::max<Eigen::Index>(0, end - samples)));
  }
  const double rms = std::sqrt(largest / static_cast<double>(samples));
  return rms > 0 ? 20 * std::log10(rms / reference) : std::numeric_limits<double>::quiet_NaN();
}

Indicators compute_indicators(const Eigen::Ref<const Eigen::VectorXd>& vx,
                              const Eigen::Ref<const Eigen::VectorXd>& vy,
                              const Eigen::Ref<const Eigen::VectorXd>& vz, double step,
                              double highest_frequency) {
  Indicators indicators;
  indicators.ppv = {compute_peak(vx), compute_peak(vy), compute_peak(vz), compute_resultant_peak(vx, vy, vz)};
  indicators.third_octave_rms = compute_third_octave_rms(vz, step, highest_frequency);
  indicators.kb_f_max = compute_kb_f(vz, step).maxCoeff();
  indicators.vdb = compute_vdb(vz, step);
  return indicators;
}

}  // namespace easydyn::soil

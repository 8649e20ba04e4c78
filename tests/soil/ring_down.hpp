#pragma once

#include <cmath>
#include <vector>

namespace easydyn::soil::test {

struct RingDown {
  double frequency = 0;  ///< [Hz], damped
  double ratio = 0;      ///< damping ratio, from the logarithmic decrement
};

/// Free vibration of one degree of freedom, sampled every `dt`, over `periods` periods from the first maximum
/// after `start`. A swing is a maximum minus the mean of the minima beside it, so that a constant or a drift
/// does not matter; its extremes come from the parabola through three samples.
inline RingDown measure_ring_down(const std::vector<double>& q, double dt, double start, int periods) {
  std::vector<double> time, value;
  for (std::size_t i = static_cast<std::size_t>(start / dt) + 1; i + 1 < q.size(); ++i) {
    const double slope = (q[i + 1] - q[i - 1]) / 2, curvature = q[i + 1] - 2 * q[i] + q[i - 1];
    if ((q[i] - q[i - 1]) * (q[i + 1] - q[i]) > 0) continue;
    if (time.empty() && curvature > 0) continue;  // begin with a maximum
    time.push_back((static_cast<double>(i) - slope / curvature) * dt);
    value.push_back(q[i] - slope * slope / (2 * curvature));
  }
  const std::size_t last = 2 * static_cast<std::size_t>(periods) + 2;
  if (value.size() < last + 2) return {};
  const auto swing = [&](std::size_t i) { return value[i] - (value[i - 1] + value[i + 1]) / 2; };
  const double decrement = std::log(swing(2) / swing(last)) / periods;
  return {periods / (time[last] - time[2]), decrement / std::hypot(2 * M_PI, decrement)};
}

}  // namespace easydyn::soil::test

#include "soil/band_split.hpp"

#include <cmath>

#include "soil/frequency_filter.hpp"

namespace easydyn::soil {

std::pair<SurfaceLoads, SurfaceLoads> split_band(const SurfaceLoads& loads, double crossover) {
  const Eigen::Index nt = loads.time.size();
  const double step = (loads.time(nt - 1) - loads.time(0)) / static_cast<double>(nt - 1);
  const auto lead = static_cast<Eigen::Index>(std::ceil(3 / crossover / step));
  SurfaceLoads low = loads;
  low.time = loads.time(0) + step * Eigen::VectorXd::LinSpaced(nt + lead, -static_cast<double>(lead),
                                                               static_cast<double>(nt - 1))
                                        .array();
  low.force.resize(nt + lead, loads.force.cols());
  low.force.topRows(lead).rowwise() = loads.force.row(0);
  low.force.bottomRows(nt) = loads.force;
  SurfaceLoads high = low;
  // Half a cosine over the logarithm of the frequency.
  const auto response = [&](double f) -> std::complex<double> {
    const double place = f > 0 ? std::log(f / crossover) / std::log(crossover_width) : -1;
    return place <= -1 ? 1.0 : place >= 1 ? 0.0 : 0.5 * (1 - std::sin(M_PI / 2 * place));
  };
  for (Eigen::Index j = 0; j < low.force.cols(); ++j)
    low.force.col(j) = apply_filter(high.force.col(j), step, response, RecordEnds::mirrored);
  high.force -= low.force;
  return {low, high};
}

}  // namespace easydyn::soil

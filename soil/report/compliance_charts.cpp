#include "soil/report/compliance_charts.hpp"

#include <cmath>
#include <numbers>

namespace easydyn::soil {
namespace {

// [degrees], continuous from the first value on.
Eigen::VectorXd compute_phase(const Eigen::VectorXcd& H) {
  Eigen::VectorXd phase(H.size());
  double turns = 0;
  for (Eigen::Index i = 0; i < H.size(); ++i) {
    phase[i] = std::arg(H[i]) * 180 / std::numbers::pi + 360 * turns;
    if (i > 0 && std::abs(phase[i] - phase[i - 1]) > 180) {
      const double step = phase[i] > phase[i - 1] ? -1 : 1;
      turns += step;
      phase[i] += 360 * step;
    }
  }
  return phase;
}

}  // namespace

std::vector<visu::Chart> draw_compliances(const ComplianceFit& fit) {
  const std::string colours[] = {"#4477aa", "#ee6677"};
  visu::Chart magnitude{.title = "Compliance of the ground and its foundation",
                        .x = {"frequency", "Hz"},
                        .y = {"|H|", "m/GN", visu::Scale::linear, 0},
                        .series = {},
                        .caption = "Displacement per harmonic force on one footprint."};
  visu::Chart phase{.title = "Phase of the displacement against the force",
                    .x = {"frequency", "Hz"},
                    .y = {"phase", "degrees"},
                    .series = {},
                    .caption = "Negative: the displacement lags behind the force."};
  const auto add = [&](const std::string& name, const Eigen::VectorXcd& H, visu::Stroke stroke,
                       const std::string& colour) {
    magnitude.series.push_back({name, fit.frequency, 1e9 * H.cwiseAbs(), stroke, colour});
    phase.series.push_back({name, fit.frequency, compute_phase(H), stroke, colour});
  };
  add("ground, loaded footprint", fit.ground_00, visu::Stroke::line, colours[0]);
  add("foundation, loaded", fit.model_00, visu::Stroke::dashed, colours[0]);
  add("ground, next footprint", fit.ground_01, visu::Stroke::line, colours[1]);
  add("foundation, next", fit.model_01, visu::Stroke::dashed, colours[1]);
  return {magnitude, phase};
}

}  // namespace easydyn::soil

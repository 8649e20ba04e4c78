#include "track/receptance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

#include "easydyn/sim/implicit_stepper.hpp"
#include "track/flexible_track.hpp"

namespace {

using namespace easydyn;
using namespace easydyn::track;
const double pi = std::acos(-1.0);

/// A short pulse on the rail, above no sleeper.
class StruckTrack : public System {
 public:
  static constexpr double x = 30.25, duration = 4e-4;
  StruckTrack() : track(*this, TrackModel(thalys_like_track(), 100)) {}
  FlexibleTrack track;
  static double force(double t) { return t < duration ? 1e4 * std::pow(std::sin(pi * t / duration), 2) : 0; }

 protected:
  void positions() override {}
  void forces() override { track.touch_rail(x).add_force(force(time().value())); }
};

// The trapezoidal rule (Newmark) turns s into (2 / h) (z - 1) / (z + 1): the spectrum of its motion after a pulse is
// the receptance at w~ = (2 / h) tan(w h / 2) exactly, once the motion has died away. That error of the integrator is
// of second order in h.
TEST(Receptance, IsTheSpectrumOfATimeDomainRunUpToTheIntegratorsFrequencyShift) {
  StruckTrack system;
  const TrackModel& model = system.track.model();
  const int j = 55;
  const RailPoint far = model.rail_point(33.1);
  const std::vector<double> frequencies = {10, 60, 180, 450};
  const auto n = static_cast<Eigen::Index>(frequencies.size());
  const double h = 1e-4;
  Newmark newmark(system, {.step = h});
  Eigen::VectorXcd F = Eigen::VectorXcd::Zero(n), rail = F, sleeper = F;
  for (int i = 0; i <= 12000; ++i) {
    if (i > 0) newmark.step();
    const State& s = newmark.state();
    for (Eigen::Index k = 0; k < n; ++k) {
      const std::complex<double> wave = std::polar(h, -2 * pi * frequencies[static_cast<size_t>(k)] * s.t);
      F[k] += wave * StruckTrack::force(s.t);
      rail[k] += wave * far.deflection(s.q);
      sleeper[k] += wave * s.q[model.sleeper_dof(j)];
    }
  }
  std::vector<double> shifted;
  for (const double f : frequencies) shifted.push_back(std::tan(pi * f * h) / (pi * h));
  const auto transfer = compute_rail_receptance(model, StruckTrack::x, 33.1, shifted),
             to_sleeper = compute_sleeper_receptance(model, StruckTrack::x, j, shifted);
  for (Eigen::Index k = 0; k < n; ++k) {
    // the pinned-pinned mode of the rail goes on ringing, as no pad damps it: measured 7e-7, sleeper 4e-12
    EXPECT_LT(std::abs(rail[k] / F[k] / transfer[k] - 1.0), 1e-6);
    EXPECT_LT(std::abs(sleeper[k] / F[k] / to_sleeper[k] - 1.0), 1e-10);
  }
}

}  // namespace

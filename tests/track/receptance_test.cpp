#include "track/receptance.hpp"

#include <gmock/gmock.h>
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

TEST(Receptance, OfASleeperBelowSoftPadsIsThatOfItsMassOnTheBallast) {
  TrackData data = thalys_like_track();
  data.foundation = RigidGround{};
  data.pad_stiffness = 1;  // next to the ballast's 8e7 N/m
  data.pad_damping = 0;
  const TrackModel track(data, 100);
  const std::vector<double> frequencies = {2, 60, 400};
  const double k = data.ballast_stiffness, d = data.ballast_damping, m = data.sleeper_mass;
  const auto own = compute_receptance_between_sleepers(track, 50, 50, frequencies);
  const auto next = compute_receptance_between_sleepers(track, 50, 51, frequencies);
  for (Eigen::Index n = 0; n < own.size(); ++n) {
    const double w = 2 * pi * frequencies[static_cast<std::size_t>(n)];
    const std::complex<double> exact = 1.0 / std::complex<double>(k - w * w * m, w * d);
    // a pad over the ballast
    EXPECT_LT(std::abs(own[n] - exact), 1e-6 * std::abs(exact));
    EXPECT_LT(std::abs(next[n]), 1e-6 * std::abs(exact));
  }
}

TEST(Receptance, BetweenSleepersAndRailIsReciprocal) {
  const TrackModel track(thalys_like_track(), 100);
  const std::vector<double> frequencies = {5, 50, 300};
  const auto forward = compute_receptance_between_sleepers(track, 50, 53, frequencies),
             backward = compute_receptance_between_sleepers(track, 53, 50, frequencies);
  EXPECT_LT((forward - backward).norm(), 1e-10 * forward.norm());

  const double x = track.sleeper_x(53) + 0.2;
  const auto to_sleeper = compute_sleeper_receptance(track, x, 50, frequencies);
  const Eigen::VectorXd on_sleeper = Eigen::VectorXd::Unit(track.size(), track.sleeper_dof(50));
  const Eigen::MatrixXcd q = compute_harmonic_response(track, on_sleeper, frequencies);
  const RailPoint point = track.rail_point(x);
  for (Eigen::Index n = 0; n < to_sleeper.size(); ++n) {
    std::complex<double> rail = 0;
    for (int i = 0; i < 4; ++i) rail += point.shape.N[i] * q(point.dof[i], n);
    EXPECT_LT(std::abs(rail - to_sleeper[n]), 1e-10 * std::abs(rail));
  }
}

TEST(Receptance, RefusesASleeperThatTheTrackLacks) {
  const TrackModel track(thalys_like_track(), 100);
  EXPECT_THAT(
      [&] { compute_receptance_between_sleepers(track, 0, 101, std::vector<double>{10}); },
      testing::ThrowsMessage<easydyn::ModelError>(testing::HasSubstr("sleeper = 101, must be 0 to 100")));
}

}  // namespace

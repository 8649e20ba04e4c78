// A constant force that moves along the discretely supported track, in time and finite elements, against the
// frequency-domain solution of the infinite periodic track (tests/reference/periodic_support.hpp).

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "easydyn/sim/implicit_stepper.hpp"
#include "easydyn/sim/static_equilibrium.hpp"
#include "tests/reference/periodic_support.hpp"
#include "track/flexible_track.hpp"

namespace {

using namespace easydyn;
using namespace easydyn::track;
const double pi = std::acos(-1.0);
constexpr double P = 1e5, v = 300 / 3.6, start = -24;

TrackData track_data(int elements_per_bay) {
  TrackData data = thalys_like_track();
  data.elements_per_bay = elements_per_bay;
  return data;
}

class ForceOnTrack : public System {
 public:
  explicit ForceOnTrack(int elements_per_bay)
      : track(*this, TrackModel(track_data(elements_per_bay), 120, -70 * 0.6)) {}
  FlexibleTrack track;

 protected:
  void positions() override {}
  void forces() override { track.touch_rail(start + v * time().value()).add_force(P); }
};

struct Error {
  double rail, sleeper, ballast;
};

/// Largest errors at the sleeper at x = 0, relative to the largest values, while the force goes from -9 to 9 m.
Error compare(int elements_per_bay, double step) {
  ForceOnTrack system(elements_per_bay);
  const TrackModel& model = system.track.model();
  const int sleeper = 70, w = model.rail_dof(sleeper * elements_per_bay), u_s = model.sleeper_dof(sleeper);
  Newmark newmark(system, solve_quasi_static_motion(system, system.initial_state(), 2e-3), {.step = step});
  std::vector<double> t, rail, displacement, ballast;
  const long every = std::lround(1e-3 / step);
  for (long i = 1; newmark.state().t < (9 - start) / v; ++i) {
    newmark.step();
    const State& s = newmark.state();
    const double x = start + v * s.t;
    if (i % every != 0 || x < -9) continue;
    t.push_back(x / v);
    rail.push_back(s.q[w]);
    displacement.push_back(s.q[u_s]);
    ballast.push_back(model.ballast_reaction(sleeper, s.q, s.qd));
  }
  const TrackData& d = model.data();
  const Clm c = as_clm(d.foundation);
  const reference::PeriodicSupport periodic{.EI = d.rails * d.rail.bending_stiffness(),
                                            .m = d.rails * d.rail.mass_per_length,
                                            .L = d.sleeper_spacing,
                                            .k_p = d.pad_stiffness,
                                            .d_p = d.pad_damping,
                                            .m_s = d.sleeper_mass,
                                            .k_b = d.ballast_stiffness,
                                            .d_b = d.ballast_damping,
                                            .m_f = c.m_f,
                                            .k_f = c.k_f,
                                            .d_f = c.d_f,
                                            .k_c = c.k_c,
                                            .d_c = c.d_c};
  const auto exact = periodic.passing_force(P, v, t, 2 * pi / 3, 2 * pi * 3000);
  const auto largest_error = [](const std::vector<double>& a, const std::vector<double>& b) {
    double worst = 0, largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      worst = std::max(worst, std::abs(a[i] - b[i]));
      largest = std::max(largest, std::abs(b[i]));
    }
    return worst / largest;
  };
  return {largest_error(rail, exact.rail), largest_error(displacement, exact.sleeper),
          largest_error(ballast, exact.ballast_reaction)};
}

TEST(MovingForceOnTrack, AgreesWithTheFrequencyDomainSolutionOfThePeriodicTrack) {
  const Error e = compare(4, 5e-5);  // measured 5.6e-6, 1.1e-6, 5.6e-6
  EXPECT_LT(e.rail, 1e-5);
  EXPECT_LT(e.sleeper, 3e-6);
  EXPECT_LT(e.ballast, 1e-5);
}

TEST(MovingForceOnTrack, ConvergesWithOrder2InTime) {
  const Error coarse = compare(4, 4e-4), fine = compare(4, 2e-4), finest = compare(4, 1e-4);
  EXPECT_LT(coarse.ballast, 3e-4);                                   // measured 1.7e-4
  EXPECT_NEAR(std::log2(coarse.ballast / fine.ballast), 2, 0.15);    // measured 2.01
  EXPECT_NEAR(std::log2(coarse.sleeper / finest.sleeper), 4, 0.15);  // two halvings: measured 3.99
}

TEST(MovingForceOnTrack, ConvergesWithTheMesh) {
  const Error one = compare(1, 2.5e-5), two = compare(2, 2.5e-5), four = compare(4, 2.5e-5);
  // sleeper: 2.1e-4, 2.8e-5, 5.0e-7; ballast 9.6e-4, 1.9e-4, 5.1e-6: shape functions that are exact in statics, and
  // 1 and 2 elements too long for the fourth order
  EXPECT_LT(one.ballast, 2e-3);
  EXPECT_GT(std::log2(one.sleeper / two.sleeper), 2.5);  // measured 2.9
  EXPECT_GT(std::log2(two.sleeper / four.sleeper), 4);   // measured 5.8
  EXPECT_GT(std::log2(two.rail / four.rail), 3.8);       // measured 4.0
  EXPECT_GT(std::log2(two.ballast / four.ballast), 4);   // measured 5.2
}

}  // namespace

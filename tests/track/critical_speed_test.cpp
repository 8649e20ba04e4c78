#include "track/critical_speed.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/reference/winkler_beam.hpp"
#include "track/periodic_track.hpp"

namespace {

using namespace easydyn::track;

TEST(CriticalSpeed, OfABeamOnABeddingIsTheClosedForm) {
  const double EI = 6.38e6, m = 60.21, k = 50e6;
  TrackData data = t2000_like_track();
  data.rail = rail_section("60E1");
  data.rail.inertia = EI / data.rail.youngs_modulus;
  data.rails = 1;
  data.sleeper_spacing = 0.1;
  data.pad_stiffness = k * 0.1;
  data.sleeper_mass = 1e-6;
  data.ballast_stiffness = 1e6 * k * 0.1;
  data.foundation = RigidGround{};
  const CriticalSpeed critical = compute_critical_speed(data);
  const easydyn::reference::WinklerBeam beam{EI, m, k};
  // springs 0.1 m apart change EI by 1.1e-6
  EXPECT_NEAR(critical.speed / beam.critical_speed(), 1, 5e-6);
  EXPECT_NEAR(critical.wavenumber / std::pow(k / EI, 0.25), 1, 2e-3);  // a minimum is flat
  EXPECT_TRUE(critical.is_wave);
  EXPECT_NEAR(critical.frequency * 2 * std::acos(-1.0), critical.speed * critical.wavenumber, 1e-6);
}

TEST(CriticalSpeed, IsWherePhaseAndGroupSpeedAgree) {
  // light sleepers on rigid ground: a minimum inside the range; by finite elements here, exact beams there
  TrackData euler = railfe_default_track();
  euler.sleeper_mass = 40;
  TrackData timoshenko = euler;
  timoshenko.theory = RailTheory::timoshenko;
  for (const TrackData& data : {euler, timoshenko}) {
    const CriticalSpeed critical = compute_critical_speed(data);
    EXPECT_TRUE(critical.is_wave);
    const auto waves = PeriodicTrack(data).compute_propagating_waves(critical.frequency);
    ASSERT_FALSE(waves.empty());
    // the group speed changes with the first power of the distance from the minimum
    EXPECT_NEAR(waves[0].wavenumber / critical.wavenumber, 1, 2e-3);
    EXPECT_NEAR(waves[0].phase_speed / critical.speed, 1, 2e-3);
    EXPECT_NEAR(waves[0].group_speed / critical.speed, 1, 2e-2);
  }
}

TEST(CriticalSpeed, IsEstimatedWhereHeavySupportsSlowDownTheShortWaves) {
  const CriticalSpeed critical = compute_critical_speed(thalys_like_track());
  EXPECT_FALSE(critical.is_wave);
  // k_w = 1 / (1/200 + 1/80 + 1/27.2) MN/m / 0.6 m = 31.1 MN/m2, m = 120.42 + (300 + 346) / 0.6 = 1197 kg/m,
  // EI = 12.76 MN m2: (4 k_w EI / m^2)^(1/4)
  const double k_w = 1 / (1 / 200e6 + 1 / 80e6 + 1 / 27.2e6) / 0.6, m = 2 * 60.21 + (300 + 346) / 0.6,
               EI = 2 * 210e9 * 3.038e-5;
  EXPECT_NEAR(critical.speed, std::pow(4 * k_w * EI / (m * m), 0.25), 1e-9 * critical.speed);
  EXPECT_NEAR(critical.speed, 182, 1);
}

TEST(CriticalSpeed, WarnsFromSevenTenthsOn) {
  const TrackData data = thalys_like_track();
  const double critical = compute_critical_speed(data).speed;
  EXPECT_FALSE(warn_of_critical_speed(data, 0.69 * critical));
  const auto warning = warn_of_critical_speed(data, 0.9 * critical);
  ASSERT_TRUE(warning);
  EXPECT_THAT(*warning, testing::HasSubstr("is 0.90 of the critical speed"));
}

}  // namespace

#include "track_on_soil/critical_speed.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "easydyn/error.hpp"
#include "soil/site_file.hpp"
#include "tests/track_on_soil/small_sites.hpp"
#include "track/free_track_wave.hpp"

namespace easydyn::track_on_soil {
namespace {

using easydyn::testing::half_space;
using easydyn::testing::layer_of;
constexpr double pi = std::numbers::pi;

TEST(FreeTrackWave, IsThatOfAFreeBeamWhereTheWavesAreLong) {
  const track::TrackData data = track::thalys_like_track();
  const track::FreeTrackWave wave = compute_free_track_wave(data);
  // w = k^2 sqrt(EI / m); pads of 333 MN/m2 give way by m_s w^2 / p = 500 (2 pi 10)^2 / 3.3e8 = 0.6 % at 10 Hz.
  const double EI = 2 * 210e9 * 3.038e-5, m = 2 * 60.21 + 300 / 0.6;
  for (Eigen::Index i = 0; i < wave.frequency.size(); ++i) {
    const double k = wave.wavenumber[i];
    if (wave.frequency[i] < 1) {
      EXPECT_NEAR(2 * pi * wave.frequency[i], k * k * std::sqrt(EI / m), 1e-4 * 2 * pi * wave.frequency[i]);
    }
    EXPECT_NEAR(wave.phase_speed[i], 2 * pi * wave.frequency[i] / k, 1e-9 * wave.phase_speed[i]);
    // two springs in a row: the quadratic equation of w^2
    const double p = 200e6 / 0.6, a = EI * std::pow(k, 4) + p, m_r = 2 * 60.21, m_s = 500;
    const double b = a * m_s + p * m_r, c = p * EI * std::pow(k, 4);
    const double w2 = 2 * c / (b + std::sqrt(b * b - 4 * m_r * m_s * c));
    EXPECT_NEAR(2 * pi * wave.frequency[i] / std::sqrt(w2), 1, 1e-6);
  }
}

TEST(FreeTrackWave, CarriesTheMassOfItsBallastAndSlab) {
  track::TrackData data = track::zhai_2004_track();
  data.ballast_mass->shear_stiffness = 0;
  const track::FreeTrackWave wave = compute_free_track_wave(data);
  const double EI = rail_beam(data).bending_stiffness,
               m = rail_beam(data).mass_per_length + (251 + 1062.8) / 0.6;
  EXPECT_NEAR(wave.frequency[0], wave.wavenumber[0] * wave.wavenumber[0] * std::sqrt(EI / m) / (2 * pi),
              1e-4 * wave.frequency[0]);
  track::TrackData slab = track::thalys_like_track();
  slab.slab = track::Slab{3e8, 3000};
  slab.sleeper_mass = 0;
  const track::FreeTrackWave slow = compute_free_track_wave(slab);
  EXPECT_NEAR(slow.frequency[0],
              slow.wavenumber[0] * slow.wavenumber[0] *
                  std::sqrt((3e8 + rail_beam(slab).bending_stiffness) / (3000 + 2 * 60.21)) / (2 * pi),
              1e-4 * slow.frequency[0]);
  EXPECT_THROW(compute_free_track_wave(data, 1), ModelError);
}

TEST(ModeCrossing, OnAHalfSpaceIsAtItsRayleighSpeed) {
  // c_R / c_S = 0.9274127 at nu = 0.3; f where k^2 sqrt(EI / m) k^-1 = c_R
  const auto crossing = find_mode_crossing(track::thalys_like_track(), half_space(100, 0.3, 0.02));
  ASSERT_TRUE(crossing);
  EXPECT_NEAR(crossing->speed, 92.74127, 1e-4);  // a power law between samples
  const double EI = 2 * 210e9 * 3.038e-5, m = 2 * 60.21 + 500;
  EXPECT_NEAR(crossing->frequency, 92.74127 * 92.74127 / std::sqrt(EI / m) / (2 * pi),
              0.02 * crossing->frequency);
}

TEST(ModeCrossing, LiesOnBothCurvesOfALayeredGround) {
  soil::Site site = half_space(300, 0.33, 0.02);
  site.layers.insert(site.layers.begin(), layer_of(2, 90, 0.33, 1800, 0.02));
  const track::TrackData data = track::thalys_like_track();
  const auto crossing = find_mode_crossing(data, site);
  ASSERT_TRUE(crossing);
  EXPECT_GT(crossing->speed, 0.93 * 90);
  EXPECT_LT(crossing->speed, 0.94 * 300);
  const soil::LayeredGround ground(site, soil::GroundDamping::none);
  EXPECT_NEAR(compute_rayleigh_speeds(ground, crossing->frequency).front(), crossing->speed,
              1e-6 * crossing->speed);
  const track::FreeTrackWave wave = compute_free_track_wave(data, 4000);
  Eigen::Index nearest = 0;
  (wave.frequency.array() - crossing->frequency).abs().minCoeff(&nearest);
  EXPECT_NEAR(wave.phase_speed[nearest], crossing->speed, 2e-3 * crossing->speed);  // samples 0.1 % apart
}

TEST(ModeCrossing, IsMissingWhereOneWaveStaysSlower) {
  track::TrackData heavy = track::thalys_like_track();
  heavy.sleeper_mass = 3000;  // on its pads up to 41 Hz
  heavy.pad_stiffness = 50e6;
  EXPECT_FALSE(find_mode_crossing(heavy, half_space(600, 0.3, 0.02)));
}

TEST(FindCrossing, RefusesSamplesThatDoNotFit) {
  const soil::LayeredGround ground(half_space(100, 0.3, 0.02), soil::GroundDamping::none);
  EXPECT_THROW(find_crossing(ground, Eigen::Vector2d(1, 2), Eigen::Vector3d(1, 2, 3)), ModelError);
  EXPECT_THROW(find_crossing(ground, Eigen::Vector2d(2, 2), Eigen::Vector2d(1, 2)), ModelError);
  EXPECT_THROW(find_crossing(ground, Eigen::Vector2d(1, 2), Eigen::Vector2d(0, 2)), ModelError);
  EXPECT_FALSE(
      find_crossing(ground, Eigen::Vector2d(1, 2), Eigen::Vector2d(200, 300)));  // faster from the start
}

TEST(DeflectionOverSpeed, OfALightSoftTrackOnAHalfSpaceIsLargestAtTheRayleighSpeed) {
  track::TrackData data = track::thalys_like_track();
  data.sleeper_mass = 30;
  const DeflectionOverSpeed response = compute_deflection_over_speed(data, half_space(100, 0.3, 0.005));
  ASSERT_TRUE(response.critical_speed);
  EXPECT_NEAR(*response.critical_speed, 92.74, 0.02 * 92.74);  // 1 % of the parabola, damping
}

TEST(DeflectionOverSpeed, OfTheBundledTracksIsLargestBelowTheCrossing) {
  // Measured: 123.3 of 139.5 m/s (tram), 111.1 of 124.5 m/s (HST).
  const auto expect_ratio = [](const track::TrackData& data, const std::string& name) {
    const soil::Site site = soil::read_site(std::string(EASYDYN_SITES) + "/" + name);
    const DeflectionOverSpeed response = compute_deflection_over_speed(data, site);
    const auto crossing = find_mode_crossing(data, site);
    ASSERT_TRUE(response.critical_speed);
    ASSERT_TRUE(crossing);
    EXPECT_GT(crossing->speed / *response.critical_speed, 1.10) << name;
    EXPECT_LT(crossing->speed / *response.critical_speed, 1.15) << name;
    EXPECT_GT(*response.critical_speed, compute_upper_rayleigh_speed(site));
    EXPECT_GT(response.deflection.maxCoeff(), 1.2 * response.deflection[0]);
  };
  expect_ratio(track::t2000_like_track(), "tram.toml");
  expect_ratio(track::thalys_like_track(), "hst.toml");
}

TEST(UpperRayleighSpeed, IsThatOfTheUppermostLayer) {
  soil::Site site = half_space(300, 0.33, 0.02);
  site.layers.insert(site.layers.begin(), layer_of(2, 100, 0.3, 1800, 0.02));
  EXPECT_NEAR(compute_upper_rayleigh_speed(site), 92.74127, 1e-4);
}

}  // namespace
}  // namespace easydyn::track_on_soil

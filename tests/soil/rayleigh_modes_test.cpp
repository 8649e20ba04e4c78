// Rayleigh modes of a layered ground.

#include "soil/layered/rayleigh_modes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "soil/layered/wavenumber_response.hpp"

namespace easydyn::soil {
namespace {

constexpr double pi = std::numbers::pi;

Layer make_layer(double thickness, double cs, double nu, double density, double damping) {
  Layer layer;
  layer.thickness = thickness;
  layer.cs = cs;
  layer.cp = cs * std::sqrt((2 - 2 * nu) / (1 - 2 * nu));
  layer.density = density;
  layer.damping = damping;
  return layer;
}

TEST(RayleighModes, HaveTheRayleighSpeedOfAHalfSpace) {
  // c_R / c_S, the root of the Rayleigh equation, to seven digits.
  const double expected[][2] = {
      {0, 0.8740320}, {0.25, 0.9194017}, {0.3, 0.9274127}, {0.35, 0.9350131}, {0.4, 0.9421954}};
  for (const auto& [nu, ratio] : expected) {
    Site site;
    site.layers = {make_layer(0, 200, nu, 1800, 0)};
    const LayeredGround ground(site, GroundDamping::none);
    for (const double f : {1.0, 40.0}) {
      const std::vector<double> speeds = compute_rayleigh_speeds(ground, f);
      ASSERT_EQ(speeds.size(), 1u) << nu;
      EXPECT_NEAR(speeds[0] / 200, ratio, 1e-7);
    }
  }
}

TEST(RayleighModes, RunFromTheHalfSpaceToTheUppermostLayer) {
  Site site;
  site.layers = {make_layer(4, 120, 0.3, 1800, 0), make_layer(0, 400, 0.3, 1800, 0)};
  const LayeredGround ground(site, GroundDamping::none);
  EXPECT_NEAR(compute_rayleigh_speeds(ground, 0.05)[0], 400 * 0.9274127, 1);    // waves of 7 km
  EXPECT_NEAR(compute_rayleigh_speeds(ground, 200)[0], 120 * 0.9274127, 1e-3);  // of half a metre
  EXPECT_EQ(compute_rayleigh_speeds(ground, 2).size(), 1u);
  EXPECT_GT(compute_rayleigh_speeds(ground, 100).size(), 4u);
}

/// Elastic layers as of the bundled site of the high-speed train (examples/sites/hst.toml): thickness, cs, nu, density.
Site three_layers() {
  Site site;
  site.layers = {make_layer(1.4, 80, 0.33, 1850, 0), make_layer(1.9, 133, 0.33, 1850, 0),
                 make_layer(0, 226, 0.33, 1850, 0)};
  return site;
}

TEST(RayleighModes, AreRootsOfTheDeterminantOfTheSurfaceAndNoPoles) {
  const LayeredGround ground(three_layers(), GroundDamping::none);
  for (int i = 1; i <= 320; ++i) {
    const double f = 0.25 * i, w = 2 * pi * f;
    WavenumberResponse response(ground.compute_layers(w), 0, {});
    for (const double speed : compute_rayleigh_speeds(ground, f)) {
      // Linear about a root, whatever its slope: a hundredth at a hundredth of the distance. About a pole: a hundredfold.
      const auto value_at = [&](double distance) {
        return std::abs(response.compute_surface_determinant(w / speed * (1 + distance)));
      };
      for (const double side : {-1, 1})
        EXPECT_LT(value_at(1e-10 * side), 0.02 * value_at(1e-8 * side)) << f << " Hz, " << speed << " m/s";
    }
  }
}

TEST(RayleighModes, AreContinuousInFrequency) {
  const LayeredGround ground(three_layers(), GroundDamping::none);
  constexpr double step = 0.25;  // [Hz]
  std::vector<double> before = compute_rayleigh_speeds(ground, step);
  for (double f = 2 * step; f <= 80; f += step) {
    const std::vector<double> speeds = compute_rayleigh_speeds(ground, f);
    // Waves become slower with frequency on ground that is stiffer below; a new mode enters at the half-space's cs.
    ASSERT_GE(speeds.size(), before.size()) << f << " Hz";
    ASSERT_LE(speeds.size(), before.size() + 1) << f << " Hz";
    for (std::size_t mode = 0; mode < before.size(); ++mode) {
      EXPECT_LT(speeds[mode], before[mode]) << "mode " << mode << ", " << f << " Hz";
      EXPECT_GT(speeds[mode], before[mode] - 20 * step) << "mode " << mode << ", " << f << " Hz";
    }
    before = speeds;
  }
  EXPECT_GE(before.size(), 4u);
}

TEST(RayleighModes, BesideAPoleAreFound) {
  // At 35 Hz a root and a pole of the surface's determinant lie so near to each other that it has one sign on both sides.
  const LayeredGround ground(three_layers(), GroundDamping::none);
  const std::vector<double> at_34 = compute_rayleigh_speeds(ground, 34),
                            at_35 = compute_rayleigh_speeds(ground, 35),
                            at_36 = compute_rayleigh_speeds(ground, 36);
  ASSERT_EQ(at_35.size(), 3u);
  EXPECT_NEAR(at_35[1], (at_34[1] + at_36[1]) / 2, 0.1);  // second difference of the mode: 0.1 m/s
}

TEST(RayleighModes, ArePeaksOfTheGreensFunction) {
  // With little damping (0.05 %) the surface moves most at the wavenumbers of the modes: where |u_z| has its local
  // maxima along k. A peak is met within its width, 5e-4 k.
  for (const bool is_inverse : {false, true}) {
    Site site;
    site.damping_frequency = 20;
    site.layers = {make_layer(1.4, is_inverse ? 140 : 80, 0.33, 1850, 5e-4),
                   make_layer(1.9, is_inverse ? 100 : 133, 0.33, 1850, 5e-4),
                   make_layer(0, 226, 0.33, 1850, 5e-4)};
    const LayeredGround damped(site, GroundDamping::constant_q);
    for (const double f : {5.0, 20.0, 33.0, 60.0}) {
      const double w = 2 * pi * f;
      WavenumberResponse response(damped.compute_layers(w), 0, {0});
      const auto amplitude = [&](double k) {
        WavenumberCompliance G;
        response.update(k, &G);
        return std::abs(G.zz) * k;
      };
      std::vector<double> peaks;  // slowest first
      const double low = w / 224, high = w / 70, step = 1e-4 * high;
      for (double k = high; k > low; k -= step) {
        const double middle = amplitude(k);
        if (middle > 3 * amplitude(k + 20 * step) && middle > 3 * amplitude(k - 20 * step) &&
            middle >= amplitude(k + step) && middle > amplitude(k - step))
          peaks.push_back(w / k);
      }
      const std::vector<double> speeds = compute_rayleigh_speeds(damped, f);
      ASSERT_FALSE(peaks.empty());
      // Every peak is a mode; a mode may move the surface too little for a peak.
      for (const double peak : peaks) {
        double nearest = 1e9;
        for (const double speed : speeds) nearest = std::min(nearest, std::abs(speed - peak));
        EXPECT_LT(nearest, 5e-4 * peak) << f << " Hz, peak at " << peak << " m/s";
      }
      EXPECT_LE(peaks.size(), speeds.size());
    }
  }
}

TEST(RayleighModes, TellFromWhichFrequencyATrainRadiates) {
  Site site;
  site.layers = {make_layer(4, 120, 0.3, 1800, 0), make_layer(0, 400, 0.3, 1800, 0)};
  const LayeredGround ground(site, GroundDamping::none);
  const double f = find_radiation_frequency(ground, 150, 0.5, 100);
  EXPECT_NEAR(compute_rayleigh_speeds(ground, f)[0], 150, 1e-3);
  EXPECT_TRUE(std::isnan(find_radiation_frequency(ground, 100, 0.5, 100)));  // slower than any wave
  EXPECT_EQ(find_radiation_frequency(ground, 380, 0.5, 100), 0.5);           // faster than all of them
}

}  // namespace
}  // namespace easydyn::soil

#include "soil/indicators.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "soil/kb_value.hpp"
#include "soil/third_octave.hpp"

namespace easydyn::soil {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double step = 1e-3;

Eigen::ArrayXd make_time(double duration) {
  const auto n = static_cast<Eigen::Index>(std::lround(duration / step));
  return Eigen::ArrayXd::LinSpaced(n, 0, step * static_cast<double>(n - 1));
}

Eigen::VectorXd make_sine(double amplitude, double f, double duration, double phase = 0) {
  return amplitude * (2 * pi * f * make_time(duration) + phase).sin();
}

// A sine that is brought in and out slowly, so that a filter stays in its steady state.
Eigen::VectorXd make_slow_sine(double amplitude, double f, double duration, double fade) {
  const Eigen::ArrayXd t = make_time(duration);
  const Eigen::ArrayXd edge = (t.min(duration - t) / fade).min(1.0);
  return amplitude * (2 * pi * f * t).sin() * 0.5 * (1 - (pi * edge).cos());
}

TEST(PeakParticleVelocity, IsTheAmplitudeOfASine) {
  // 8.1 samples per period: the samples themselves miss the peak by up to 7 %.
  const Eigen::VectorXd v = make_sine(2e-3, 123.4, 0.02, 0.3);
  EXPECT_NEAR(compute_peak(v), 2e-3, 2e-3 * 0.01);
  EXPECT_NEAR(compute_peak(make_sine(2e-3, 100, 1, 0.3)), 2e-3, 2e-3 * 0.004);
  EXPECT_NEAR(compute_peak(make_sine(-2e-3, 10, 1)), 2e-3, 2e-3 * 1e-5);
}

TEST(PeakParticleVelocity, OfTheResultantIsTheLongestVector) {
  // A circle of radius 3 in (x, y) and a constant 4 along z.
  const Eigen::VectorXd x = make_sine(3, 10, 1), y = make_sine(3, 10, 1, pi / 2);
  EXPECT_NEAR(compute_resultant_peak(x, y, Eigen::VectorXd::Constant(x.size(), 4)), 5, 1e-9);
  EXPECT_NEAR(compute_resultant_peak(x, 0 * x, 0 * x), 3, 1e-4);
}

TEST(ThirdOctave, HasTheCentresOfTheBaseTenSystem) {
  const Eigen::VectorXd centres = third_octave_centres();
  ASSERT_EQ(centres.size(), 21);
  EXPECT_NEAR(centres(0), 1, 1e-12);
  EXPECT_NEAR(centres(1), 1.2589, 1e-4);
  EXPECT_NEAR(centres(12), 15.849, 1e-3);
  EXPECT_NEAR(centres(20), 100, 1e-9);
}

TEST(ThirdOctave, FindsASineInItsBandOnly) {
  const Eigen::VectorXd rms = compute_third_octave_rms(make_sine(2, 16, 2), step, 200);
  for (Eigen::Index b = 0; b < rms.size(); ++b) {
    EXPECT_NEAR(rms(b), b == 12 ? 2 / std::sqrt(2) : 0, 1e-10) << b;
  }
}

TEST(ThirdOctave, AddsUpToTheRmsOfTheSignal) {  // Parseval
  // A chirp from 5 to 60 Hz, brought in and out slowly: nothing outside 1-100 Hz.
  const Eigen::ArrayXd t = make_time(4);
  const Eigen::VectorXd v = (pi * t / 4).sin().square() * (2 * pi * (5 * t + 55.0 / 8 * t * t)).sin();
  const Eigen::VectorXd rms = compute_third_octave_rms(v, step, 200);
  EXPECT_NEAR(rms.norm(), v.norm() / std::sqrt(static_cast<double>(v.size())), 1e-6);
}

TEST(ThirdOctave, SharesALineBetweenTheBandsItOverlaps) {
  // The line of 2 s at 4.5 Hz reaches from 4.25 to 4.75 Hz; the edge of the bands 4 and 5 Hz is at 4.467 Hz.
  const Eigen::VectorXd rms = compute_third_octave_rms(make_sine(1, 4.5, 2), step, 200);
  const double edge = std::pow(10, 0.65);
  EXPECT_NEAR(rms(6) * rms(6), 0.5 * (edge - 4.25) / 0.5, 1e-9);
  EXPECT_NEAR(rms(7) * rms(7), 0.5 * (4.75 - edge) / 0.5, 1e-9);
}

TEST(ThirdOctave, DoesNotClaimBandsAboveTheHighestFrequency) {
  const Eigen::VectorXd rms = compute_third_octave_rms(make_sine(1, 16, 1), step, 50);
  for (Eigen::Index b = 0; b < rms.size(); ++b) {
    EXPECT_EQ(std::isnan(rms(b)), b > 16)
        << b;  // the band of 40 Hz ends at 44.7 Hz, that of 50 Hz at 56.2 Hz
  }
  // An edge that is the highest frequency belongs to the band; beyond half the sampling rate nothing is
  // known.
  EXPECT_FALSE(std::isnan(compute_third_octave_rms(make_sine(1, 16, 1), step, std::pow(10, 1.65))(16)));
  EXPECT_TRUE(std::isnan(compute_third_octave_rms(make_sine(1, 16, 1), step, std::pow(10, 1.65) - 1e-3)(16)));
  EXPECT_TRUE(std::isnan(compute_third_octave_rms(Eigen::VectorXd::Ones(64), 0.01, 200)(17)));
}

TEST(KbFilter, WeightsByTheHighPassOfTheStandardWithinItsBand) {
  // At 10 Hz the band limits take less than 0.01 %.
  for (const double f : {4.0, 5.6, 10.0, 16.0}) {
    EXPECT_NEAR(std::abs(kb_filter_response(f)), 1 / std::sqrt(1 + std::pow(5.6 / f, 2)), 2e-3) << f;
  }
  // Butterworth: -3 dB at 0.8 Hz and 100 Hz.
  EXPECT_NEAR(std::abs(kb_filter_response(100)), std::sqrt(0.5) / std::sqrt(1 + std::pow(0.056, 2)), 1e-8);
  EXPECT_NEAR(std::abs(kb_filter_response(0.8)), std::sqrt(0.5) / std::sqrt(1 + 49), 1e-8);
  EXPECT_EQ(kb_filter_response(0), 0.0);
}

TEST(RunningRms, FollowsAStepExponentially) {
  const Eigen::VectorXd rms = compute_running_rms(Eigen::VectorXd::Constant(500, 3), step, 0.125);
  for (const Eigen::Index n : {0, 1, 125, 499}) {
    EXPECT_NEAR(rms(n), 3 * std::sqrt(1 - std::exp(-static_cast<double>(n) * step / 0.125)), 1e-9) << n;
  }
}

// KB_F of a steady sine: A |H| / sqrt(2), with a ripple at twice the frequency:
// KB_F^2 = (A |H|)^2 / 2 (1 + cos(...) / sqrt(1 + (2 w tau)^2)).
TEST(KbFMax, OfASineIsItsWeightedRmsWithTheRippleOfTheWindow) {
  for (const double f : {5.6, 16.0, 40.0}) {
    const Eigen::VectorXd v = make_slow_sine(2e-3, f, 12, 4);
    const double weighted = 2 * std::abs(kb_filter_response(f)) / std::sqrt(2);
    const double ripple = 1 / std::sqrt(1 + std::pow(4 * pi * f * 0.125, 2));
    EXPECT_NEAR(compute_kb_f(v, step).maxCoeff(), weighted * std::sqrt(1 + ripple), 2e-3 * weighted) << f;
  }
}

TEST(KbFMax, DoesNotDependOnTheTimeStep) {
  const Eigen::VectorXd fine = make_slow_sine(1e-3, 30, 8, 2);
  const Eigen::VectorXd coarse = fine(Eigen::seq(0, Eigen::last, 4));
  EXPECT_NEAR(compute_kb_f(coarse, 4 * step).maxCoeff(), compute_kb_f(fine, step).maxCoeff(), 2e-3);
}

TEST(VdB, OfASineIsItsRms) {
  // 1e-6 in/s = 2.54e-8 m/s, so that an rms value of 2.54e-5 m/s has 60 dB.
  EXPECT_NEAR(compute_vdb(make_sine(2.54e-5 * std::sqrt(2), 20, 3), step), 60, 1e-9);
}

TEST(VdB, FindsTheLoudestSecond) {
  Eigen::VectorXd v = 0.1 * make_sine(2.54e-5 * std::sqrt(2), 20, 5);
  v.segment(2300, 1000) *= 10;
  EXPECT_NEAR(compute_vdb(v, step), 60, 1e-9);
  // Half a second of vibration within a second: -3 dB, also where the record itself is that short.
  EXPECT_NEAR(compute_vdb(make_sine(2.54e-5 * std::sqrt(2), 20, 0.5), step), 60 - 10 * std::log10(2), 1e-9);
  EXPECT_TRUE(std::isnan(compute_vdb(0 * v, step)));
}

TEST(Indicators, AreThoseOfEachComponent) {
  const Eigen::VectorXd x = make_sine(1e-3, 10, 2), y = make_sine(2e-3, 20, 2), z = make_sine(3e-3, 16, 2);
  const Indicators indicators = compute_indicators(x, y, z, step, 50);
  EXPECT_NEAR(indicators.ppv[0], 1e-3, 1e-8);
  EXPECT_NEAR(indicators.ppv[1], 2e-3, 1e-7);
  EXPECT_NEAR(indicators.ppv[2], 3e-3, 1e-7);
  EXPECT_EQ(indicators.ppv[3], compute_resultant_peak(x, y, z));
  EXPECT_NEAR(indicators.third_octave_rms(12), 3e-3 / std::sqrt(2), 1e-9);
  EXPECT_EQ(indicators.kb_f_max, compute_kb_f(z, step).maxCoeff());
  EXPECT_EQ(indicators.vdb, compute_vdb(z, step));
}

}  // namespace
}  // namespace easydyn::soil

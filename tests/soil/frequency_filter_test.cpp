#include "soil/frequency_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace easydyn::soil {
namespace {

constexpr double pi = std::numbers::pi;

Eigen::VectorXd make_sine(double f, double step, Eigen::Index n) {
  return (2 * pi * f * step * Eigen::ArrayXd::LinSpaced(n, 0, static_cast<double>(n - 1))).sin();
}

TEST(FastLength, HasNoLargePrimeFactor) {
  EXPECT_EQ(compute_fast_length(1), 2);
  EXPECT_EQ(compute_fast_length(7), 8);
  EXPECT_EQ(compute_fast_length(997), 1000);
  EXPECT_EQ(compute_fast_length(1000), 1000);
  EXPECT_EQ(compute_fast_length(1001), 1024);
}

TEST(Spectrum, HoldsTheEnergyOfTheSignal) {  // Parseval
  const Eigen::VectorXd x = Eigen::VectorXd::Random(300);
  const Eigen::VectorXcd spectrum = compute_spectrum(x, 320);
  const double energy =
      (2 * spectrum.squaredNorm() - std::norm(spectrum(0)) - std::norm(spectrum(160))) / 320;
  EXPECT_NEAR(energy, x.squaredNorm(), 1e-10 * x.squaredNorm());
}

TEST(FrequencyFilter, GivesBackWhatPassesUnchanged) {
  const Eigen::VectorXd x = Eigen::VectorXd::Random(101);
  const auto all_pass = [](double) { return std::complex<double>(1); };
  EXPECT_NEAR((apply_filter(x, 0.01, all_pass, RecordEnds::zero, 1) - x).norm(), 0, 1e-12);
  EXPECT_NEAR((apply_filter(x, 0.01, all_pass, RecordEnds::mirrored) - x).norm(), 0, 1e-12);
}

// A first-order low-pass answers a step at t = 0 (a record that starts with 1) by 1 - exp(-t / tau).
TEST(FrequencyFilter, IsCausalWhenItsResponseIs) {
  const double tau = 0.05, step = 1e-3;
  const auto low_pass = [&](double f) { return 1.0 / (1.0 + std::complex<double>(0, 2 * pi * f * tau)); };
  const Eigen::VectorXd y = apply_filter(Eigen::VectorXd::Ones(400), step, low_pass, RecordEnds::zero, 1);
  for (const Eigen::Index n : {20, 50, 100, 399}) {
    // The first sample counts for half a step before t = 0 as well.
    EXPECT_NEAR(y(n), 1 - std::exp(-(static_cast<double>(n) + 0.5) * step / tau), 2e-3) << n;
  }
}

TEST(BandLimit, PassesWhatIsClaimedAndStopsTheRest) {
  const double step = 1e-3;
  const Eigen::Index n = 2000;
  const Eigen::VectorXd constant = Eigen::VectorXd::Constant(n, 7);
  const Eigen::VectorXd inside = make_sine(45, step, n), outside = make_sine(80, step, n);
  EXPECT_NEAR((limit_band(constant, step, 50) - constant).norm(), 0, 1e-9);
  // Away from the ends, where the mirrored sine has a kink.
  EXPECT_NEAR((limit_band(inside, step, 50) - inside).middleRows(500, 1000).cwiseAbs().maxCoeff(), 0, 1e-3);
  EXPECT_NEAR(limit_band(outside, step, 50).middleRows(500, 1000).cwiseAbs().maxCoeff(), 0, 1e-3);
}

}  // namespace
}  // namespace easydyn::soil

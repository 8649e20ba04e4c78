#include "track/clm_calibration.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "easydyn/error.hpp"
#include "track/clm_chain.hpp"

namespace {

using namespace easydyn::track;
using Eigen::Index;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

constexpr double pi = 3.14159265358979323846;

const Clm soft{600.0, 5.2e7, 4.3e5, 2.4e7, -9.3e4};

/// A ground that is a chain of foundations itself: 49 frequencies, footprints to `far` spacings away.
GroundCompliance ground_of(const Clm& clm, int far = 1) {
  GroundCompliance ground{Eigen::VectorXd::LinSpaced(49, 2, 98), {}, 0.6, "a chain"};
  ground.H.resize(49, far + 1);
  for (Index i = 0; i < 49; ++i) {
    const ChainCompliance chain = compute_infinite_chain(chain_stiffness(clm, 2 * pi * ground.frequency[i]));
    for (int n = 0; n <= far; ++n) ground.H(i, n) = chain.H_0n(n);
  }
  return ground;
}

void expect_equal(const Clm& found, const Clm& expected, double tolerance) {
  EXPECT_NEAR(found.m_f, expected.m_f, tolerance * 600);  // may be 0
  EXPECT_NEAR(found.k_f / expected.k_f, 1, tolerance);
  EXPECT_NEAR(found.d_f / expected.d_f, 1, tolerance);
  EXPECT_NEAR(found.k_c / expected.k_c, 1, tolerance);
  EXPECT_NEAR(found.d_c / expected.d_c, 1, tolerance);
}

TEST(ClmCalibration, FindsTheConstantsOfAChainFromItsCompliances) {
  const ClmFit fit = calibrate_clm(ground_of(soft), {.lowest = 2, .highest = 98});
  expect_equal(fit.clm, soft, 1e-7);  // the end of the descent: squares of 1e-22
  EXPECT_LT(fit.rms_00, 1e-8);
  EXPECT_THAT(fit.bounds, IsEmpty());
  EXPECT_NEAR(fit.damping_margin, (4.3e5 - 4 * 9.3e4) / 4.3e5, 1e-6);
  EXPECT_NEAR(fit.stiffness_margin, (5.2e7 + 4 * 2.4e7) / 5.2e7, 1e-6);
  EXPECT_EQ(fit.frequency.size(), 49);
}

TEST(ClmCalibration, OfNFoundationsIsTheInverseOfTheChainsMatrix) {
  // The compliance matrix of seven foundations with free ends, by a plain inverse: no Toeplitz matrix. A ground that has
  // those entries in a row cannot exist, so the model is compared by hand: what the fit says of its middle foundation.
  const Clm& c = soft;
  const ClmFit fit = calibrate_clm(ground_of(c, 6), {.lowest = 2, .highest = 60, .foundations = 7});
  const int n = 7;
  for (Index i = 0; i < fit.frequency.size(); i += 7) {
    const auto [K_f, K_c] = chain_stiffness(fit.clm, 2 * pi * fit.frequency[i]);
    Eigen::MatrixXcd S = Eigen::MatrixXcd::Zero(n, n);
    for (int j = 0; j < n; ++j) {
      S(j, j) = K_f + K_c * double((j > 0) + (j + 1 < n));
      if (j + 1 < n) S(j, j + 1) = S(j + 1, j) = -K_c;
    }
    const Eigen::MatrixXcd H = S.inverse();
    EXPECT_LT(std::abs(fit.model_00[i] - H(3, 3)), 1e-9 * std::abs(H(3, 3)));
    EXPECT_LT(std::abs(fit.model_01[i] - H(3, 4)), 1e-9 * std::abs(H(3, 3)));
  }
  EXPECT_EQ(fit.system, "chain of 7");
  // H_00 L^|i - j| has a tridiagonal inverse; a neighbour but one that moves more is coupled directly.
  EXPECT_LT(fit.left_out, 1e-12);
  GroundCompliance farther = ground_of(c, 6);
  farther.H.col(2) *= 1.2;
  EXPECT_GT(calibrate_clm(farther, {.lowest = 2, .highest = 60, .foundations = 7}).left_out, 0.02);
}

TEST(ClmCalibration, OfManyFoundationsApproachesTheInfiniteChain) {
  const ClmFit fit = calibrate_clm(ground_of(soft, 39), {.lowest = 2, .highest = 60, .foundations = 40});
  // only the foundations at both ends differ, of 40
  expect_equal(fit.clm, soft, 0.1);
}

// Compliances that no chain has: those of a chain, disturbed.
GroundCompliance disturbed() {
  GroundCompliance ground = ground_of({1.0, 5.2e7, 4.3e5, 4e7, -1.05e5});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double size = 0.1 * std::abs(ground.H(0, 0));
  for (Index i = 0; i < ground.H.rows(); ++i)
    for (Index n = 0; n < 2; ++n)
      ground.H(i, n) += size * std::complex<double>(uniform(random), uniform(random));
  for (Index i = 0; i < ground.H.rows(); ++i)  // passive all the same
    ground.H(i, 0).imag(-std::abs(ground.H(i, 0).imag()));
  return ground;
}

/// The cost that is to be least, from its definition.
double cost(const GroundCompliance& ground, const Clm& clm) {
  double sum = 0;
  for (Index i = 0; i < ground.frequency.size(); ++i) {
    const ChainCompliance chain = compute_infinite_chain(chain_stiffness(clm, 2 * pi * ground.frequency[i]));
    sum += std::norm(chain.H_0n(0) - ground.H(i, 0)) + std::norm(chain.H_0n(1) - ground.H(i, 1));
  }
  return sum;
}

TEST(ClmCalibration, HasNoBetterPassiveNeighbour) {
  const GroundCompliance ground = disturbed();
  const ClmFit fit = calibrate_clm(ground, {.lowest = 2, .highest = 98});
  const double least = cost(ground, fit.clm);
  EXPECT_NEAR(std::sqrt(least / 49), std::hypot(fit.rms_00, fit.rms_01) * std::abs(ground.H(0, 0)),
              1e-9 * std::sqrt(least));
  // any other passive set, near or far
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int tried = 0;
  for (int i = 0; i < 4000; ++i) {
    const double size = std::pow(10, -4 * (i % 4) / 3.0);
    const auto change = [&](double value, double unit) { return value + size * unit * uniform(random); };
    const double k_f = change(fit.clm.k_f, 5e7), k_c = change(fit.clm.k_c, 4e7),
                 d_f = change(fit.clm.d_f, 4e5), d_c = change(fit.clm.d_c, 1e5),
                 m_f = change(fit.clm.m_f, 500);
    if (m_f < 0 || k_f <= 0 || k_f + 4 * k_c < 0 || d_f <= 0 || d_f + 4 * d_c < 0) continue;
    ++tried;
    EXPECT_GE(cost(ground, {m_f, k_f, d_f, k_c, d_c}), least * (1 - 1e-12));
  }
  EXPECT_GT(tried, 500);
}

TEST(ClmCalibration, StaysPassiveWhereTheGroundWouldNotHaveIt) {
  // A chain of negative mass follows this ground exactly, a passive one cannot: the best lies on that bound.
  const Clm impossible{-300.0, 5.2e7, 4.3e5, 2.4e7, -9e4};
  const GroundCompliance ground = ground_of(impossible);
  const ClmFit fit = calibrate_clm(ground, {.lowest = 2, .highest = 98});
  EXPECT_THAT(fit.bounds, ElementsAre("m_f = 0"));
  EXPECT_EQ(fit.clm.m_f, 0);
  const double least = cost(ground, fit.clm);
  EXPECT_LT(cost(ground, impossible), 1e-6 * least);
  for (const double factor : {0.99, 1.01}) {
    EXPECT_GT(cost(ground, {0.0, factor * fit.clm.k_f, fit.clm.d_f, fit.clm.k_c, fit.clm.d_c}), least);
    EXPECT_GT(cost(ground, {0.0, fit.clm.k_f, factor * fit.clm.d_f, fit.clm.k_c, fit.clm.d_c}), least);
    EXPECT_GT(cost(ground, {0.0, fit.clm.k_f, fit.clm.d_f, factor * fit.clm.k_c, fit.clm.d_c}), least);
    EXPECT_GT(cost(ground, {0.0, fit.clm.k_f, fit.clm.d_f, fit.clm.k_c, factor * fit.clm.d_c}), least);
  }
  EXPECT_GT(cost(ground, {20.0, fit.clm.k_f, fit.clm.d_f, fit.clm.k_c, fit.clm.d_c}), least);
  EXPECT_THAT(std::string(fit.clm.k_f.source), HasSubstr("infinite chain, 2-98 Hz, rms error"));
}

TEST(ClmCalibration, WeighsFrequencies) {
  const GroundCompliance ground = disturbed();
  ClmFitOptions options{.lowest = 2, .highest = 98};
  options.weight =
      (ground.frequency.array() < 30).select(Eigen::VectorXd::Ones(49), Eigen::VectorXd::Zero(49));
  const ClmFit weighted = calibrate_clm(ground, options);
  const ClmFit narrow = calibrate_clm(ground, {.lowest = 2, .highest = 29});
  expect_equal(weighted.clm, narrow.clm, 1e-5);
}

TEST(ClmCalibration, RefusesWhatIsNoGround) {
  const auto expect_refusal = [](auto change, const std::string& message) {
    GroundCompliance ground = ground_of(soft);
    ClmFitOptions options;
    change(ground, options);
    EXPECT_THAT([&] { calibrate_clm(ground, options); },
                ThrowsMessage<easydyn::ModelError>(HasSubstr(message)));
  };
  expect_refusal([](auto& ground, auto&) { ground.H = ground.H.conjugate().eval(); },
                 "compliance H_00 at a frequency of = 2 Hz, must be with an imaginary part <= 0");
  expect_refusal([](auto& ground, auto&) { ground.frequency[3] = 2; },
                 "frequency = 2 Hz, must be > 0 and ascending");
  expect_refusal([](auto&, auto& options) { options.highest = 1; }, "highest frequency = 1 Hz");
  expect_refusal([](auto&, auto& options) { options.foundations = 5; }, "columns of H = 2, must be >= 5");
  expect_refusal(
      [](auto&, auto& options) {
        options.lowest = 97;
        options.highest = 200;
      },
      "frequencies within the band = 1");
  expect_refusal([](auto& ground, auto&) { ground.H(7, 1) = std::nan(""); }, "at a frequency of = 16 Hz");
}

}  // namespace

#include "track/clm_chain.hpp"

#include <gtest/gtest.h>

#include <Eigen/SparseLU>
#include <cmath>

#include "easydyn/error.hpp"
#include "track/receptance.hpp"
#include "track/track_model.hpp"

namespace {

using namespace easydyn::track;
using Complex = std::complex<double>;

const Clm tram{605, 5.21e7, 4.28e5, 2.43e7, -9.3e4};
const Clm half_space{241, 7.06e7, 6.04e5, 4.64e7, -1.31e5};
constexpr double pi = 3.14159265358979323846;

/// Chain of 2 n + 1 foundations with a unit force in the middle, solved as a linear system.
Eigen::VectorXcd solve_chain(const ChainStiffness& c, int n) {
  std::vector<Eigen::Triplet<Complex>> triplets;
  for (int i = 0; i <= 2 * n; ++i) {
    triplets.emplace_back(i, i, c.K_f + (i == 0 || i == 2 * n ? 1.0 : 2.0) * c.K_c);
    if (i < 2 * n) {
      triplets.emplace_back(i, i + 1, -c.K_c);
      triplets.emplace_back(i + 1, i, -c.K_c);
    }
  }
  Eigen::SparseMatrix<Complex> A(2 * n + 1, 2 * n + 1);
  A.setFromTriplets(triplets.begin(), triplets.end());
  Eigen::VectorXcd f = Eigen::VectorXcd::Zero(2 * n + 1);
  f[n] = 1;
  return Eigen::SparseLU<Eigen::SparseMatrix<Complex>>(A).solve(f);
}

TEST(ClmChain, FollowsTheLatticeFormulaAtAllFrequencies) {
  for (const Clm& clm : {tram, half_space}) {
    for (const double f : {0.0, 1.0, 10.0, 30.0, 50.0, 100.0, 150.0, 300.0}) {
      const ChainStiffness stiffness = chain_stiffness(clm, 2 * pi * f);
      const ChainCompliance chain = compute_infinite_chain(stiffness);
      ASSERT_LT(std::abs(chain.L), 1);
      EXPECT_LT(std::abs(chain.L + 1.0 / chain.L - 2.0 - stiffness.K_f / stiffness.K_c) * std::abs(chain.L),
                1e-14);
      const int n = 400;  // |L|^400 < 1e-20: nothing returns from the ends
      const Eigen::VectorXcd u = solve_chain(stiffness, n);
      for (const int k : {0, 1, 2, 5, 10})
        EXPECT_LT(std::abs(u[n + k] - chain.H_0n(k)) / std::abs(chain.H_00), 1e-10) << f << " Hz, " << k;
    }
  }
}

TEST(ClmChain, TakesAnotherBranchThanThePrincipalRootAtHighFrequency) {
  // The naive root 1 + s - sqrt(s^2 + 2 s) leaves the unit circle at some frequencies: there L is its
  // inverse, and H_00 = 1 / (K_f + 2 K_c (1 - L)) after the balance of the loaded foundation follows.
  int inside = 0, outside = 0;
  for (double f = 10; f < 300; f += 10) {
    const ChainStiffness c = chain_stiffness(half_space, 2 * pi * f);
    const Complex s = 0.5 * c.K_f / c.K_c, naive = 1.0 + s - std::sqrt(s * s + 2.0 * s);
    const bool is_outside = std::abs(naive) > 1;
    ++(is_outside ? outside : inside);
    const ChainCompliance chain = compute_infinite_chain(c);
    const Complex L = is_outside ? 1.0 / naive : naive;
    // 1e-13: the naive difference loses one or two of sixteen digits
    EXPECT_LT(std::abs(chain.L - L), 1e-13) << f << " Hz";
    EXPECT_LT(std::abs(chain.H_00 * (c.K_f + 2.0 * c.K_c * (1.0 - L)) - 1.0), 1e-13) << f << " Hz";
  }
  EXPECT_GT(inside, 0);
  EXPECT_GT(outside, 0);
}

TEST(ClmChain, HasTheStaticDeflectionAndSumOfTheLattice) {
  const ChainCompliance chain = compute_infinite_chain(chain_stiffness(tram, 0));
  EXPECT_NEAR(chain.H_00.real() * std::sqrt(5.21e7 * 5.21e7 + 4 * 5.21e7 * 2.43e7), 1, 1e-14);
  EXPECT_NEAR(static_chain_compliance(tram) / chain.H_00.real(), 1, 1e-14);
  EXPECT_NEAR(solve_chain(chain_stiffness(tram, 0), 100).sum().real() * 5.21e7, 1, 1e-12);
}

TEST(ClmChain, OfTheAssembledTrackFollowsTheLatticeFormula) {
  // a ballast of almost no stiffness leaves the chain of foundations alone
  TrackData data = t2000_like_track();
  data.foundation = tram;
  data.ballast_stiffness = 1e-8;
  data.ballast_damping = 0;
  const TrackModel track(data, 400);
  Eigen::VectorXd load = Eigen::VectorXd::Zero(track.size());
  load[track.foundation_dof(200)] = 1;
  const std::vector<double> frequencies = {10, 45, 120};
  const Eigen::MatrixXcd q = compute_harmonic_response(track, load, frequencies);
  for (size_t i = 0; i < frequencies.size(); ++i) {
    const ChainCompliance chain = compute_infinite_chain(chain_stiffness(tram, 2 * pi * frequencies[i]));
    for (const int n : {0, 1, 3, -3})
      EXPECT_LT(std::abs(q(track.foundation_dof(200 + n), i) - chain.H_0n(n)) / std::abs(chain.H_00), 1e-10);
  }
}

TEST(ClmChain, InvertsToTheStiffnessesItCameFrom) {
  for (const double f : {0.0, 20.0, 80.0, 200.0}) {
    const ChainStiffness stiffness = chain_stiffness(tram, 2 * pi * f);
    const ChainCompliance chain = compute_infinite_chain(stiffness);
    const ChainStiffness back = invert_infinite_chain(chain.H_00, chain.H_0n(1));
    EXPECT_LT(std::abs(back.K_f - stiffness.K_f) / std::abs(stiffness.K_f), 1e-12);
    EXPECT_LT(std::abs(back.K_c - stiffness.K_c) / std::abs(stiffness.K_c), 1e-12);
  }
}

TEST(ClmChain, OfTwoFoundationsInvertsTheirCompliance) {
  const Complex K_f(5e7, 1e6), K_c(2e7, -3e5);
  // [K_f + K_c, -K_c; -K_c, K_f + K_c] inverted by hand
  const Complex det = K_f * (K_f + 2.0 * K_c), H_11 = (K_f + K_c) / det, H_12 = K_c / det;
  const ChainStiffness back = invert_two_foundations(H_11, H_12);
  EXPECT_LT(std::abs(back.K_f - K_f), 1e-6);
  EXPECT_LT(std::abs(back.K_c - K_c), 1e-6);
}

TEST(ClmChain, WithoutCouplingIsOneFoundation) {
  const ChainCompliance chain = compute_infinite_chain({Complex(5e7, 1e6), 0.0});
  EXPECT_EQ(chain.H_00, 1.0 / Complex(5e7, 1e6));
  EXPECT_EQ(chain.H_0n(1), 0.0);
  EXPECT_EQ(chain.H_0n(0), chain.H_00);
}

TEST(ClmChain, RefusesAnUndampedPassBandAndAGrowingCompliance) {
  EXPECT_THROW(compute_infinite_chain({Complex(-1e7, 0), Complex(1e7, 0)}), easydyn::ModelError);
  EXPECT_THROW(invert_infinite_chain(1e-8, 1.1e-8), easydyn::ModelError);
}

}  // namespace

#include "track/track_model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "easydyn/error.hpp"
#include "track/clm_chain.hpp"
#include "track/receptance.hpp"

namespace {

using namespace easydyn::track;

TrackData short_track(const Foundation& foundation) {
  TrackData data = t2000_like_track();
  data.ends.bays = 2;
  data.foundation = foundation;
  return data;
}

Foundation foundation_called(const std::string& kind) {
  if (kind == "rigid") return RigidGround{};
  if (kind == "winkler") return Winkler{5e7, 4e5};
  if (kind == "winkler_mass") return WinklerMass{600, 5e7, 4e5};
  return Clm{605, 5.21e7, 4.28e5, 2.43e7, -9.3e4};
}

class TrackModelOn : public testing::TestWithParam<std::string> {
 protected:
  const Foundation foundation = foundation_called(GetParam());
};

INSTANTIATE_TEST_SUITE_P(EachFoundation, TrackModelOn,
                         testing::Values("rigid", "winkler", "winkler_mass", "clm"),
                         [](const auto& test) { return test.param; });

TEST_P(TrackModelOn, HasSymmetricMatricesThatStoreAndDissipateEnergy) {
  const TrackModel track(short_track(foundation), 6);
  const Eigen::MatrixXd M = track.M(), C = track.C(), K = track.K();
  EXPECT_EQ(M, M.transpose());
  EXPECT_EQ(C, C.transpose());
  EXPECT_EQ(K, K.transpose());
  const auto lowest_pivot =
      [](const Eigen::MatrixXd& A) {  // of L D L^T: of the sign of the lowest eigenvalue
        return Eigen::LDLT<Eigen::MatrixXd>(A).vectorD().minCoeff();
      };
  EXPECT_GT(lowest_pivot(K), 0);
  EXPECT_GE(lowest_pivot(C), -1e-12 * C.norm());  // rounding only: dampers leave some motions free
  EXPECT_GE(lowest_pivot(M), -1e-12 * M.norm());
}

TEST_P(TrackModelOn, NumbersEveryUnknownOnceAndByBay) {
  const TrackModel track(short_track(foundation), 6);
  const bool rigid = is_rigid(foundation);
  std::set<int> used;
  for (int node = 0; node < track.nodes(); ++node) {
    used.insert(track.rail_dof(node));
    used.insert(track.rail_dof(node) + 1);
  }
  for (int j = 0; j < track.sleepers(); ++j) {
    used.insert(track.sleeper_dof(j));
    if (!rigid) used.insert(track.foundation_dof(j));
    EXPECT_EQ(track.foundation_dof(j) < 0, rigid);
  }
  EXPECT_EQ(int(used.size()), track.size());
  EXPECT_EQ(*used.begin(), 0);
  EXPECT_EQ(*used.rbegin(), track.size() - 1);
  // 4 elements per bay: foundations 10 apart; without coupling two successive rail nodes with a sleeper
  // between
  EXPECT_EQ(track.half_bandwidth(), GetParam() == "clm" ? 10 : rigid ? 4 : 5);
}

TEST_P(TrackModelOn, WeighsItsParts) {
  const TrackModel track(short_track(foundation), 6);
  Eigen::VectorXd heave = Eigen::VectorXd::Zero(track.size());
  for (int node = 0; node < track.nodes(); ++node) heave[track.rail_dof(node)] = 1;
  for (int j = 0; j < track.sleepers(); ++j) heave[track.sleeper_dof(j)] = 1;
  for (int j = 0; j < track.sleepers() && !is_rigid(foundation); ++j) heave[track.foundation_dof(j)] = 1;
  const double mass = 6 * 0.72 * 2 * 49.97 + 7 * (180 + as_clm(foundation).m_f);
  EXPECT_NEAR(heave.dot(track.M() * heave) / mass, 1, 1e-13);
}

TEST_P(TrackModelOn, CarriesAStaticLoadByItsBallast) {
  const TrackModel track(short_track(foundation), 40, -10);
  const Eigen::VectorXd q = compute_static_response(track, track.rail_load(2.345, 1e5));
  const Eigen::VectorXd reactions = track.ballast_reactions(q, Eigen::VectorXd::Zero(track.size()));
  EXPECT_NEAR(reactions.sum() / 1e5, 1, 1e-11);
  double moment = 0;
  for (int j = 0; j < track.sleepers(); ++j) moment += reactions[j] * track.sleeper_x(j);
  EXPECT_NEAR(moment / 1e5, 2.345, 1e-9);  // moment equilibrium of rail and sleepers
}

TEST(TrackModel, GivesTheDeflectionBetweenTheNodes) {
  const TrackModel track(short_track(RigidGround{}), 8, 3);
  Eigen::VectorXd q = Eigen::VectorXd::Zero(track.size());
  const auto w = [](double x) { return 0.1 * x * x - 0.02 * x * x * x; };
  for (int node = 0; node < track.nodes(); ++node) {
    const double x = track.node_x(node);
    q[track.rail_dof(node)] = w(x);
    q[track.rail_dof(node) + 1] = 0.2 * x - 0.06 * x * x;
  }
  for (const double x : {3.0, 3.1, 4.44, 7.0, track.end()}) {
    const RailPoint point = track.rail_point(x);
    EXPECT_NEAR(point.deflection(q), w(x), 1e-12);
    EXPECT_NEAR(point.slope(q), 0.2 * x - 0.06 * x * x, 1e-12);
    EXPECT_NEAR(point.curvature(q), 0.2 - 0.12 * x, 1e-10);
  }
  EXPECT_THAT([&] { track.rail_point(2.9); },
              testing::ThrowsMessage<easydyn::ModelError>(
                  "track \"t2000-like\": x on the rail = 2.9 m, must be between 3 and 8.76"));
  EXPECT_THROW(track.rail_point(std::nan("")), easydyn::ModelError);
}

TEST(TrackModel, AssemblesTheChainOfTheCoupledLumpedMassModel) {
  const Clm clm{605, 5.21e7, 4.28e5, 2.43e7, -9.3e4};
  const TrackModel track(short_track(clm), 6);
  for (int j = 0; j < track.sleepers(); ++j) {
    const int i = track.foundation_dof(j), neighbours = j == 0 || j == 6 ? 1 : 2;
    EXPECT_DOUBLE_EQ(track.K().coeff(i, i), 5.21e7 + neighbours * 2.43e7 + 5e7);
    EXPECT_DOUBLE_EQ(track.C().coeff(i, i), 4.28e5 - neighbours * 9.3e4 + 8e4);
    EXPECT_DOUBLE_EQ(track.M().coeff(i, i), 605);
    if (j == 6) continue;
    EXPECT_DOUBLE_EQ(track.K().coeff(i, track.foundation_dof(j + 1)), -2.43e7);
    EXPECT_DOUBLE_EQ(track.C().coeff(i, track.foundation_dof(j + 1)), 9.3e4);
  }
}

TEST(TrackModel, RefusesTooFewBays) {
  EXPECT_THAT([] { TrackModel(t2000_like_track(), 30); },
              testing::ThrowsMessage<easydyn::ModelError>(
                  "track \"t2000-like\": bays = 30, must be >= 40, two absorbing ends"));
}

TEST(RailReceptance, IsReciprocal) {
  const TrackModel track(short_track(Clm{605, 5.21e7, 4.28e5, 2.43e7, -9.3e4}), 40);
  const std::vector<double> f = {5, 50, 300};
  const Eigen::VectorXcd ab = compute_rail_receptance(track, 8.1, 14.37, f),
                         ba = compute_rail_receptance(track, 14.37, 8.1, f);
  EXPECT_LT((ab - ba).norm() / ab.norm(), 1e-10);
}

}  // namespace

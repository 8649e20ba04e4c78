#include "soil/load_history.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "easydyn/error.hpp"

namespace easydyn::soil {
namespace {

SurfaceLoads sine(double offset) {
  SurfaceLoads loads;
  loads.footprints = {{0, 0, 1, 1}};
  loads.time = Eigen::VectorXd::LinSpaced(1001, 2.0, 3.0);
  loads.force.resize(1001, 1);
  for (int i = 0; i < 1001; ++i) loads.force(i, 0) = offset + std::sin(2 * M_PI * 50 * loads.time(i));
  return loads;
}

TEST(LoadHistory, InterpolatesSmoothlyBetweenTheSamples) {
  const LoadHistory history(sine(0), 0.5);
  Eigen::VectorXd force;
  for (double t = 2.1; t < 2.9; t += 0.000137) {  // 50 Hz in steps of 1 ms: (omega h)^4 / 384 = 2.5e-5
    history.update_forces(t, force);
    EXPECT_NEAR(force(0), std::sin(2 * M_PI * 50 * t), 3e-5);
  }
}

TEST(LoadHistory, BringsTheFirstForceInAndHoldsTheLast) {
  const LoadHistory history(sine(3), 0.5);
  Eigen::VectorXd force;
  history.update_forces(1.4, force);
  EXPECT_EQ(force(0), 0);
  history.update_forces(1.75, force);
  EXPECT_NEAR(force(0), 1.5, 1e-9);  // half of sin(200 pi) + 3
  history.update_forces(9, force);
  EXPECT_NEAR(force(0), 3, 1e-9);
}

TEST(Taper, FadesTheLoadsOutAtBothEnds) {
  std::vector<Footprint> track;
  for (int i = -20; i <= 20; ++i) track.push_back({i * 0.5, 0, 0.3, 2.5});
  const Eigen::VectorXd taper = compute_taper(track, 4);
  EXPECT_EQ(taper(0), 0);
  EXPECT_NEAR(taper(4), 0.5, 1e-12);  // 2 m from the end
  EXPECT_EQ(taper(8), 1);
  EXPECT_EQ(taper(20), 1);
  EXPECT_NEAR(taper(40), 0, 1e-15);
  EXPECT_THROW(compute_taper(track, 11), ModelError);
  EXPECT_EQ(compute_taper({{1, 0, 1, 1}, {1, 2, 1, 1}}, 4), Eigen::VectorXd::Ones(2));
}

TEST(Taper, LeavesWhatStandsBesideTheTrackAlone) {
  std::vector<Footprint> track;
  for (int i = -20; i <= 20; ++i) track.push_back({i * 0.5, 0, 0.3, 2.5});
  const Eigen::VectorXd alone = compute_taper(track, 4);
  track.push_back({.x = 30, .y = 6, .length = 1, .width = 1, .source = 1});
  const Eigen::VectorXd taper = compute_taper(track, 4);
  EXPECT_EQ(taper.head(41), alone);
  EXPECT_EQ(taper(41), 1);
}

}  // namespace
}  // namespace easydyn::soil

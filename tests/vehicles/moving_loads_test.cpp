#include "vehicles/moving_loads.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "easydyn/easydyn.hpp"
#include "track/flexible_track.hpp"
#include "vehicles/axle_loads.hpp"
#include "vehicles/t2000_like.hpp"
#include "vehicles/thalys_like.hpp"

namespace {

using namespace easydyn;
using namespace easydyn::vehicles;

TEST(MovingLoads, OfTheX2000AreThoseOfLedsgard) {
  const MovingLoads train = x2000_ledsgard();
  ASSERT_EQ(train.loads.size(), 20u);
  // by hand: 2 x 181 + 2 x 180 + 12 x 122 + 2 x 117 + 2 x 160 kN; 10 x 2.9 + 6.6 + 4 x 4.1 + 3 x 14.8 + 11.6 m
  EXPECT_NEAR(train.total(), 2740e3, 1e-6);
  EXPECT_NEAR(train.length(), 108.0, 1e-12);
  EXPECT_NEAR(train.loads.front().x, 54.0, 1e-12);
  EXPECT_NEAR(train.loads.back().x, -54.0, 1e-12);
  EXPECT_NEAR(train.loads[1].x - train.loads[2].x, 6.6, 1e-12);  // between the bogies of the power car
  EXPECT_EQ(train.loads[2].load, 180e3);
  EXPECT_EQ(train.loads[15].load, 122e3);
  EXPECT_EQ(train.loads[16].load, 117e3);
  for (const Parameter& p : parameters(train)) EXPECT_THAT(p.source, testing::StartsWith("F: ")) << p.name;
}

TEST(MovingLoads, OfAVehicleAreItsAxleLoadsAtTheirPlaces) {
  const MovingLoads train = moving_loads(thalys_like());
  const AxleLoads statics = compute_axle_loads(thalys_like());
  ASSERT_EQ(train.loads.size(), 26u);
  EXPECT_EQ(train.name, "thalys-like");
  EXPECT_EQ(train.loads[6].name, "axle 7");
  EXPECT_EQ(train.loads[6].load, statics.wheel_pairs[3][0].axle_load);
  EXPECT_EQ(train.loads[6].x, statics.wheel_pairs[3][0].x);
  EXPECT_NEAR(train.total() / (427e3 * 9.81), 1, 1e-12);
  EXPECT_NEAR(train.length(), 200.18 - 2 * (4.075 - 1.50), 1e-9);  // overhang less half of the wheelbase
}

// Moving loads on a track: port forces on the rail, no wheel between.
TEST(MovingLoads, AtRestOnATrackAreBorneByTheBallast) {
  class LoadsOnTrack : public System {
   public:
    MovingLoads train = moving_loads(t2000_like());
    track::FlexibleTrack rail{*this, track::TrackModel(track::t2000_like_track(), 101, -50.5 * 0.72)};
    void positions() override {}
    void forces() override {
      for (const MovingLoad& load : train.loads) rail.touch_rail(0.31 + load.x).add_force(load.load);
    }
  } system;
  const State s = solve_static_equilibrium(system);
  const Eigen::VectorXd q = system.rail.coordinates(s.q);
  // relative rounding of the banded solution
  EXPECT_NEAR(system.rail.model().ballast_reactions(q, 0 * q).sum() / system.train.total(), 1, 1e-10);
}

}  // namespace

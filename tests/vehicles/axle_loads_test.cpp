#include "vehicles/axle_loads.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "easydyn/error.hpp"
#include "vehicles/t2000_like.hpp"

namespace {

using namespace easydyn::vehicles;

const double g = 9.81;

/// The tram's statics by hand, after Castigliano. By symmetry the only redundant force is the hinge force H,
/// which the centre body exerts upward on each end body. Everything else follows from equilibrium:
struct HandStatics {
  double H;
  // end body: weight 9 t at 6.9 m, hinge at 2.4 m, two secondary points at 8.7 and 7.7 m
  double S() const { return 9000 * g - H; }
  double moment() const { return (2.4 - 8.2) * H - (6.9 - 8.2) * 9000 * g; }  // of H and weight about 8.2 m
  double S_outer() const { return 0.5 * S() - moment() / (2 * 0.5); }
  double S_inner() const { return 0.5 * S() + moment() / (2 * 0.5); }
  // end frame: weight 1.8 t at 7.86 m, primaries at 8.71 and 7.01 m
  double P_driven() const {
    return (S_outer() * (8.7 - 7.01) + S_inner() * (7.7 - 7.01) + 1800 * g * (7.86 - 7.01)) / 1.7;
  }
  double P_trailing() const { return S() + 1800 * g - P_driven(); }
  // centre body and frame
  double S_centre() const { return 8000 * g + 2 * H; }
  double P_centre() const { return 0.5 * (S_centre() + 1800 * g); }
  // resilient wheels carry the hub too
  double R_driven() const { return P_driven() + 900 * g; }
  double R_trailing() const { return P_trailing() + 270 * g; }
  double R_centre() const { return P_centre() + 900 * g; }

  /// Complementary energy of all springs [J].
  double energy() const {
    const auto spring = [](double force, double k) { return force * force / (2 * k); };
    const double end = spring(S_outer(), 0.48e6) + spring(S_inner(), 0.48e6) + spring(P_driven(), 44e6) +
                       spring(P_trailing(), 44e6) + spring(R_driven(), 145e6) + spring(R_trailing(), 145e6);
    const double centre =
        2 * (spring(0.5 * S_centre(), 0.48e6) + spring(P_centre(), 44e6) + spring(R_centre(), 145e6));
    return 2 * end + centre;
  }
};

/// The hinge force of least complementary energy: the vertex of a parabola through three points.
HandStatics solve_by_hand() {
  const double step = 1e4;
  const double minus = HandStatics{-step}.energy(), zero = HandStatics{0}.energy(),
               plus = HandStatics{step}.energy();
  return {-step * (plus - minus) / (2 * (plus - 2 * zero + minus))};
}

TEST(AxleLoads, OfTheTramAgreeWithCastiglianosTheorem) {
  const HandStatics hand = solve_by_hand();
  const AxleLoads loads = compute_axle_loads(t2000_like());
  const double tight = 1e-10;  // both are linear solutions in double precision
  EXPECT_NEAR(loads.hinge[0] / hand.H, 1, tight);
  EXPECT_NEAR(loads.hinge[1] / -hand.H, 1, tight);  // there the centre body is the front one
  EXPECT_NEAR(loads.secondary[0][0] / hand.S_outer(), 1, tight);
  EXPECT_NEAR(loads.secondary[0][1] / hand.S_inner(), 1, tight);
  EXPECT_NEAR(loads.secondary[1][0] / (0.5 * hand.S_centre()), 1, tight);
  EXPECT_NEAR(loads.wheel_pairs[0][0].primary / hand.P_driven(), 1, tight);
  EXPECT_NEAR(loads.wheel_pairs[0][1].primary / hand.P_trailing(), 1, tight);
  EXPECT_NEAR(loads.wheel_pairs[0][1].resilient / hand.R_trailing(), 1, tight);
  EXPECT_NEAR(loads.wheel_pairs[1][0].axle_load / (hand.P_centre() + 1100 * g), 1, tight);
}

TEST(AxleLoads, OfTheTramAreTheQuotedOnes) {
  const AxleLoads loads = compute_axle_loads(t2000_like());
  // quoted to three digits with the data: 10.3 t, 16.0 t, 66 : 34
  EXPECT_NEAR(loads.gear_load(0) / g, 10.3e3, 60);
  EXPECT_NEAR(loads.gear_load(1) / g, 16.0e3, 60);
  EXPECT_NEAR(loads.wheel_pairs[0][0].axle_load / loads.gear_load(0), 0.66, 0.006);
}

TEST(AxleLoads, BalanceWeightMomentAndSymmetry) {
  const RailVehicle tram = t2000_like();
  const AxleLoads loads = compute_axle_loads(tram);
  EXPECT_NEAR(loads.total() / (36.5e3 * g), 1, 1e-12);
  double moment = 0;
  for (const auto& gear : loads.wheel_pairs)
    for (const WheelPairLoad& pair : gear) moment += pair.x * pair.axle_load;
  EXPECT_NEAR(moment / (36.5e3 * g * 10), 0, 1e-12);
  EXPECT_NEAR(loads.wheel_pairs[0][0].axle_load / loads.wheel_pairs[2][1].axle_load, 1, 1e-12);
}

TEST(AxleLoads, OfAnUnsymmetricVehicleBalanceTheMomentOfItsWeight) {
  RailVehicle tram = t2000_like();
  tram.bodies[0].mass = 12e3;
  tram.gears[2].wheel_pairs[0].resilient.reset();
  const AxleLoads loads = compute_axle_loads(tram);
  double moment = 0, of_weight = 0;
  for (const auto& gear : loads.wheel_pairs)
    for (const WheelPairLoad& pair : gear) moment += pair.x * pair.axle_load;
  for (const CarBody& body : tram.bodies) of_weight += g * body.mass * body.x;
  for (const RunningGear& gear : tram.gears) {
    of_weight += g * gear.frame_mass * gear.x;
    for (const WheelPair& pair : gear.wheel_pairs) of_weight += g * pair.mass * pair.x;
  }
  EXPECT_NEAR(moment / of_weight, 1, 1e-11);
  EXPECT_NEAR(loads.total() / tram.weight(), 1, 1e-12);
  EXPECT_EQ(loads.wheel_pairs[2][0].resilient, 0);
}

TEST(AxleLoads, RefuseATramWithOneSecondaryPointPerGear) {
  RailVehicle tram = t2000_like();
  for (RunningGear& gear : tram.gears) {
    gear.secondaries.pop_back();
    gear.secondaries[0].x = gear.pivot_x;
  }
  EXPECT_THAT([&] { compute_axle_loads(tram); },
              testing::ThrowsMessage<easydyn::ModelError>(testing::HasSubstr("a motion without stiffness")));
}

}  // namespace

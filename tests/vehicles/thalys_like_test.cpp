#include "vehicles/thalys_like.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "vehicles/axle_loads.hpp"
#include "vehicles/vehicle_modes.hpp"
#include "vehicles/vehicle_tables.hpp"

namespace {

using namespace easydyn::vehicles;

const double g = 9.81;

/// Axle masses of the front half, axles 1 to 13, and by symmetry of the rear half. M-h: Degrande & Schillemans 2001;
/// 15.75 t: 14.5 t and 17 t of the two cars that share the bogie.
double axle_mass(int number) {
  const int from_end = number <= 13 ? number : 27 - number;
  if (from_end <= 4) return 17000;  // traction car
  if (from_end <= 6) return 14500;  // own bogie of the end carriage
  if (from_end <= 8) return 15750;  // first Jacobs bogie
  return 17000;
}

std::vector<WheelPairLoad> axles(const AxleLoads& loads) {
  std::vector<WheelPairLoad> all;
  for (const auto& gear : loads.wheel_pairs) all.insert(all.end(), gear.begin(), gear.end());
  return all;
}

TEST(ThalysLike, HasTheAxleLoadsOfItsSourceOnAll26Axles) {
  const std::vector<WheelPairLoad> all = axles(compute_axle_loads(thalys_like()));
  ASSERT_EQ(all.size(), 26u);
  for (int i = 0; i < 26; ++i) {
    const WheelPairLoad& axle = all[static_cast<size_t>(i)];
    EXPECT_EQ(axle.name, "axle " + std::to_string(i + 1));
    // linear solution in double precision of springs that differ by 10 and lengths of 100 m
    EXPECT_NEAR(axle.axle_load / (g * axle_mass(i + 1)), 1, 1e-9) << axle.name;
  }
}

TEST(ThalysLike, HasTheCompositionOfItsSource) {
  const RailVehicle train = thalys_like();
  EXPECT_NEAR(train.length, 200.18, 1e-9);  // C: 2 x 22.15 + 2 x 21.84 + 6 x 18.70
  ASSERT_EQ(train.bodies.size(), 10u);
  ASSERT_EQ(train.gears.size(), 13u);
  EXPECT_EQ(train.wheel_pair_count(), 26);
  EXPECT_TRUE(train.hinges.empty());
  double front = 100.09;
  for (size_t i = 0; i < 10; ++i) {  // bodies end to end
    const CarBody& body = train.bodies[i];
    EXPECT_NEAR(body.x + body.middle_offset + body.length / 2, front, 1e-9) << body.name;
    front -= body.length;
  }
  EXPECT_NEAR(front, -100.09, 1e-9);
  // distances of the bogies, front to rear: traction car 14.00; overhangs 4.075 + 3.14; then 18.70
  const double distances[] = {14.00, 7.215, 18.70, 18.70, 18.70, 18.70,
                              18.70, 18.70, 18.70, 18.70, 7.215, 14.00};
  for (size_t i = 0; i < 12; ++i)
    EXPECT_NEAR(train.gears[i].x - train.gears[i + 1].x, distances[i], 1e-9) << i;
  int jacobs = 0;
  for (const RunningGear& gear : train.gears) {
    ASSERT_EQ(gear.wheel_pairs.size(), 2u);
    EXPECT_NEAR(gear.wheel_pairs[0].x - gear.wheel_pairs[1].x, 3.00, 1e-12);
    double stiffness = 0, damping = 0;
    for (const SecondarySuspension& s : gear.secondaries) {
      stiffness += s.stiffness;
      damping += s.damping;
    }
    if (gear.secondaries.size() < 2) continue;
    ++jacobs;
    EXPECT_NEAR(stiffness, 0.58e6, 1e-6);  // F: Eurostar set, of the whole bogie
    EXPECT_NEAR(damping, 20e3, 1e-8);
    EXPECT_EQ(gear.frame_mass, 2900);
    EXPECT_EQ(gear.frame_pitch_inertia, 2508);
    EXPECT_EQ(gear.wheel_pairs[0].primary_stiffness, 2.00e6);
  }
  EXPECT_EQ(jacobs, 7);
  EXPECT_EQ(train.gears[0].secondaries[0].stiffness, 3.26e6);
  EXPECT_EQ(train.gears[0].secondaries[0].damping, 90e3);
  EXPECT_EQ(train.gears[2].secondaries[0].stiffness, 0.6e6);
  EXPECT_EQ(train.gears[2].wheel_pairs[0].primary_stiffness, 2.60e6);
}

TEST(ThalysLike, HasTheBodyMassesThatMatchItsAxleLoads) {
  const RailVehicle train = thalys_like();
  // by hand: 4 x 17 000 - 2 x 2200 - 4 x 2027; 3 x 14 500 - 2200 - 1450 - 3 x 2027; 2 x 17 000 - 2900 - 2 x 2027
  EXPECT_NEAR(train.bodies[0].mass, 55492, 1e-9);
  EXPECT_NEAR(train.bodies[1].mass, 33769, 1e-9);
  for (size_t i = 2; i < 8; ++i) EXPECT_NEAR(train.bodies[i].mass, 27046, 1e-9);
  EXPECT_NEAR(train.gears[2].x - train.bodies[1].x, 6.10, 0.005);  // C: 18.70 x 11 023 / 33 769
  const AxleLoads loads = compute_axle_loads(train);
  EXPECT_NEAR(loads.secondary[2][0] / g, 22746, 1e-3);  // on the own bogie of the end carriage
  EXPECT_NEAR(loads.secondary[3][0] / g, 11023, 1e-3);  // on the first Jacobs bogie
  EXPECT_NEAR(loads.secondary[3][1] / g, 13523, 1e-3);  // half of the first central carriage
}

TEST(ThalysLike, BalancesItsMassAndItsMoment) {
  const RailVehicle train = thalys_like();
  const MassBalance balance = compute_mass_balance(train);
  EXPECT_EQ(balance.body_count, 10);
  EXPECT_EQ(balance.frame_count, 13);
  EXPECT_EQ(balance.wheel_pair_count, 26);
  EXPECT_NEAR(balance.frames, 6 * 2200 + 7 * 2900, 1e-9);
  EXPECT_NEAR(balance.wheel_pairs, 26 * 2027, 1e-9);
  double axle_masses = 0;
  for (int i = 1; i <= 26; ++i) axle_masses += axle_mass(i);
  EXPECT_NEAR(balance.total(), axle_masses, 1e-6);
  EXPECT_NEAR(balance.total(), 427e3, 1e-6);  // 2 x (4 x 17 + 2 x 14.5 + 2 x 15.75 + 5 x 17) t
  double moment = 0;
  for (const WheelPairLoad& axle : axles(compute_axle_loads(train))) moment += axle.x * axle.axle_load;
  EXPECT_NEAR(moment / (train.weight() * 100), 0, 1e-12);
}

TEST(ThalysLike, IsSymmetricFrontToRear) {
  const RailVehicle train = thalys_like();
  for (size_t i = 0; i < 10; ++i) {
    const CarBody &body = train.bodies[i], &other = train.bodies[9 - i];
    EXPECT_NEAR(body.x, -other.x, 1e-12);
    EXPECT_EQ(body.mass, other.mass);
    EXPECT_EQ(body.pitch_inertia, other.pitch_inertia);
    EXPECT_NEAR(body.middle_offset, -other.middle_offset, 1e-12);
  }
  for (size_t i = 0; i < 13; ++i) {
    const RunningGear &gear = train.gears[i], &other = train.gears[12 - i];
    EXPECT_NEAR(gear.x, -other.x, 1e-12);
    EXPECT_EQ(gear.frame_mass, other.frame_mass);
    EXPECT_EQ(gear.secondaries.size(), other.secondaries.size());
    EXPECT_EQ(gear.secondaries[0].stiffness, other.secondaries[0].stiffness);
    EXPECT_NEAR(gear.wheel_pairs[0].x, -other.wheel_pairs[1].x, 1e-12);
  }
}

// Why both bodies of a Jacobs bogie rest at its centre.
TEST(ThalysLike, WouldPartTheAxleLoadsOfTheFirstJacobsBogieByHalfSharesOffItsCentre) {
  RailVehicle train = thalys_like();
  const double d = 0.5;
  for (RunningGear& gear : train.gears)
    if (gear.secondaries.size() == 2) {
      gear.secondaries[0].x = gear.x + d;
      gear.secondaries[1].x = gear.x - d;
    }
  const AxleLoads loads = compute_axle_loads(train);
  // by hand: central carriages bear half each at either end. The end carriage turns about its own bogie, 6.1041 m
  // behind which its mass acts; its other support comes nearer by d and bears 11 023 kg x 18.70 / (18.70 - d).
  const double end = 11023 * 18.70 / (18.70 - d), central = 13523;
  EXPECT_NEAR(loads.secondary[3][0] / (g * end), 1, 1e-9);
  EXPECT_NEAR(loads.secondary[3][1] / (g * central), 1, 1e-9);
  const double parted = loads.wheel_pairs[3][1].axle_load - loads.wheel_pairs[3][0].axle_load;
  EXPECT_NEAR(parted / (g * 2 * d * (central - end) / 3.00), 1, 1e-8);
  EXPECT_GT(parted, 6e3);  // 7.2 kN of 154.5 kN
}

TEST(ThalysLike, StatesASourceForEveryValue) {
  for (const easydyn::Parameter& p : parameters(thalys_like()))
    EXPECT_THAT(p.source, testing::MatchesRegex("(F|C|D|M-[hml]): .+")) << p.name;
}

// By its source the traction car's body is short of pitch inertia: its radius of gyration is 4.35 m, of a uniform one
// 22.15 m / sqrt(12) = 6.39 m. On bogies at 7.00 m it pitches 7.00 / 4.35 times as fast as it bounces (1.35 Hz).
TEST(ThalysLike, HasNothingUnusualThoughItsTractionCarsPitchFast) {
  EXPECT_THAT(unusual_values(thalys_like()), testing::IsEmpty());
  const std::vector<VehicleMode> modes = compute_vehicle_modes(thalys_like());
  const auto pitch = std::ranges::find(modes, "car 1 body and car 10 body, pitch", &VehicleMode::motion);
  ASSERT_NE(pitch, modes.end());
  EXPECT_NEAR(pitch->frequency, 2.17, 0.005);
}

}  // namespace

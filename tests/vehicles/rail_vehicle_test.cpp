#include "vehicles/rail_vehicle.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "easydyn/error.hpp"
#include "vehicles/t2000_like.hpp"

namespace {

using namespace easydyn::vehicles;
using easydyn::ModelError;
using testing::HasSubstr;
using testing::ThrowsMessage;

template <class Change>
auto validating_tram_with(Change change) {
  return [change] {
    RailVehicle tram = t2000_like();
    change(tram);
    validate(tram);
  };
}

void expect_body(const CarBody& body, const char* name, double mass, double pitch_inertia, double x,
                 double length) {
  EXPECT_EQ(body.name, name);
  EXPECT_DOUBLE_EQ(body.mass, mass) << name;
  EXPECT_DOUBLE_EQ(body.pitch_inertia, pitch_inertia) << name;
  EXPECT_DOUBLE_EQ(body.x, x) << name;
  EXPECT_DOUBLE_EQ(body.length, length) << name;
}

void expect_hinge(const Hinge& hinge, const char* front, const char* rear, double x) {
  EXPECT_EQ(hinge.front_body, front);
  EXPECT_EQ(hinge.rear_body, rear);
  EXPECT_DOUBLE_EQ(hinge.x, x);
}

/// Frame and secondary suspension, the same in all gears but for the places.
void expect_gear(const RunningGear& gear, const char* name, const char* body, double x, double pivot_x) {
  EXPECT_EQ(gear.name, name);
  EXPECT_DOUBLE_EQ(gear.frame_mass, 1800) << name;          // D
  EXPECT_DOUBLE_EQ(gear.frame_pitch_inertia, 8e2) << name;  // D
  EXPECT_DOUBLE_EQ(gear.x, x) << name;
  EXPECT_DOUBLE_EQ(gear.pivot_x, pivot_x) << name;
  // two points 0.5 m either side of the pivot (D), together 0.96 MN/m and 56 kNs/m (M-l)
  ASSERT_EQ(gear.secondaries.size(), 2u) << name;
  EXPECT_DOUBLE_EQ(gear.secondaries[0].x, pivot_x + 0.5) << name;
  EXPECT_DOUBLE_EQ(gear.secondaries[1].x, pivot_x - 0.5) << name;
  for (const SecondarySuspension& s : gear.secondaries) {
    EXPECT_EQ(s.body, body) << name;
    EXPECT_DOUBLE_EQ(s.stiffness, 0.48e6) << name;
    EXPECT_DOUBLE_EQ(s.damping, 28e3) << name;
  }
}

void expect_pair(const WheelPair& pair, const char* name, double x, bool is_driven) {
  EXPECT_EQ(pair.name, name);
  EXPECT_DOUBLE_EQ(pair.x, x) << name;
  EXPECT_DOUBLE_EQ(pair.radius, is_driven ? 0.640 / 2 : 0.375 / 2) << name;  // F: Wikipedia
  EXPECT_DOUBLE_EQ(pair.mass, is_driven ? 1100 : 350) << name;               // D
  EXPECT_EQ(pair.contacts, 2) << name;
  // rubber primary, per wheel pair: 44 MN/m, 18 kNs/m (M-l)
  EXPECT_DOUBLE_EQ(pair.primary_stiffness, 44e6) << name;
  EXPECT_DOUBLE_EQ(pair.primary_damping, 18e3) << name;
  // resilient wheel, per wheel pair: 145 MN/m, 3 kNs/m (M-l), tyres 0.20 t and 0.08 t (D)
  ASSERT_TRUE(pair.resilient) << name;
  EXPECT_DOUBLE_EQ(pair.resilient->tyre_mass, is_driven ? 200 : 80) << name;
  EXPECT_DOUBLE_EQ(pair.resilient->stiffness, 145e6) << name;
  EXPECT_DOUBLE_EQ(pair.resilient->damping, 3e3) << name;
}

// Whole vehicle, left and right together; equal but for the rounding of the unit factors. Geometry: D, inside
// the length of 22.80 m (F: Wikipedia); wheelbase 1.70 m and wheel order big-small / big-big / small-big (F).
TEST(T2000Like, HoldsTheValuesOfItsDataSheet) {
  const RailVehicle tram = t2000_like();
  EXPECT_EQ(tram.name, "t2000-like");
  EXPECT_DOUBLE_EQ(tram.length, 22.80);
  // masses D, inertias m L^2 / 12 (D)
  ASSERT_EQ(tram.bodies.size(), 3u);
  expect_body(tram.bodies[0], "front body", 9000, 6.1e4, 6.9, 9.0);
  expect_body(tram.bodies[1], "centre body", 8000, 1.5e4, 0, 4.8);
  expect_body(tram.bodies[2], "rear body", 9000, 6.1e4, -6.9, 9.0);
  ASSERT_EQ(tram.hinges.size(), 2u);
  expect_hinge(tram.hinges[0], "front body", "centre body", 2.4);
  expect_hinge(tram.hinges[1], "centre body", "rear body", -2.4);
  ASSERT_EQ(tram.gears.size(), 3u);
  expect_gear(tram.gears[0], "front gear", "front body", 7.86, 8.2);
  expect_gear(tram.gears[1], "centre gear", "centre body", 0, 0);
  expect_gear(tram.gears[2], "rear gear", "rear body", -7.86, -8.2);
  for (const RunningGear& gear : tram.gears) ASSERT_EQ(gear.wheel_pairs.size(), 2u);
  expect_pair(tram.gears[0].wheel_pairs[0], "front gear, driven", 8.71, true);
  expect_pair(tram.gears[0].wheel_pairs[1], "front gear, trailing", 7.01, false);
  expect_pair(tram.gears[1].wheel_pairs[0], "centre gear, front", 0.85, true);
  expect_pair(tram.gears[1].wheel_pairs[1], "centre gear, rear", -0.85, true);
  expect_pair(tram.gears[2].wheel_pairs[0], "rear gear, trailing", -7.01, false);
  expect_pair(tram.gears[2].wheel_pairs[1], "rear gear, driven", -8.71, true);
}

TEST(T2000Like, Weighs36point5Tonnes) {
  const RailVehicle tram = t2000_like();
  // 2 x 9.0 + 8.0 + 3 x 1.8 + 4 x 1.1 + 2 x 0.35
  EXPECT_NEAR(tram.mass(), 36.5e3, 1e-9);
  EXPECT_GT(tram.mass(), 35.7e3);  // highest tare that the sources give
  EXPECT_EQ(tram.wheel_pair_count(), 6);
}

TEST(T2000Like, IsSymmetricFrontToRearWithAWheelbaseOf1point7Metres) {
  const RailVehicle tram = t2000_like();
  const RunningGear &front = tram.gears[0], &rear = tram.gears[2];
  EXPECT_NEAR(front.wheel_pairs[0].x - front.wheel_pairs[1].x, 1.7, 1e-12);
  EXPECT_NEAR(front.wheel_pairs[0].x, -rear.wheel_pairs[1].x, 1e-12);
  EXPECT_NEAR(front.x, 0.5 * (front.wheel_pairs[0].x + front.wheel_pairs[1].x), 1e-12);
  EXPECT_EQ(front.wheel_pairs[0].radius, 0.320);
  EXPECT_EQ(front.wheel_pairs[1].radius, 0.1875);
}

TEST(T2000Like, StatesASourceForEveryValueAndHasNothingUnusual) {
  const RailVehicle tram = t2000_like();
  EXPECT_NO_THROW(validate(tram));
  EXPECT_THAT(unusual_values(tram), testing::IsEmpty());
  for (const easydyn::Parameter& p : parameters(tram)) {
    EXPECT_FALSE(p.unit.empty()) << p.name;
    EXPECT_THAT(p.source, testing::Not(testing::AnyOf("", "default", "set by the user"))) << p.name;
  }
}

TEST(RailVehicle, RefusesImpossibleValuesByObjectQuantityValueAndRange) {
  EXPECT_THAT(
      validating_tram_with([](RailVehicle& v) { v.bodies[0].mass = -9e3; }),
      ThrowsMessage<ModelError>("vehicle \"t2000-like\", body \"front body\": mass = -9000 kg, must be > 0"));
  EXPECT_THAT(
      validating_tram_with([](RailVehicle& v) { v.gears[1].wheel_pairs[0].primary_stiffness = NAN; }),
      ThrowsMessage<ModelError>(HasSubstr("wheel pair \"centre gear, front\": primary stiffness = nan N/m")));
  EXPECT_THAT(
      validating_tram_with([](RailVehicle& v) { v.gears[0].wheel_pairs[1].resilient->tyre_mass = 400; }),
      ThrowsMessage<ModelError>(HasSubstr("tyre mass = 400 kg, must be > 0 and < 350")));
  EXPECT_THAT(
      validating_tram_with([](RailVehicle& v) { v.gears[0].secondaries[0].body = "middle body"; }),
      ThrowsMessage<ModelError>(HasSubstr("body \"middle body\" is unknown, there are \"front body\"")));
  EXPECT_THAT(
      validating_tram_with([](RailVehicle& v) { v.hinges[1].rear_body = "centre body"; }),
      ThrowsMessage<ModelError>(HasSubstr("hinge \"rear hinge\": joins body \"centre body\" to itself")));
  EXPECT_THAT(validating_tram_with([](RailVehicle& v) { v.gears[1].name = "front gear"; }),
              ThrowsMessage<ModelError>(HasSubstr("the name \"front gear\" is used twice")));
  EXPECT_THROW(validating_tram_with([](RailVehicle& v) { v.gears[0].wheel_pairs[0].radius = 0; })(),
               ModelError);
  EXPECT_THROW(validating_tram_with([](RailVehicle& v) { v.gears[0].secondaries.clear(); })(), ModelError);
  EXPECT_THROW(validating_tram_with([](RailVehicle& v) { v.bodies.clear(); })(), ModelError);
}

TEST(RailVehicle, WarnsOfUnusualValuesWithoutRefusingThem) {
  RailVehicle tram = t2000_like();
  tram.bodies[1].mass = 90e3;
  EXPECT_NO_THROW(validate(tram));
  EXPECT_THAT(unusual_values(tram), testing::ElementsAre(HasSubstr("body \"centre body\": mass = 90000 kg")));
}

}  // namespace

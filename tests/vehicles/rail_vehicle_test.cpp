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

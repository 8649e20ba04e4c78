#include "vehicles/catalogue.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "easydyn/error.hpp"
#include "vehicles/axle_loads.hpp"
#include "vehicles/t2000_like.hpp"
#include "vehicles/train.hpp"
#include "vehicles/two_bogie_car.hpp"

namespace {

using namespace easydyn::vehicles;
using easydyn::ModelError;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(Catalogue, HoldsSixVehiclesWithSourcesAndNothingUnusual) {
  EXPECT_EQ(vehicle_catalogue().size(), 6u);
  for (const CatalogueEntry& entry : vehicle_catalogue()) {
    const RailVehicle vehicle = find_vehicle(entry.name);
    EXPECT_NO_THROW(validate(vehicle)) << entry.name;
    EXPECT_THAT(unusual_values(vehicle), testing::IsEmpty()) << entry.name;
    for (const easydyn::Parameter& p : parameters(vehicle))
      EXPECT_THAT(p.source, testing::Not(testing::AnyOf("", "default", "set by the user")))
          << entry.name << ", " << p.name;
    EXPECT_NEAR(compute_axle_loads(vehicle).total() / vehicle.weight(), 1, 1e-12) << entry.name;
  }
}

TEST(Catalogue, NamesTheNearestVehicle) {
  EXPECT_THAT([] { find_vehicle("thalis_like"); },
              ThrowsMessage<ModelError>(HasSubstr(
                  "vehicle \"thalis_like\" is unknown, the nearest is \"thalys_like\" of t2000_like, ")));
}

struct CarRow {
  const char* name;
  double body, body_inertia, spacing, bogie, bogie_inertia, wheelbase, axle, k_p, d_p, k_s, d_s;
};

/// Car number i of a train of two-bogie cars.
void expect_car(const RailVehicle& train, size_t i, const CarRow& row) {
  const CarBody& body = train.bodies.at(i);
  EXPECT_DOUBLE_EQ(body.mass, row.body) << row.name;
  EXPECT_DOUBLE_EQ(body.pitch_inertia, row.body_inertia) << row.name;
  const RunningGear &front = train.gears.at(2 * i), &rear = train.gears.at(2 * i + 1);
  EXPECT_NEAR(front.x - rear.x, row.spacing, 1e-12) << row.name;
  EXPECT_NEAR(front.x + rear.x, 2 * body.x, 1e-12) << row.name;
  for (const RunningGear& gear : {front, rear}) {
    EXPECT_DOUBLE_EQ(gear.frame_mass, row.bogie) << row.name;
    EXPECT_DOUBLE_EQ(gear.frame_pitch_inertia, row.bogie_inertia) << row.name;
    ASSERT_EQ(gear.secondaries.size(), 1u);
    EXPECT_EQ(gear.secondaries[0].body, body.name);
    EXPECT_NEAR(gear.secondaries[0].x, gear.x, 1e-12);
    EXPECT_DOUBLE_EQ(gear.secondaries[0].stiffness, row.k_s) << row.name;
    EXPECT_DOUBLE_EQ(gear.secondaries[0].damping, row.d_s) << row.name;
    ASSERT_EQ(gear.wheel_pairs.size(), 2u);
    EXPECT_NEAR(gear.wheel_pairs[0].x - gear.wheel_pairs[1].x, row.wheelbase, 1e-12) << row.name;
    for (const WheelPair& pair : gear.wheel_pairs) {
      EXPECT_DOUBLE_EQ(pair.mass, row.axle) << row.name;
      EXPECT_DOUBLE_EQ(pair.primary_stiffness, row.k_p) << row.name;
      EXPECT_DOUBLE_EQ(pair.primary_damping, row.d_p) << row.name;
    }
  }
}

// F: TTB-2D (Cantero, NTNU), quoting Iwnicki 1998 and Goicolea 2014; retyped.
TEST(Catalogue, HoldsTheValuesOfItsSources) {
  expect_car(manchester_benchmark_1(), 0,
             {"Manchester", 32000, 1.97e6, 19.0, 2615, 1476, 2.56, 1813, 2.4e6, 8e3, 8.6e5, 4e4});
  expect_car(shinkansen_s300_like(), 0,
             {"S300", 41750, 2.08e6, 17.5, 3040, 3930, 2.5, 1780, 1.18e6, 3.92e4, 5.3e5, 9.02e4});
  expect_car(china_star_like(), 0,
             {"China Star", 59364, 1.723e6, 11.46, 5631, 9487, 3.0, 1843.5, 4.80e6, 6e4, 1.772e6, 9e4});
  const RailVehicle ice = ice3_like();
  ASSERT_EQ(ice.bodies.size(), 8u);
  for (size_t i = 0; i < 8; ++i) {
    const bool is_light = i == 3 || i == 4;  // cars 4 and 5
    expect_car(ice, i,
               {"ICE 3", is_light ? 41200. : 47800., is_light ? 1.688e6 : 1.958e6, 17.375, 3500,
                is_light ? 1372. : 1715., 2.5, 1800, 2.4e6, 2e4, 7e5, 4e4});
  }
}

TEST(TwoBogieCar, SharesItsWeightEquallyAndRefusesAnImpossibleWheelbase) {
  const RailVehicle car = manchester_benchmark_1();
  const AxleLoads loads = compute_axle_loads(car);
  for (const auto& gear : loads.wheel_pairs)
    for (const WheelPairLoad& axle : gear)  // (32 000 + 2 x 2615 + 4 x 1813) kg / 4
      EXPECT_NEAR(axle.axle_load / (9.81 * 11120.5), 1, 1e-12);
  TwoBogieCar data;
  data.name = "stub";
  data.bogie_spacing = 2;
  data.wheelbase = 2.5;
  EXPECT_THAT(
      [&] { two_bogie_car(data); },
      ThrowsMessage<ModelError>("vehicle \"stub\": wheelbase = 2.5 m, must be < 2, the bogie spacing"));
}

TEST(Train, CouplesCarsEndToEndWithNamesOfTheirOwn) {
  const RailVehicle train =
      couple("two trams and a coach", {t2000_like(), manchester_benchmark_1(), t2000_like()});
  EXPECT_DOUBLE_EQ(train.length, 22.80 + 26.0 + 22.80);
  EXPECT_EQ(train.bodies[0].name, "car 1 front body");
  EXPECT_EQ(train.hinges[0].rear_body, "car 1 centre body");
  EXPECT_EQ(train.gears[3].name, "car 2 front bogie");
  EXPECT_EQ(train.gears[3].wheel_pairs[0].name, "car 2 axle 1");
  EXPECT_NEAR(train.bodies[1].x, (22.80 + 26.0) / 2, 1e-12);
  EXPECT_NEAR(train.bodies[3].x, 0, 1e-12);
  // every car bears itself: the axle loads are those of the cars alone
  const AxleLoads loads = compute_axle_loads(train), tram = compute_axle_loads(t2000_like());
  EXPECT_NEAR(loads.gear_load(0) / tram.gear_load(0), 1, 1e-10);
  EXPECT_NEAR(loads.gear_load(6) / tram.gear_load(1), 1, 1e-10);
  EXPECT_THAT([] { couple("nothing", {}); },
              ThrowsMessage<ModelError>("vehicle \"nothing\": cars = 0, must be >= 1"));
}

}  // namespace

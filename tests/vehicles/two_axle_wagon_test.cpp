// Running gear without a frame: a freight wagon whose body stands on its two axles.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "easydyn/error.hpp"
#include "vehicles/axle_loads.hpp"
#include "vehicles/planar_vehicle.hpp"
#include "vehicles/simplified_vehicle.hpp"
#include "vehicles/train.hpp"
#include "vehicles/vehicle_drawing.hpp"
#include "vehicles/vehicle_modes.hpp"
#include "vehicles/vehicle_tables.hpp"

namespace {

using namespace easydyn::vehicles;
using testing::HasSubstr;

constexpr double m_body = 36e3, J = 6e5, m_axle = 1.4e3, k = 4e6, d = 50e3, a = 4.5;

// The centre of mass stands `offset` ahead of the middle between the axles.
RailVehicle wagon(double offset = 0) {
  const std::string made_up = "D: of this test";
  RailVehicle vehicle;
  vehicle.name = "two-axle wagon";
  vehicle.length = {14, made_up};
  vehicle.bodies = {{.name = "body",
                     .mass = {m_body, made_up},
                     .pitch_inertia = {J, made_up},
                     .x = {offset, made_up},
                     .length = {13, made_up}}};
  for (const bool is_front : {true, false}) {
    const double x = is_front ? a : -a;
    const std::string end = is_front ? "front" : "rear";
    RunningGear gear;
    gear.name = end + " gear";
    gear.x = gear.pivot_x = {x, made_up};
    gear.body = "body";
    gear.wheel_pairs = {{.name = end + " axle",
                         .x = {x, made_up},
                         .mass = {m_axle, made_up},
                         .radius = {0.46, made_up},
                         .primary_stiffness = {k, made_up},
                         .primary_damping = {d, made_up}}};
    vehicle.gears.push_back(gear);
  }
  return vehicle;
}

TEST(TwoAxleWagon, SharesItsWeightByTheLever) {
  const AxleLoads loads = compute_axle_loads(wagon(0.9));
  // moments about the rear axle: the body's weight at a + 0.9 of 2 a
  EXPECT_NEAR(loads.wheel_pairs[0][0].primary, m_body * gravity * (a + 0.9) / (2 * a), 1e-6);
  EXPECT_NEAR(loads.wheel_pairs[1][0].primary, m_body * gravity * (a - 0.9) / (2 * a), 1e-6);
  EXPECT_NEAR(loads.total(), wagon().weight(), 1e-6);
  EXPECT_TRUE(loads.secondary[0].empty());
  const MassBalance balance = compute_mass_balance(wagon());
  EXPECT_EQ(balance.frame_count, 0);
  EXPECT_DOUBLE_EQ(balance.total(), m_body + 2 * m_axle);
}

TEST(TwoAxleWagon, BouncesAndPitchesOnItsAxles) {
  // On rigid rails: m z.. + 2 d z. + 2 k z = 0 and J theta.. + 2 d a^2 theta. + 2 k a^2 theta = 0.
  const std::vector<VehicleMode> modes = compute_vehicle_modes(wagon());
  ASSERT_EQ(modes.size(), 2u);
  const double bounce = std::sqrt(2 * k / m_body), pitch = std::sqrt(2 * k * a * a / J);
  ASSERT_EQ(modes[0].motion, "body, bounce");
  ASSERT_EQ(modes[1].motion, "body, pitch");
  // differences of fourth order with steps of 1e-5: rounding 1e-7
  EXPECT_NEAR(std::abs(modes[0].pole), bounce, 1e-6 * bounce);
  EXPECT_NEAR(std::abs(modes[1].pole), pitch, 1e-6 * pitch);
  EXPECT_NEAR(modes[0].damping, 2 * d / (2 * m_body * bounce), 1e-6);
  EXPECT_NEAR(modes[1].damping, 2 * d * a * a / (2 * J * pitch), 1e-6);
}

TEST(TwoAxleWagon, RestsInItsNominalGeometry) {
  class OnRails : public easydyn::System {
   public:
    PlanarVehicle vehicle{*this, wagon(0.9)};
    OnRails() { vehicle.hold_wheels(); }
    void positions() override { vehicle.place(100 + 20 * time()); }
    void forces() override {
      gravity(easydyn::vehicles::gravity);
      vehicle.apply_suspensions();
    }
  } system;
  EXPECT_TRUE(system.vehicle.frames().empty());
  const auto state = system.initial_state();
  // preloads against the weight of 3.5e5 N
  EXPECT_LT(system.compute_residual(state).lpNorm<Eigen::Infinity>(), 1e-6);
}

TEST(TwoAxleWagon, IsSimplifiedWithItsBodyOnThePrimarySuspension) {
  for (const VehicleDetail detail : {VehicleDetail::quarter, VehicleDetail::three_masses}) {
    class OnRails : public easydyn::System {
     public:
      SimplifiedVehicle vehicle;
      explicit OnRails(VehicleDetail of) : vehicle(*this, wagon(), of) { vehicle.hold_wheels(); }
      void positions() override { vehicle.place(0); }
      void forces() override {
        gravity(easydyn::vehicles::gravity);
        vehicle.apply_suspensions();
      }
    } system(detail);
    const auto modes = easydyn::compute_modes(easydyn::linearize(system, system.initial_state()));
    ASSERT_EQ(modes.size(), 2u);  // one mass per axle
    for (const auto& mode : modes)
      EXPECT_NEAR(std::abs(mode.pole), std::sqrt(k / (m_body / 2)), 1e-5 * std::sqrt(k / (m_body / 2)));
  }
}

TEST(TwoAxleWagon, IsCoupledToATrainAndDrawn) {
  const RailVehicle train = couple("freight train", {wagon(), wagon()});
  EXPECT_EQ(train.gears[3].body, "car 2 body");
  EXPECT_NEAR(compute_axle_loads(train).total(), 2 * wagon().weight(), 1e-6);
  EXPECT_THAT(draw_vehicle(train), HasSubstr("car 2 body"));
}

TEST(TwoAxleWagon, RefusesWhatBelongsToAFrame) {
  const auto expect_refusal = [](auto change, const std::string& message) {
    RailVehicle vehicle = wagon();
    change(vehicle.gears[0]);
    EXPECT_THAT([&] { validate(vehicle); }, testing::ThrowsMessage<easydyn::ModelError>(HasSubstr(message)));
  };
  expect_refusal(
      [](RunningGear& gear) {
        gear.frame_mass = {900, ""};
      },
      "running gear \"front gear\": frame mass = 900 kg, must be 0: its wheel pairs carry body \"body\"");
  expect_refusal(
      [](RunningGear& gear) {
        gear.secondaries = {{.body = "body", .x = {a, ""}, .stiffness = {1e6, ""}, .damping = {0, ""}}};
      },
      "secondary suspensions = 1, must be 0");
  expect_refusal([](RunningGear& gear) { gear.body = "wagon"; }, "body \"wagon\" is unknown");
  expect_refusal([](RunningGear& gear) { gear.body.clear(); }, "frame mass = 0 kg, must be > 0");
}

}  // namespace

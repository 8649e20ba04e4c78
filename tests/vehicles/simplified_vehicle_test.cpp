#include "vehicles/simplified_vehicle.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "easydyn/error.hpp"
#include "track/wheel_rail_contact.hpp"
#include "vehicles/catalogue.hpp"
#include "vehicles/planar_vehicle.hpp"
#include "vehicles/vehicle_modes.hpp"

namespace {

using namespace easydyn;
using namespace easydyn::vehicles;

const double pi = std::numbers::pi;
const VehicleDetail every_detail[] = {VehicleDetail::wheel_pair, VehicleDetail::quarter,
                                      VehicleDetail::three_masses};

/// A vehicle in any detail on springs that stand for the rail: `Vehicle` is a PlanarVehicle or a simplified one.
class VehicleOnSprings : public System {
 public:
  static constexpr double rail_stiffness = 1e8;
  std::unique_ptr<VehicleModel> vehicle;
  std::vector<VerticalSpringDamper> rail;

  explicit VehicleOnSprings(const RailVehicle& data, std::optional<VehicleDetail> detail) {
    if (detail)
      vehicle = std::make_unique<SimplifiedVehicle>(*this, data, *detail);
    else
      vehicle = std::make_unique<PlanarVehicle>(*this, data);
    for (const VehicleModel::Wheel& w : vehicle->wheels())
      rail.emplace_back(w.name, rail_stiffness, 0, 0, w.static_load);
  }
  void positions() override { vehicle->place(3 + 20 * time()); }
  void forces() override {
    gravity(vehicles::gravity);
    vehicle->apply_suspensions();
    for (std::size_t w = 0; w < rail.size(); ++w)
      rail[w].apply(Frame(), {0, 0, 0}, *vehicle->wheels()[w].body, {0, 0, 0});
  }
};

std::vector<double> frequencies(System& system) {
  Linearization lin = linearize(system, system.initial_state());
  lin.C.setZero();
  std::vector<double> found;
  for (const Mode& mode : compute_modes(lin)) found.push_back(mode.frequency);
  return found;
}

/// Lower and upper frequency of mass m_1 on k_1 and m_2 on m_1 by k_2 [Hz].
std::pair<double, double> two_masses(double m_1, double k_1, double m_2, double k_2) {
  const double b = ((k_1 + k_2) / m_1 + k_2 / m_2) / 2, c = k_1 * k_2 / (m_1 * m_2),
               root = std::sqrt(b * b - c);
  return {std::sqrt(c / (b + root)) / (2 * pi), std::sqrt(b + root) / (2 * pi)};
}

TEST(SimplifiedVehicle, HasTheAxleLoadsOfTheWholeVehicleAndRestsInItsNominalGeometry) {
  for (const CatalogueEntry& entry : vehicle_catalogue())
    for (const VehicleDetail detail : every_detail) {
      const RailVehicle data = entry.make();
      VehicleOnSprings simple(data, detail), whole(data, {});
      ASSERT_EQ(simple.vehicle->wheels().size(), whole.vehicle->wheels().size());
      for (std::size_t w = 0; w < simple.rail.size(); ++w) {
        const VehicleModel::Wheel &a = simple.vehicle->wheels()[w], &b = whole.vehicle->wheels()[w];
        EXPECT_EQ(a.static_load, b.static_load) << entry.name;  // the same statics
        EXPECT_EQ(a.name, b.name);
        EXPECT_EQ(a.x, b.x);
        EXPECT_EQ(a.radius, b.radius);
        EXPECT_EQ(a.contacts, b.contacts);
        EXPECT_EQ(a.body->name(), b.body->name());
      }
      EXPECT_EQ(simple.vehicle->weight(), whole.vehicle->weight());
      EXPECT_NEAR(simple.vehicle->weight() / data.weight(), 1, 1e-12);
      EXPECT_EQ(simple.vehicle->front_wheel_x(), whole.vehicle->front_wheel_x());
      EXPECT_EQ(simple.vehicle->rear_wheel_x(), whole.vehicle->rear_wheel_x());
      // forces of 1e5 N cancel to rounding
      EXPECT_LT(simple.compute_residual(simple.initial_state()).lpNorm<Eigen::Infinity>(), 1e-8)
          << entry.name;
    }
}

TEST(SimplifiedVehicle, HasTheFrequenciesOfItsClosedForms) {
  // Manchester, per axle: pair 1813 kg, frame 2615 / 2 kg, body 32000 / 4 kg, k_p 2.4 MN/m, k_s 0.86 / 2 MN/m
  const RailVehicle coach = manchester_benchmark_1();
  const double pair = 1813, frame = 1307.5, body = 8000, k_p = 2.4e6, k_s = 0.43e6;
  // differences of linear forces: rounding of 1e5 N over steps of 1e-4 m against 1e6 N/m
  const double tight = 1e-6;

  VehicleOnSprings wheel(coach, VehicleDetail::wheel_pair);
  ASSERT_EQ(wheel.size(), 4);
  for (const double f : frequencies(wheel))  // nothing but its mass on the rail
    EXPECT_NEAR(f / (std::sqrt(1e8 / pair) / (2 * pi)), 1, tight);

  VehicleOnSprings quarter(coach, VehicleDetail::quarter);
  quarter.vehicle->hold_wheels();
  ASSERT_EQ(quarter.size(), 4);
  for (const double f : frequencies(quarter))
    EXPECT_NEAR(f / (std::sqrt(k_p * k_s / (k_p + k_s) / (frame + body)) / (2 * pi)), 1, tight);

  VehicleOnSprings three(coach, VehicleDetail::three_masses);
  three.vehicle->hold_wheels();
  ASSERT_EQ(three.size(), 8);
  const auto [low, high] = two_masses(frame, k_p, body, k_s);
  const std::vector<double> found = frequencies(three);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(found[i] / (i < 4 ? low : high), 1, tight);
}

TEST(SimplifiedVehicle, OfThreeMassesKeepsTheBounceOfASymmetricCar) {
  const RailVehicle coach = manchester_benchmark_1();
  VehicleOnSprings three(coach, VehicleDetail::three_masses);
  three.vehicle->hold_wheels();
  const std::vector<Mode> modes = compute_modes(linearize(three, three.initial_state()));
  const std::vector<VehicleMode> whole = compute_vehicle_modes(coach);
  // damped: frequency and damping of body and frame bounce; both numerical, of one closed form
  EXPECT_EQ(whole[0].motion, "body, bounce");
  EXPECT_NEAR(modes[0].frequency / whole[0].frequency, 1, 1e-6);
  EXPECT_NEAR(modes[0].damping / whole[0].damping, 1, 1e-6);
}

// The quarter's damper: of the two complex stiffnesses in series, Im / w at w -> 0.
TEST(SimplifiedVehicle, OfAQuarterDampsAsTheTwoSuspensionsInSeries) {
  const double w = 1e-3, k_p = 2.4e6, d_p = 8e3, k_s = 0.43e6, d_s = 2e4;
  const std::complex<double> i(0, 1), p = k_p + i * w * d_p, s = k_s + i * w * d_s, series = p * s / (p + s);
  VehicleOnSprings quarter(manchester_benchmark_1(), VehicleDetail::quarter);
  quarter.vehicle->hold_wheels();
  const Linearization lin = linearize(quarter, quarter.initial_state());
  EXPECT_NEAR(lin.C(0, 0) / (series.imag() / w), 1, 1e-6);
  EXPECT_NEAR(lin.K(0, 0) / series.real(), 1, 1e-6);
}

TEST(SimplifiedVehicle, KeepsTheResilientTyre) {
  VehicleOnSprings tram(find_vehicle("t2000_like"), VehicleDetail::wheel_pair);
  EXPECT_EQ(tram.size(), 12);  // hub and tyre of six pairs
  EXPECT_EQ(tram.vehicle->wheels()[0].body->name(), "front gear, driven, tyre");
  EXPECT_EQ(tram.vehicle->wheels()[0].body->mass(), 200);
}

TEST(SimplifiedVehicle, RefusesAPairThatTheStaticsLift) {
  RailVehicle tram = find_vehicle("t2000_like");
  tram.bodies[0].x = 40;  // far beyond its gear: the trailing pair lifts
  class Empty : public System {
    void positions() override {}
  } system;
  EXPECT_THAT([&] { SimplifiedVehicle(system, tram, VehicleDetail::quarter); },
              testing::ThrowsMessage<ModelError>(
                  testing::AllOf(testing::HasSubstr("simplified: static force of the primary suspension = -"),
                                 testing::HasSubstr("must be > 0"))));
}

// On the flexible track, at rest: any detail presses alike.
TEST(SimplifiedVehicle, PressesOnTheTrackAsTheWholeVehicle) {
  class CarOnTrack : public System {
   public:
    SimplifiedVehicle car;
    track::FlexibleTrack rail{*this, track::TrackModel(track::thalys_like_track(), 121, -60.5 * 0.6)};
    std::vector<track::WheelRailContact> contacts;
    explicit CarOnTrack(VehicleDetail detail) : car(*this, manchester_benchmark_1(), detail) {
      for (const VehicleModel::Wheel& w : car.wheels())
        contacts.emplace_back(w.name, track::HertzContact(1e11, w.contacts), w.radius, w.static_load,
                              std::make_shared<track::FlatProfile>());
    }
    void positions() override { car.place(0.1); }
    void forces() override {
      gravity(vehicles::gravity);
      car.apply_suspensions();
      for (std::size_t w = 0; w < contacts.size(); ++w) contacts[w].apply(*car.wheels()[w].body, rail);
    }
  };
  for (const VehicleDetail detail : every_detail) {
    CarOnTrack system(detail);
    system.evaluate(solve_static_equilibrium(system));
    for (const track::WheelRailContact& contact : system.contacts)
      EXPECT_NEAR(contact.force() / contact.static_load(), 1, 1e-9);  // statically determinate: each its own
  }
}

}  // namespace

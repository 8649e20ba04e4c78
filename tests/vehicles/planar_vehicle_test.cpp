#include "vehicles/planar_vehicle.hpp"

#include <gtest/gtest.h>

#include "track/wheel_rail_contact.hpp"
#include "vehicles/t2000_like.hpp"
#include "vehicles/vehicle_scene.hpp"

namespace {

using namespace easydyn;
using namespace easydyn::vehicles;

// The tram on unyielding contacts: tyres on very stiff springs.
class TramOnRigidRail : public System {
 public:
  PlanarVehicle tram{*this, t2000_like()};
  std::vector<VerticalSpringDamper> rail;
  TramOnRigidRail() {
    for (const PlanarVehicle::Wheel& w : tram.wheels()) rail.emplace_back(w.name, 1e10, 0, 0, w.static_load);
  }
  void positions() override { tram.place(5 + 8 * time()); }
  void forces() override {
    gravity(vehicles::gravity);
    tram.apply_suspensions();
    for (std::size_t w = 0; w < rail.size(); ++w)
      rail[w].apply(Frame(), {0, 0, 0}, *tram.wheels()[w].body, {0, 0, 0});
  }
};

TEST(PlanarVehicle, IsInBalanceInItsNominalGeometry) {
  TramOnRigidRail system;
  EXPECT_EQ(system.size(), 22);  // 4 of the bodies, 6 of the frames, 12 of hubs and tyres
  EXPECT_LT(system.compute_residual(system.initial_state()).lpNorm<Eigen::Infinity>(),
            1e-10 * system.tram.weight());
}

TEST(PlanarVehicle, ReturnsToItsNominalGeometryAndAxleLoads) {
  TramOnRigidRail system;
  State disturbed = system.initial_state();
  disturbed.q.setConstant(0.01);
  const State s = solve_static_equilibrium(system, disturbed);
  EXPECT_LT(s.q.lpNorm<Eigen::Infinity>(), 1e-10);
  system.evaluate(s);
  for (std::size_t w = 0; w < system.rail.size(); ++w)
    EXPECT_NEAR(system.rail[w].force() / system.tram.wheels()[w].static_load, 1, 1e-10);
}

TEST(PlanarVehicle, HasTheModesOfATram) {
  TramOnRigidRail system;
  const std::vector<Mode> modes = compute_modes(linearize(system, system.initial_state(), 1e-5));
  // Representative ranges (D): bodies 0.4-3 Hz for this stiff tram, nothing unstable.
  EXPECT_GT(modes.front().frequency, 0.4);
  EXPECT_LT(modes.front().frequency, 3.0);
  for (const Mode& mode : modes) EXPECT_LT(mode.pole.real(), 1e-6);
}

// The tram on its flexible track at rest: whatever the track does, forces and moments must balance.
TEST(PlanarVehicle, OnAFlexibleTrackKeepsItsWeightAndItsCentreOfMass) {
  class TramOnTrack : public System {
   public:
    PlanarVehicle tram{*this, t2000_like()};
    track::FlexibleTrack rail{*this, track::TrackModel(track::t2000_like_track(), 101, -50.5 * 0.72)};
    std::vector<track::WheelRailContact> contacts;
    TramOnTrack() {
      for (const PlanarVehicle::Wheel& w : tram.wheels())
        contacts.emplace_back(w.name, track::HertzContact(1e11, w.contacts), w.radius, w.static_load,
                              std::make_shared<track::FlatProfile>());
    }
    void positions() override { tram.place(0.31); }
    void forces() override {
      gravity(vehicles::gravity);
      tram.apply_suspensions();
      for (std::size_t w = 0; w < contacts.size(); ++w) contacts[w].apply(*tram.wheels()[w].body, rail);
    }
  } system;
  const State s = solve_static_equilibrium(system);
  system.evaluate(s);
  double sum = 0, moment = 0, body_moment = 0;
  for (std::size_t w = 0; w < system.contacts.size(); ++w) {
    sum += system.contacts[w].force();
    moment += system.contacts[w].force() * system.tram.wheels()[w].x;
    // The track redistributes a little: the statically indeterminate tram is stiff in pitch.
    EXPECT_NEAR(system.contacts[w].force() / system.tram.wheels()[w].static_load, 1, 0.01);
  }
  for (const Body& b : system.bodies())
    body_moment += b.mass() * vehicles::gravity * (b.position().x() - 0.31);
  const double W = system.tram.weight();
  EXPECT_NEAR(sum / W, 1, 1e-10);
  // Vertical suspensions act at points that move apart along x at second order of the pitch, here 1e-5 rad.
  EXPECT_NEAR((moment - body_moment) / (W * 10), 0, 1e-8);
  const Eigen::VectorXd q = system.rail.coordinates(s.q);
  EXPECT_NEAR(system.rail.model().ballast_reactions(q, 0 * q).sum() / W, 1, 1e-10);
}

TEST(VehicleScene, DrawsEveryBodyGearAndWheel) {
  const RailVehicle tram = t2000_like();
  TramOnRigidRail system;
  VehicleMotion motion;
  motion.time = Eigen::VectorXd::LinSpaced(3, 0, 1);
  motion.origin_x = Eigen::VectorXd::LinSpaced(3, 0, 8);
  for (const Body& b : system.bodies()) motion.bodies.push_back(b.name());
  motion.height = motion.pitch = Eigen::MatrixXd::Zero(3, static_cast<Eigen::Index>(motion.bodies.size()));
  visu::Scene scene;
  add_vehicle(scene, tram, motion);
  EXPECT_EQ(scene.items.size(), 3u + 3u + 2u * 6u);
  EXPECT_NO_THROW(visu::check(scene));
  motion.bodies[0] = "somebody else";
  EXPECT_THROW(add_vehicle(scene, tram, motion), ModelError);
}

}  // namespace

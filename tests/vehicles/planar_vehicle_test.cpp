#include "vehicles/planar_vehicle.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <complex>

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

/// The tram's small motions by hand. It is symmetric front to rear, so that half of it moves in 11 ways with
/// the other half and in 11 against it: centre body and centre gear heave in the first, pitch in the second.
///
///   x = 0            2.4 hinge                    7.01   8.71
///    [=== centre ====]o[======== end body =========o======O===]
///    |-O 0.85
/// Coordinates: centre body a (height a at any x, or a x), slope b of the end body about the hinge, end frame
/// height c and slope d, centre frame e (as a); then hub and tyre of the driven, the trailing and the centre
/// pair. An element adds 1/2 m (row y.)^2, 1/2 k (row y)^2 or 1/2 d (row y.)^2. Values: the tram's
/// data sheet (D, M-l), retyped.
struct HalfTram {
  using Row = Eigen::RowVectorXd;
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(11, 11), C = M, K = M;

  explicit HalfTram(bool is_symmetric) {
    const auto unit = [](int i) { return Row(Row::Unit(11, i)); };
    const auto centre_at = [&](double x) -> Row { return (is_symmetric ? 1.0 : x) * unit(0); };
    const auto end_at = [&](double x) -> Row { return centre_at(2.4) + (x - 2.4) * unit(1); };
    const auto end_frame_at = [&](double x) -> Row { return unit(2) + (x - 7.86) * unit(3); };
    const auto centre_frame_at = [&](double x) -> Row { return (is_symmetric ? 1.0 : x) * unit(4); };
    // bodies and frames; half of the centre body and frame, mass in heave, pitch inertia in pitch
    add(M, is_symmetric ? 8000.0 / 2 : 1.5e4 / 2, unit(0));
    add(M, 9000, end_at(6.9));
    add(M, 6.1e4, unit(1));
    add(M, 1800, unit(2));
    add(M, 8e2, unit(3));
    add(M, is_symmetric ? 1800.0 / 2 : 8e2 / 2, unit(4));
    // secondary suspensions: 0.96 MN/m and 56 kNs/m per gear at two points 0.5 m either side of its pivot
    for (const double x : {8.7, 7.7}) join(0.48e6, 28e3, end_at(x) - end_frame_at(x));
    join(0.48e6, 28e3, centre_at(0.5) - centre_frame_at(0.5));
    // wheel pairs: hub, tyre, primary 44 MN/m and 18 kNs/m, resilient wheel 145 MN/m and 3 kNs/m, rail
    const auto add_pair = [&](int hub, double mass, double tyre_mass, const Row& frame) {
      add(M, mass - tyre_mass, unit(hub));
      add(M, tyre_mass, unit(hub + 1));
      join(44e6, 18e3, frame - unit(hub));
      join(145e6, 3e3, unit(hub) - unit(hub + 1));
      join(1e10, 0, unit(hub + 1));
    };
    add_pair(5, 1100, 200, end_frame_at(8.71));
    add_pair(7, 350, 80, end_frame_at(7.01));
    add_pair(9, 1100, 200, centre_frame_at(0.85));
  }

  /// Appends the poles of M y.. + C y. + K y = 0 on and above the real axis.
  void append_poles(std::vector<std::complex<double>>& poles) const {
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(22, 22);
    A.topRightCorner(11, 11).setIdentity();
    const Eigen::LLT<Eigen::MatrixXd> mass(M);
    A.bottomLeftCorner(11, 11) = -mass.solve(K);
    A.bottomRightCorner(11, 11) = -mass.solve(C);
    const Eigen::VectorXcd eigenvalues = A.eigenvalues();
    for (const std::complex<double>& pole : eigenvalues)
      if (pole.imag() >= 0) poles.push_back(pole);
  }

  static void add(Eigen::MatrixXd& A, double factor, const Row& row) { A += factor * row.transpose() * row; }
  void join(double stiffness, double damping, const Row& row) {
    add(K, stiffness, row);
    add(C, damping, row);
  }
};

TEST(PlanarVehicle, HasTheModesOfTheTramWorkedOutByHand) {
  TramOnRigidRail system;
  const std::vector<Mode> modes = compute_modes(linearize(system, system.initial_state(), 1e-5));
  std::vector<std::complex<double>> by_hand;
  HalfTram(true).append_poles(by_hand);
  HalfTram(false).append_poles(by_hand);
  std::ranges::sort(by_hand, {}, [](const std::complex<double>& pole) { return std::abs(pole); });
  ASSERT_EQ(modes.size(), by_hand.size());
  for (std::size_t i = 0; i < modes.size(); ++i) {
    // rounding of the eigenvalues: 1e-16 of the largest entry, 1e10 N/m / 80 kg, against the smallest |pole|
    // of 2.8 1/s gives 5e-9; measured 3e-9
    EXPECT_LT(std::abs(modes[i].pole - by_hand[i]), 1e-7 * std::abs(by_hand[i])) << by_hand[i];
    EXPECT_LT(modes[i].pole.real(), 0);
  }
  // The four modes of the bodies at 0.4-2 Hz (D, common vehicles), the stiff primaries far above.
  EXPECT_GT(modes[0].frequency, 0.4);
  EXPECT_LT(modes[3].frequency, 2);
  EXPECT_GT(modes[4].frequency, 10);
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

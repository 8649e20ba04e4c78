#include <cmath>

#include "tests/kernel/two_bodies.hpp"

using namespace easydyn;
using Eigen::Vector3d;

namespace {

const PlaneContact::Data ground{.stiffness = 2e4,
                                .exponent = 1.5,
                                .damping = 0.2,
                                .friction = {.sliding = 0.4, .sticking = 0.5, .creep_speed = 0.02}};

// Body B is turned by small angles and lies below the plane of body A, which moves as well.
State touching_state(TwoBodies& system, double depth) {
  State s = random_state(system, {0.2, 0.1, -depth}, 0.02);
  s.qd *= 0.5;
  return s;
}

TEST(PlaneContact, BalancesPowerForPointSphereAndCylinderOnAMovingPlane) {
  PlaneContact contact("c", ground);
  TwoBodies point([&](TwoBodies& b) { contact.apply_point(b.A, b.B, {0.1, 0.05, 0}); });
  TwoBodies sphere([&](TwoBodies& b) { contact.apply_sphere(b.A, b.B, {0, 0, 0.3}, 0.25); });
  TwoBodies lying([&](TwoBodies& b) { contact.apply_cylinder(b.A, b.B, {0, 0, 0.17}, {0, 2, 0}, 0.1, 0.3); });
  TwoBodies standing([&](TwoBodies& b) {
    contact.apply_cylinder(b.A, b.B, {0, 0, 0.17}, {0, 0, 1}, 0.3, 0.1);
  });
  for (int i = 0; i < 5; ++i) {
    expect_balance(point, touching_state(point, 0.2));
    EXPECT_GT(contact.depth(), 0);
    expect_balance(sphere, touching_state(sphere, 0.2));
    EXPECT_GT(contact.depth(), 0);
    expect_balance(lying, touching_state(lying, 0.2));
    expect_balance(standing, touching_state(standing, 0.2));
  }
}

TEST(PlaneContact, DoesNothingAtADistance) {
  PlaneContact contact("c", ground);
  TwoBodies system([&](TwoBodies& b) { contact.apply_sphere(b.A, b.B, {0, 0, 0}, 0.25); });
  State s = system.initial_state();
  s.q[8] = 0.4;
  EXPECT_EQ(system.forces_of_element(s).norm(), 0);
  EXPECT_NEAR(contact.depth(), -0.15, 1e-14);
}

class Ball : public System {
 public:
  Coordinate z = coordinate("z", 0.5);
  Body& ball = body("ball", 1.0);
  PlaneContact contact;
  explicit Ball(const PlaneContact::Data& data) : contact("floor", data) {}
  void positions() override { ball = translate(0, 0, z); }
  void forces() override {
    gravity();
    contact.apply_sphere({}, ball, {0, 0, 0}, 0.1);
  }
};

TEST(PlaneContact, BouncesBackToTheSameHeightWithoutDamping) {
  Ball system({.stiffness = 1e6, .exponent = 1.5});
  RungeKutta integrator(system, {.relative_tolerance = 1e-9, .absolute_tolerance = 1e-12, .max_step = 1e-3});
  double highest = 0, lowest = 1;
  integrator.advance(1.2, [&](const State& s) {
    if (s.t > 0.4) highest = std::max(highest, s.q[0]);
    lowest = std::min(lowest, s.q[0]);
  });
  // At most one step of 1 ms beside the top: g h^2 / 8 = 1e-6.
  EXPECT_NEAR(highest, 0.5, 3e-6);
  // Hertz: m g (h + p) = 2 k p^(5/2) / 5 at the lowest point.
  const double p = 0.1 - lowest;
  EXPECT_NEAR(0.4 * 1e6 * std::pow(p, 2.5), 9.81 * (0.4 + p), 9.81 * 0.4 * 1e-3);  // depth between steps
}

TEST(PlaneContact, LetsADroppedBallBounceTwiceByEvents) {
  Ball system({.stiffness = 1e6, .exponent = 1.5});
  RungeKutta integrator(system, {.relative_tolerance = 1e-9, .absolute_tolerance = 1e-12});
  integrator.watch({.name = "touch",
                    .function = [](const State& s) { return s.q[0] - 0.1; },
                    .direction = -1,
                    .stops = false});
  integrator.advance(1.2);
  ASSERT_EQ(integrator.events().size(), 2u);
  EXPECT_NEAR(integrator.events()[0].t, std::sqrt(2 * 0.4 / 9.81), 1e-9);  // free fall
}

// A ball thrown without spin slides until it rolls, at 5/7 of its speed, whatever the friction.
TEST(PlaneContact, MakesAThrownBallRollAtFiveSevenths) {
  class Bowl : public System {
   public:
    Coordinate x = coordinate("x", 0, 3.0), z = coordinate("z", 0.1 - 9.81e-5), a = coordinate("a");
    Body& ball = body("ball", Inertia::sphere(1.0, 0.1));
    PlaneContact contact{"lane",
                         {.stiffness = 1e5, .damping = 1, .friction = {.sliding = 0.2, .creep_speed = 1e-3}}};
    void positions() override { ball = translate(x, 0, z) * rotate_y(a); }
    void forces() override {
      gravity();
      contact.apply_sphere({}, ball, {0, 0, 0}, 0.1);
    }
  } system;
  Cvode integrator(system, {.relative_tolerance = 1e-8, .absolute_tolerance = 1e-10});
  integrator.advance(1);  // it slides for 2 v / (7 mu g) = 0.44 s
  // The material point at the bottom is 9.81e-5 / 0.1 nearer to the centre than the radius of the contact: no
  // difference, as the contact acts at the radius; the regularised friction fades as exp(-t ...).
  EXPECT_NEAR(integrator.state().qd[0], 3 * 5 / 7.0, 1e-4);
  EXPECT_NEAR(integrator.state().qd[2] * 0.1, 3 * 5 / 7.0, 1e-4);
}

TEST(PlaneContact, HoldsABlockOnASlopeBelowTheAngleOfFriction) {
  class Slope : public System {
   public:
    Coordinate s = coordinate("s"), n = coordinate("n", -1e-4);
    Body& block = body("block", 2.0);
    PlaneContact contact{"slope",
                         {.stiffness = 1e5, .damping = 1, .friction = {.sliding = 0.5, .creep_speed = 1e-4}}};
    double angle;
    Frame plane;
    explicit Slope(double a) : angle(a) {}
    void positions() override {
      plane = rotate_y(angle);
      block = plane * translate(s, 0, n);
    }
    void forces() override {
      gravity();
      contact.apply_point(plane, block);
    }
  };
  const auto slide = [](double angle) {
    Slope system(angle);
    Cvode integrator(system, {.relative_tolerance = 1e-8, .absolute_tolerance = 1e-10});
    integrator.advance(1);
    return integrator.state().qd[0];
  };
  EXPECT_LT(std::abs(slide(std::atan(0.45))), 1e-3);  // creeps
  const double a = std::atan(0.6);
  EXPECT_NEAR(slide(a), 9.81 * (std::sin(a) - 0.5 * std::cos(a)), 1e-2);  // slides: g (sin - mu cos) t
}

TEST(PlaneContact, CarriesAStandingAndALyingCylinderAlike) {
  PlaneContact contact("c", {.stiffness = 1e5});
  TwoBodies lying([&](TwoBodies& b) { contact.apply_cylinder(b.A, b.B, {0, 0, 0}, {0, 1, 0}, 0.2, 0.5); });
  State s = lying.initial_state();
  s.q[8] = 0.2 - 1e-3;
  Eigen::VectorXd Q = lying.forces_of_element(s);
  EXPECT_NEAR(Q[8], 2 * 1e5 * 1e-3, 1e-9);  // two points
  EXPECT_NEAR(Q.segment(9, 3).norm(), 0, 1e-9);
  TwoBodies standing([&](TwoBodies& b) { contact.apply_cylinder(b.A, b.B, {0, 0, 0}, {0, 0, 1}, 0.2, 0.5); });
  s.q[8] = 0.5 - 1e-3;
  Q = standing.forces_of_element(s);
  EXPECT_NEAR(Q[8], 4 * 1e5 * 1e-3, 1e-9);  // four points
  EXPECT_NEAR(Q.segment(9, 3).norm(), 0, 1e-9);
  // Slightly inclined the moment sets it upright, whichever way it leans.
  s.q[9] = 1e-4;
  EXPECT_LT(standing.forces_of_element(s)[9], 0);
  s.q[9] = -1e-4;
  EXPECT_GT(standing.forces_of_element(s)[9], 0);
}

TEST(PlaneContact, RefusesImpossibleData) {
  EXPECT_THROW(PlaneContact("c", {}), ModelError);
  EXPECT_THROW(PlaneContact("c", {.stiffness = 1, .exponent = 0.5}), ModelError);
  EXPECT_THROW(PlaneContact("c", {.stiffness = 1, .damping = -1}), ModelError);
}

// --- tyre ------------------------------------------------------------------------------------------------

const Tyre::Data passenger_car{.radius = 0.3,
                               .vertical_stiffness = 2e5,
                               .vertical_damping = 100,
                               .slip_stiffness = 6e4,
                               .friction = 0.9,
                               .patch_half_length = 0.06,
                               .low_speed = 1e-6};

// A wheel led by hand: steered, leaning, driven.
class LedWheel : public System {
 public:
  Coordinate x = coordinate("x", 0, 20.0), y = coordinate("y"), z = coordinate("z", 0.28),
             steer = coordinate("steer"), lean = coordinate("lean"), spin = coordinate("spin");
  Body& wheel = body("wheel", Inertia::cylinder_y(15, 0.3, 0.2));
  Frame carrier;
  Tyre tyre{"tyre", passenger_car};
  void positions() override {
    carrier = translate(x, y, z) * rotate_z(steer) * rotate_x(lean);
    wheel = carrier * rotate_y(spin);
  }
  void forces() override { tyre.apply({}, carrier, wheel); }
};

TEST(Tyre, FollowsTheBrushModelSideways) {
  LedWheel system;
  State s = system.initial_state();
  s.qd[5] = 20 / 0.28;
  for (double slip : {0.01, 0.05, -0.05, 0.3}) {
    s.qd[1] = slip * 20;  // drifts to the left
    system.evaluate(s);
    // Pacejka 2006, eqs. (3.11)-(3.18), by hand: F_z = 4 kN, theta = C / (3 mu F_z)
    const double F_z = 2e5 * 0.02, theta = 6e4 / (3 * 0.9 * F_z), t = std::min(1.0, theta * std::abs(slip));
    const double F_y = 0.9 * F_z * (1 - std::pow(1 - t, 3));
    EXPECT_NEAR(system.tyre.vertical_force(), F_z, 1e-9);
    EXPECT_NEAR(system.tyre.lateral_force(), slip > 0 ? -F_y : F_y, 1e-9 * F_z);
    EXPECT_NEAR(system.tyre.longitudinal_force(), 0, 1e-9 * F_z);
    const double M_z = 0.9 * F_z * 0.06 * t * std::pow(1 - t, 3);
    EXPECT_NEAR(system.tyre.aligning_moment(), slip > 0 ? M_z : -M_z, 1e-9 * F_z);
  }
}

TEST(Tyre, BrakesDrivesAndLimitsTheCombinedForce) {
  LedWheel system;
  State s = system.initial_state();
  s.qd[5] = 0.9 * 20 / 0.28;  // turns too slowly: brakes
  system.evaluate(s);
  EXPECT_NEAR(system.tyre.slip().x(), 0.1 / 0.9, 1e-9);
  EXPECT_LT(system.tyre.longitudinal_force(), 0);
  const double braking = system.tyre.longitudinal_force();
  s.qd[5] = 1.1 * 20 / 0.28;
  system.evaluate(s);
  EXPECT_GT(system.tyre.longitudinal_force(), 0);
  s.qd[5] = 0;  // locked, drifting: all slides against the sliding velocity
  s.qd[1] = 5;
  system.evaluate(s);
  const Eigen::Vector2d F(system.tyre.longitudinal_force(), system.tyre.lateral_force());
  EXPECT_NEAR(F.norm(), 0.9 * 4000, 1e-6);
  EXPECT_NEAR(F.y() / F.x(), 5.0 / 20, 1e-9);
  EXPECT_LT(braking, -0.5 * 0.9 * 4000);
}

TEST(Tyre, HasTheSlopeOfItsSlipStiffnessAtZeroSlip) {
  LedWheel system;
  State s = system.initial_state();
  s.qd[5] = 20 / 0.28;
  s.qd[1] = 1e-6 * 20;
  system.evaluate(s);
  EXPECT_NEAR(system.tyre.lateral_force(), -6e4 * 1e-6, 6e4 * 1e-6 * 1e-4);
}

TEST(Tyre, BalancesPowerSteeredAndLeaning) {
  LedWheel system;
  const auto Q_of = [&](const State& s) { return Eigen::VectorXd(-system.compute_residual(s)); };
  State s = system.initial_state();
  s.q << 0.3, -0.2, 0.27, 0.4, 0.3, 1.1;
  s.qd << 12, 1.5, -0.3, 0.2, -0.4, 45;
  State still = s;  // the same with a tyre that does not reach the road
  still.q[2] = 0.6;
  // The wheel's inertia does not depend on z: the difference is the tyre's.
  const Eigen::VectorXd Q = Q_of(s) - Q_of(still);
  const auto potential = [&](double h) {
    State moved = s;
    moved.q += h * s.qd;
    return system.compute_energy(moved).potential;
  };
  const double h = 1e-4;
  const double V_rate =
      (potential(-2 * h) - 8 * potential(-h) + 8 * potential(h) - potential(2 * h)) / (12 * h);
  const double D = system.compute_energy(s).dissipated;
  EXPECT_NEAR(s.qd.dot(Q) + V_rate + D, 0, 1e-8 * Q.cwiseProduct(s.qd).cwiseAbs().sum());
  EXPECT_GT(D, 0);
}

TEST(Tyre, RefusesImpossibleData) {
  EXPECT_THROW(Tyre("t", {}), ModelError);
  Tyre::Data data = passenger_car;
  data.friction = -1;
  EXPECT_THROW(Tyre("t", data), ModelError);
}

}  // namespace

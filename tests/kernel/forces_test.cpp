#include "tests/kernel/two_bodies.hpp"

using namespace easydyn;
using Eigen::Vector3d;

namespace {

class TwoBlocks : public System {
 public:
  Coordinate x1 = coordinate("x1", 0.1, 0.4), x2 = coordinate("x2", 0.25, -0.2);
  Body& lower = body("lower", 2.0);
  Body& upper = body("upper", 3.0);
  void positions() override {
    lower = translate(0, 0, x1);
    upper = translate(0, 0, 1 + x2);
  }
};

// Expects a ModelError whose text contains all the words.
template <class F>
void expect_refusal(F f, std::initializer_list<const char*> words) {
  try {
    f();
    ADD_FAILURE() << "accepted";
  } catch (const ModelError& e) {
    for (const char* word : words) EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what();
  }
}

TEST(SpringDamper, PullsItsEndsTogetherAndAccountsItsEnergy) {
  class Model : public TwoBlocks {
   public:
    SpringDamper spring{"spring", 100, 7, 0.9};
    void forces() override { spring.apply(lower, {0, 0, 0}, upper, {0, 0, 0}); }
  } system;
  const State s = system.initial_state();
  // By hand: length 1.15, stretch 0.25, rate -0.6: F = 25 - 4.2 = 20.8 N tension.
  const Eigen::VectorXd r = system.compute_residual(s);
  EXPECT_NEAR(system.spring.force(), 20.8, 1e-12);
  EXPECT_NEAR(r[0], -20.8, 1e-12);
  EXPECT_NEAR(r[1], 20.8, 1e-12);
  const EnergyBalance e = system.compute_energy(s);
  EXPECT_NEAR(e.potential, 0.5 * 100 * 0.25 * 0.25, 1e-12);
  EXPECT_NEAR(e.dissipated, 7 * 0.36, 1e-12);
}

TEST(SpringDamper, BalancesPowerInSpace) {
  SpringDamper spring("s", 300, 12, 0.7);
  TwoBodies system([&](TwoBodies& b) { spring.apply(b.A, {0.1, 0.2, -0.1}, b.B, {-0.2, 0.1, 0.3}); });
  for (int i = 0; i < 5; ++i) expect_balance(system, random_state(system, {0.5, 1, 0.8}));
}

TEST(Spring, AndDamperAreTheTwoPartsOfASpringDamper) {
  Spring spring("spring", 300, 0.7);
  Damper damper("damper", 12);
  SpringDamper both("both", 300, 12, 0.7);
  TwoBodies separate([&](TwoBodies& b) {
    spring.apply(b.A, {0.1, 0.2, -0.1}, b.B, {0, 0, 0});
    damper.apply(b.A, {0.1, 0.2, -0.1}, b.B, {0, 0, 0});
  });
  TwoBodies joined([&](TwoBodies& b) { both.apply(b.A, {0.1, 0.2, -0.1}, b.B, {0, 0, 0}); });
  const State s = random_state(separate, {1, 1, 1});
  EXPECT_LT((separate.forces_of_element(s) - joined.forces_of_element(s)).norm(), 1e-12 * 300);
}

TEST(Stops, PushBackAndNeverPull) {
  const Stops stops{.shortest = 0.2, .longest = 0.5, .stiffness = 1000, .damping = 2};
  EXPECT_EQ(stops.compute_force(0.3, -5).force, 0);
  // By hand: 0.1 beyond, moving out at 0.4 m/s: 1000 * 0.1 * (1 + 2 * 0.4) = 180 N back.
  EXPECT_NEAR(stops.compute_force(0.6, 0.4).force, -180, 1e-10);
  EXPECT_NEAR(stops.compute_force(0.1, -0.4).force, 180, 1e-10);
  EXPECT_EQ(stops.compute_force(0.6, -1).force, 0);  // comes back faster than the stop: it lets go
  EXPECT_NEAR(stops.compute_force(0.6, 0.4).potential, 5, 1e-12);
  EXPECT_NEAR(stops.compute_force(0.6, 0.4).dissipated, 80 * 0.4, 1e-10);
  EXPECT_NEAR(stops.compute_force(0.6, -1).dissipated, 100, 1e-10);  // what it had stored at that rate
}

TEST(Stops, OfASpringBalancePowerBeyondEitherEnd) {
  for (const Stops& stops : {Stops{.longest = 0.5, .stiffness = 5000, .damping = 0.3},
                             Stops{.shortest = 4, .stiffness = 5000, .damping = 0.3}}) {
    SpringDamper spring("s", 300, 12, 0.7);
    spring.set_stops(stops);
    TwoBodies system([&](TwoBodies& b) { spring.apply(b.A, {0.1, 0, 0}, b.B, {0, 0.1, 0}); });
    for (int i = 0; i < 5; ++i) expect_balance(system, random_state(system, {0.5, 1, 0.8}));
  }
}

// A mass thrown against a stop of the exponent 1: Hunt & Crossley's e = 1 - 2 c v / 3 to first order in c v.
TEST(Stops, RestituteAsHuntAndCrossleySay) {
  const double c = 0.05, v = 1.0, k = 1e5;
  class Model : public System {
   public:
    Coordinate x = coordinate("x", 0.1, -1.0);
    Body& mass = body("mass", 1.0);
    SpringDamper guide{"guide", 0, 0, 0};
    void positions() override { mass = translate(x, 0, 0); }
    void forces() override { guide.apply({}, {-1, 0, 0}, mass, {0, 0, 0}); }
  } system;
  system.guide.set_stops({.shortest = 1, .stiffness = k, .damping = c});
  RungeKutta integrator(system, {.relative_tolerance = 1e-9, .absolute_tolerance = 1e-12, .max_step = 1e-3});
  integrator.advance(0.15);
  EXPECT_GT(integrator.state().q[0], 0.01);
  const double e = integrator.state().qd[0] / v;
  // The exact law is implicit, e = 1 - 2 c v (1 + ...) / 3: second order is (2 c v / 3)^2 * 2 / 3 about 7e-4
  EXPECT_NEAR(e, 1 - 2 * c * v / 3, 1.5e-3);
  EXPECT_LT(e, 1);
}

TEST(VerticalSpringDamper, CarriesItsPreloadInTheNominalGeometry) {
  class Model : public TwoBlocks {
   public:
    VerticalSpringDamper suspension{"suspension", 100, 7, 1.0, 50};
    void forces() override { suspension.apply(lower, {0.2, 0, 0}, upper, {0.7, 0, 0}); }
  } system;
  // By hand: u = 0.15, u. = -0.6: F = 50 - 15 + 4.2 = 39.2 N compression.
  const State s = system.initial_state();
  const Eigen::VectorXd r = system.compute_residual(s);
  EXPECT_NEAR(system.suspension.force(), 39.2, 1e-12);
  EXPECT_NEAR(r[0], 39.2, 1e-12);
  EXPECT_NEAR(r[1], -39.2, 1e-12);
  const EnergyBalance e = system.compute_energy(s);
  EXPECT_NEAR(e.potential, 0.5 * 100 * 0.15 * 0.15 - 50 * 0.15, 1e-12);
  EXPECT_NEAR(e.dissipated, 7 * 0.36, 1e-12);
}

TEST(VerticalSpringDamper, BalancesPowerInSpace) {
  VerticalSpringDamper suspension("s", 300, 12, 0.7, 40);
  TwoBodies system([&](TwoBodies& b) { suspension.apply(b.A, {0.1, 0.2, -0.1}, b.B, {-0.2, 0.1, 0.3}); });
  for (int i = 0; i < 5; ++i) expect_balance(system, random_state(system, {0.5, 1, 0.8}));
}

// --- torsion ---------------------------------------------------------------------------------------------

class TwoDiscs : public System {
 public:
  Coordinate a = coordinate("a", 0.2, 1.0), b = coordinate("b", 2.5, -0.5);
  Body& first = body("first", Inertia(1, 0.1));
  Body& second = body("second", Inertia(1, 0.2));
  TorsionalSpringDamper spring{"shaft", 40, 3, 0.5};
  bool is_measured = false;
  void positions() override {
    first = rotate_z(a);
    second = rotate_z(b);
  }
  void forces() override {
    if (is_measured) {
      spring.apply(first, second, {0, 0, 2});
    } else {
      spring.apply(first, second, {0, 0, 2}, b.value() - a.value());
    }
  }
};

TEST(TorsionalSpringDamper, TurnsItsEndsTogether) {
  TwoDiscs system;
  const State s = system.initial_state();
  // By hand: turn 2.3 - 0.5 = 1.8 rad, rate -1.5 rad/s: M = 72 - 4.5 = 67.5 N m.
  const Eigen::VectorXd r = system.compute_residual(s);
  EXPECT_NEAR(r[0], -67.5, 1e-12);
  EXPECT_NEAR(r[1], 67.5, 1e-12);
  EXPECT_NEAR(system.compute_energy(s).potential, 0.5 * 40 * 1.8 * 1.8, 1e-12);
  EXPECT_NEAR(system.compute_energy(s).dissipated, 3 * 1.5 * 1.5, 1e-12);
  system.is_measured = true;
  EXPECT_LT((system.compute_residual(s) - r).norm(), 1e-12);
}

TEST(TorsionalSpringDamper, StopsAtItsStops) {
  TwoDiscs system;
  system.spring.set_stops({.longest = 2.2, .stiffness = 1000});
  // 0.1 rad beyond: 100 N m more.
  EXPECT_NEAR(system.compute_residual(system.initial_state())[1], 167.5, 1e-10);
}

TEST(TorsionalSpringDamper, CountsFullTurnsWhereTheCoordinateDoes) {
  TwoDiscs system;
  State s = system.initial_state();
  s.q[1] += 4 * M_PI;
  EXPECT_NEAR(system.compute_residual(s)[1], 67.5 + 40 * 4 * M_PI, 1e-10);
  system.is_measured = true;
  EXPECT_NEAR(system.compute_residual(s)[1], 67.5, 1e-10);
}

// --- bushing ---------------------------------------------------------------------------------------------

TEST(Bushing, BalancesPowerAtLargeDisplacementsAndRotations) {
  Bushing bushing("b", {.stiffness = {100, 200, 300},
                        .rotational_stiffness = {10, 20, 30},
                        .damping = {1, 2, 3},
                        .rotational_damping = {0.1, 0.2, 0.3}});
  TwoBodies system([&](TwoBodies& b) { bushing.apply(b.A, b.B); });
  for (int i = 0; i < 10; ++i) expect_balance(system, random_state(system, {0.5, 0.2, 0.1}, 0.9));
}

TEST(Bushing, ResistsAlongItsSixAxes) {
  Bushing bushing("b", {.stiffness = {100, 200, 300}, .rotational_stiffness = {10, 20, 30}});
  TwoBodies system([&](TwoBodies& b) { bushing.apply(b.A, b.B); });
  const double expected[6] = {100, 200, 300, 10, 20, 30};
  for (int i = 0; i < 6; ++i) {
    State s = system.initial_state();
    s.q[6 + i] = 0.01;
    const Eigen::VectorXd Q = system.forces_of_element(s);
    EXPECT_NEAR(Q[6 + i], -expected[i] * 0.01, 1e-12) << i;
    EXPECT_NEAR(Q[i], i < 3 ? expected[i] * 0.01 : expected[i] * 0.01, 1e-12) << i;
  }
}

TEST(Bushing, ExertsNoForceAtRest) {
  Bushing bushing("b", {.stiffness = {100, 200, 300}, .rotational_stiffness = {10, 20, 30}});
  TwoBodies system([&](TwoBodies& b) { bushing.apply(b.A, b.B); });
  EXPECT_EQ(system.forces_of_element(system.initial_state()).norm(), 0);
}

// --- laws ------------------------------------------------------------------------------------------------

TEST(NonlinearSpringDamper, FollowsTableAndFunctionAndBalancesPower) {
  const auto progressive = Characteristic::table("spring", {-1, 0, 1, 2}, {-50, 0, 100, 400});
  const auto blow_off = Characteristic::function([](double v) { return 80 * std::tanh(v); });
  NonlinearSpringDamper spring("s", progressive, blow_off, 0.7);
  TwoBodies system([&](TwoBodies& b) { spring.apply(b.A, {0.1, 0, 0}, b.B, {0, 0.1, 0}); });
  for (int i = 0; i < 5; ++i) {
    const State s = random_state(system, {0.5, 1, 0.8});
    expect_balance(system, s);
    system.evaluate(s);
    const double stretch = spring.length() - 0.7;
    EXPECT_NE(stretch, 0);
  }
}

TEST(NonlinearSpringDamper, OfACubicLawHasTheFrequencyOfDuffing) {
  // x.. + x + x^3 = 0 from x = 1 at rest: period 4 K(m) / sqrt(2), m = 1/4 (first integral).
  class Model : public System {
   public:
    Coordinate x = coordinate("x", 1.0);
    Body& mass = body("mass", 1.0);
    NonlinearSpringDamper spring{"cubic", Characteristic::function([](double u) { return u + u * u * u; }),
                                 5};
    void positions() override { mass = translate(x, 0, 0); }
    void forces() override { spring.apply({}, {-5, 0, 0}, mass, {0, 0, 0}); }
  } system;
  RungeKutta integrator(system, {.relative_tolerance = 1e-10, .absolute_tolerance = 1e-12});
  const double period = 4 * std::comp_ellint_1(std::sqrt(0.25)) / std::sqrt(2.0);
  integrator.advance(period);
  EXPECT_NEAR(integrator.state().q[0], 1, 1e-8);
  EXPECT_NEAR(integrator.state().qd[0], 0, 1e-7);
  // the energy by quadrature: u^2 / 2 + u^4 / 4
  EXPECT_NEAR(system.compute_energy(integrator.state()).potential, 0.75, 1e-8);
}

// --- friction --------------------------------------------------------------------------------------------

TEST(FrictionLaw, PassesFromStickingToSliding) {
  const FrictionLaw law{.sliding = 0.3, .sticking = 0.5, .creep_speed = 1e-3, .stribeck_speed = 0.1};
  EXPECT_EQ(law.coefficient(0), 0);
  EXPECT_NEAR(law.coefficient(0.01), 0.5, 0.003);  // beyond creep, far below Stribeck's speed
  EXPECT_NEAR(law.coefficient(1), 0.3, 1e-12);
  EXPECT_NEAR(law.coefficient(-1), -0.3, 1e-12);
  EXPECT_NEAR(law.coefficient(1e-6), 0.5e-3, 1e-9);
}

TEST(Friction, BalancesPowerInSlidingAndTurning) {
  Friction guide("guide", {.sliding = 0.3}), bearing("bearing", {.sliding = 0.2, .creep_speed = 0.01});
  TwoBodies system([&](TwoBodies& b) {
    guide.apply_sliding(b.A, b.B, {1, 2, 0}, 50);
    bearing.apply_turning(b.A, b.B, {0, 1, 1}, 4);
  });
  for (int i = 0; i < 5; ++i) expect_balance(system, random_state(system, {0.5, 0.1, 0.2}));
}

TEST(Friction, StopsASliderAfterTheDistanceOfCoulomb) {
  class Model : public System {
   public:
    Coordinate x = coordinate("x", 0, 2.0);
    Body& slider = body("slider", 1.5);
    Friction friction{"guide", {.sliding = 0.25, .creep_speed = 1e-4}};
    void positions() override { slider = translate(x, 0, 0); }
    void forces() override { friction.apply_sliding({}, slider, {1, 0, 0}, 1.5 * 9.81); }
  } system;
  Cvode integrator(system, {.relative_tolerance = 1e-8, .absolute_tolerance = 1e-10});
  integrator.advance(1.2);
  // v^2 / (2 mu g) = 0.8155 m; it has stopped after v / (mu g) = 0.815 s. The regularisation adds about
  // v0^2 log(...) / (mu g), below 1e-7.
  EXPECT_NEAR(integrator.state().q[0], 4 / (2 * 0.25 * 9.81), 1e-6);
  EXPECT_LT(std::abs(integrator.state().qd[0]), 1e-6);
}

// --- from outside ----------------------------------------------------------------------------------------

TEST(Actuator, SuppliesItsPower) {
  Actuator cylinder("cylinder"), motor("motor");
  TwoBodies system([&](TwoBodies& b) {
    cylinder.apply_force(b.A, {0.1, 0, 0}, b.B, {0, 0.1, 0}, 70);
    motor.apply_moment(b.A, b.B, {0, 0, 3}, -5);
  });
  for (int i = 0; i < 5; ++i) expect_balance(system, random_state(system, {0.5, 1, 0.8}));
  EXPECT_EQ(cylinder.effort(), 70);
}

TEST(Actuator, PushesItsEndsApart) {
  class Model : public TwoBlocks {
   public:
    Actuator cylinder{"cylinder"};
    void forces() override { cylinder.apply_force(lower, {0, 0, 0}, upper, {0, 0, 0}, 10); }
  } system;
  const Eigen::VectorXd r = system.compute_residual(system.initial_state());
  EXPECT_NEAR(r[0], 10, 1e-12);  // downward on the lower
  EXPECT_NEAR(r[1], -10, 1e-12);
  EXPECT_NEAR(system.cylinder.power(), 10 * -0.6, 1e-12);
}

TEST(ExternalForce, ActsAsItsFunctionSaysAndSuppliesItsPower) {
  ExternalForce force("wind", [](double t, const Vector3d& p, const Vector3d& v) {
    return Vector3d(10 * t, 3 * p.y(), -2 * v.z());
  });
  ExternalMoment moment("drive", [](double t, const Vector3d& w) { return Vector3d(0, t, -0.5 * w.z()); });
  TwoBodies system([&](TwoBodies& b) {
    force.apply(b.B, {0, 0, 0});
    moment.apply(b.A);
  });
  const State s = random_state(system, {0.5, 1, 0.8});
  expect_balance(system, s, true);
  system.evaluate(s);
  EXPECT_NEAR(force.force().x(), 3, 1e-12);
  EXPECT_NEAR(force.force().y(), 3 * s.q[7], 1e-12);
  EXPECT_NEAR(force.force().z(), -2 * s.qd[8], 1e-12);
  EXPECT_NEAR(moment.moment().y(), 0.3, 1e-12);
}

// --- data ------------------------------------------------------------------------------------------------

TEST(ForceElements, RefuseImpossibleDataByName) {
  expect_refusal([] { SpringDamper("primary", -5, 0, 0); }, {"primary", "stiffness", "-5", ">= 0"});
  expect_refusal([] { SpringDamper("primary", 1, std::nan(""), 0); }, {"primary", "damping"});
  expect_refusal([] { SpringDamper("p", 1, 0, 0).set_stops({.shortest = 2, .longest = 1, .stiffness = 1}); },
                 {"p", "stops at 2 and 1"});
  expect_refusal([] { SpringDamper("p", 1, 0, 0).set_stops({.shortest = 0}); }, {"stiffness of the stops"});
  expect_refusal([] { VerticalSpringDamper("s", std::nan(""), 0); }, {"stiffness"});
  expect_refusal([] { VerticalSpringDamper("s", 1, 0, 0, INFINITY); }, {"preload"});
  expect_refusal([] { TorsionalSpringDamper("shaft", 1, -1); }, {"shaft", "damping"});
  expect_refusal([] { Bushing("b", {.stiffness = {1, -2, 3}}); }, {"\"b\"", "stiffness y", "-2"});
  expect_refusal([] { Friction("f", {.sliding = 0.3, .sticking = 0.2}); }, {"sticking", "0.2"});
  expect_refusal([] { Friction("f", {.sliding = 0.3, .creep_speed = 0}); }, {"creep speed"});
  expect_refusal([] { Characteristic::table("spring \"k\"", {0, 0}, {1, 2}); }, {"\"k\"", "point 2"});
  expect_refusal([] { Characteristic::table("spring \"k\"", {0}, {1}); }, {"at least 2"});
}

TEST(ForceElements, RefuseWhatHasNoDirectionOrIsNotFinite) {
  SpringDamper spring("primary", 1, 0, 0);
  TwoBodies coinciding([&](TwoBodies& b) { spring.apply(b.A, {0, 0, 0}, b.B, {0, 0, 0}); });
  expect_refusal([&] { coinciding.evaluate(coinciding.initial_state()); }, {"primary", "coincide"});
  Actuator motor("motor");
  TwoBodies wild([&](TwoBodies& b) { motor.apply_moment(b.A, b.B, {0, 0, 1}, std::nan("")); });
  expect_refusal([&] { wild.evaluate(wild.initial_state()); }, {"motor", "finite"});
}

}  // namespace

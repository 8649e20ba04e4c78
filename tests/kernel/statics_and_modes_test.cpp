#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "easydyn/easydyn.hpp"

using namespace easydyn;

namespace {

constexpr double m1 = 40, m2 = 300, k1 = 2e5, k2 = 1.8e4, d2 = 1200;

class QuarterCar : public System {
 public:
  explicit QuarterCar(double damping) : suspension("suspension", k2, damping) {}
  Coordinate z1 = coordinate("wheel"), z2 = coordinate("body");
  Body& wheel = body("wheel", m1);
  Body& car = body("car", m2);
  VerticalSpringDamper tyre{"tyre", k1, 0};
  VerticalSpringDamper suspension;
  void positions() override {
    wheel = translate(0, 0, z1);
    car = translate(0, 0, z2);
  }
  void forces() override {
    gravity();
    tyre.apply(Frame(), {0, 0, 0}, wheel, {0, 0, 0});
    suspension.apply(wheel, {0, 0, 0}, car, {0, 0, 0});
  }
};

TEST(StaticEquilibrium, OfTheQuarterCarIsThatOfTwoSpringsInSeries) {
  QuarterCar system(d2);
  const State s = solve_static_equilibrium(system);
  const double g = 9.81, wheel = -(m1 + m2) * g / k1;
  EXPECT_NEAR(s.q[0], wheel, 1e-14);
  EXPECT_NEAR(s.q[1], wheel - m2 * g / k2, 1e-13);
  EXPECT_LT(system.compute_residual(s).lpNorm<Eigen::Infinity>(), 1e-10 * (m1 + m2) * g);
}

TEST(StaticEquilibrium, FindsALargeRotation) {
  // A rod on a torsional spring k falls to the angle where k a = m g l sin a.
  class Rod : public System {
   public:
    Coordinate a = coordinate("a", 1.2);
    Body& rod = body("rod", Inertia(2.0, 0.1));
    void positions() override { rod = rotate_y(a) * translate(0, 0, 0.5); }
    void forces() override {
      gravity();
      rod.add_moment({0, -5 * a.value(), 0});
    }
  } system;
  const State s = solve_static_equilibrium(system);
  EXPECT_GT(s.q[0], 0.5);
  EXPECT_NEAR(5 * s.q[0], 2 * 9.81 * 0.5 * std::sin(s.q[0]), 1e-11);
}

TEST(StaticEquilibrium, NamesTheCoordinateThatNothingHolds) {
  class Falling : public System {
   public:
    Coordinate held = coordinate("held"), loose = coordinate("loose");
    Body& a = body("a", 1.0);
    Body& b = body("b", 1.0);
    void positions() override {
      a = translate(0, 0, held);
      b = translate(0, 0, loose);
    }
    void forces() override {
      gravity();
      a.add_force({0, 0, -100 * held.value()}, a.position());
    }
  } system;
  try {
    solve_static_equilibrium(system);
    FAIL();
  } catch (const SolverError& e) {
    EXPECT_NE(std::string(e.what()).find("\"loose\""), std::string::npos) << e.what();
  }
}

// A rod turned by hand about the vertical: thrown out to cos(a) = g / (w^2 l) (point mass), from hanging, which is an
// equilibrium as well but one that it would leave.
TEST(StaticEquilibrium, LetsGoOfAnEquilibriumThatWouldNotHold) {
  class Governor : public System {
   public:
    Coordinate a = coordinate("a", 1e-3);
    Body& ball = body("ball", 2.0);
    void positions() override { ball = rotate_z(8.0 * time()) * rotate_y(a) * translate(0, 0, -0.5); }
    void forces() override { gravity(); }
  } governor;
  const State s = solve_static_equilibrium(governor);
  const double expected = std::acos(9.81 / (64 * 0.5));
  EXPECT_NEAR(s.q[0], expected, 1e-8);
}

TEST(StaticEquilibrium, OfARodReleasedLevelIsHanging) {
  class Rod : public System {
   public:
    Coordinate a = coordinate("a", M_PI / 2);
    Body& rod = body("rod", 1.0);
    void positions() override { rod = rotate_y(a) * translate(0, 0, -1); }
    void forces() override { gravity(); }
  } rod;
  EXPECT_NEAR(solve_static_equilibrium(rod).q[0], 0, 1e-8);
  State s = rod.initial_state();
  s.q[0] = M_PI;  // upright, exactly: an equilibrium that is asked for stays
  EXPECT_NEAR(solve_static_equilibrium(rod, s).q[0], M_PI, 1e-8);
}

TEST(StaticEquilibrium, OfAnEquilibriumIsItself) {
  class Heavy : public System {
   public:
    Coordinate z = coordinate("z");
    Body& mass = body("mass", 1e4);
    VerticalSpringDamper spring{"spring", 1e9, 0};
    void positions() override { mass = translate(0, 0, z); }
    void forces() override {
      gravity();
      spring.apply({}, {0, 0, 0}, mass, {0, 0, 0});
    }
  } heavy;
  const State s = solve_static_equilibrium(heavy);
  EXPECT_NEAR(s.q[0], -9.81e-5, 1e-17);
  EXPECT_NEAR(solve_static_equilibrium(heavy, s).q[0], -9.81e-5, 1e-17);
}

// Far from equilibrium, over springs that bend their force twice: Newton's way is barred by a maximum.
TEST(StaticEquilibrium, IsReachedFromFarAwayByDamping) {
  class Snap : public System {
   public:
    Coordinate x = coordinate("x", -2.0);
    Body& mass = body("mass", 1.0);
    NonlinearSpringDamper spring{"arctan", Characteristic::function([](double u) {
                                   return 50 * std::atan(20 * (u - 6)) + 3 * std::sin(2 * u);
                                 }),
                                 0};
    void positions() override { mass = translate(10 + x, 0, 0); }
    void forces() override { spring.apply({}, {0, 0, 0}, mass, {0, 0, 0}); }
  } snap;
  // Newton alone comes to rest where the wavy force is least, which is no equilibrium.
  EXPECT_THROW(solve_static_equilibrium(snap, {.damping = false}), SolverError);
  const State s = solve_static_equilibrium(snap);
  EXPECT_NEAR(snap.compute_residual(s)[0], 0, 1e-6);
  EXPECT_NEAR(s.q[0], -4, 0.1);  // the force changes sign near u = 6
}

TEST(StaticEquilibrium, PassesOnTheErrorsOfTheUsersProgram) {
  class Thrower : public System {
   public:
    Coordinate x = coordinate("x");
    Body& a = body("a", 1.0);
    int evaluations = 0;
    void positions() override { a = translate(0, 0, x); }
    void forces() override {
      if (++evaluations > 3) throw ModelError("table: out of range");
      gravity();
      a.add_force({0, 0, -100 * x.value()}, a.position());
    }
  } system;
  EXPECT_THROW(solve_static_equilibrium(system), ModelError);
}

TEST(Modes, OfTheUndampedQuarterCarAreThoseOfTheClosedForm) {
  QuarterCar system(0);
  const std::vector<Mode> modes = compute_modes(linearize(system, system.initial_state(), 0.1));
  // m1 m2 w^4 - (m1 k2 + m2 (k1 + k2)) w^2 + k1 k2 = 0
  const double a = m1 * m2, b = m1 * k2 + m2 * (k1 + k2), c = k1 * k2, root = std::sqrt(b * b - 4 * a * c);
  const double w1 = std::sqrt(2 * c / (b + root)), w2 = std::sqrt((b + root) / (2 * a));
  ASSERT_EQ(modes.size(), 2u);
  EXPECT_NEAR(modes[0].frequency * 2 * std::numbers::pi / w1, 1, 1e-12);
  EXPECT_NEAR(modes[1].frequency * 2 * std::numbers::pi / w2, 1, 1e-12);
  EXPECT_EQ(modes[0].damping, 0);
  EXPECT_NEAR(modes[0].shape[0].real(), (k2 - m2 * w1 * w1) / k2, 1e-11);  // body = 1
}

TEST(Modes, OfTheDampedQuarterCarSatisfyItsCharacteristicEquation) {
  QuarterCar system(d2);
  const std::vector<Mode> modes = compute_modes(linearize(system, system.initial_state(), 0.1));
  ASSERT_EQ(modes.size(), 2u);
  for (const Mode& mode : modes) {
    const std::complex<double> p = mode.pole;
    const std::complex<double> value =
        (m1 * p * p + d2 * p + k1 + k2) * (m2 * p * p + d2 * p + k2) - (d2 * p + k2) * (d2 * p + k2);
    EXPECT_LT(std::abs(value), 1e-10 * k1 * k2);
    EXPECT_GT(mode.damping, 0.05);
    EXPECT_LT(p.real(), 0);
  }
}

TEST(Modes, OfAFreeBodyHaveZeroFrequency) {
  class Free : public System {
   public:
    Coordinate x = coordinate("x");
    Body& b = body("b", 3.0);
    void positions() override { b = translate(x, 0, 0); }
  } system;
  const auto modes = compute_modes(linearize(system, system.initial_state()));
  ASSERT_EQ(modes.size(), 1u);
  EXPECT_EQ(modes[0].frequency, 0);
  EXPECT_EQ(modes[0].damping, 0);
}

}  // namespace

// What users do wrong is refused by name, and what they may do at an unusual time has its effect.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "easydyn/easydyn.hpp"

using namespace easydyn;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

namespace {

TEST(Body, IsRefusedBeforeItIsPlaced) {
  class WrongOrder : public System {
   public:
    Coordinate a = coordinate("a"), b = coordinate("b");
    Body &first = body("first", 1.0), &second = body("second", 1.0);
    void positions() override {
      second = first * rotate_y(b) * translate(0, 0, -1);
      first = rotate_y(a) * translate(0, 0, -1);
    }
  } system;
  for (int i = 0; i < 2; ++i)  // also where an evaluation before has left a frame
    EXPECT_THAT([&] { system.evaluate(system.initial_state()); },
                ThrowsMessage<ModelError>(HasSubstr("body \"first\" is used before positions() places it")));
}

TEST(Body, IsNotPlacedInsideTheEquationsOfALoop) {
  class FourBar : public System {
   public:
    Coordinate crank = coordinate("crank", 1.0);
    Body& coupler = body("coupler", 1.0);
    Loop<2> closing = loop<2>("four-bar", {0.3, 1.2});
    void positions() override {
      closing.solve([&](const auto& p) {
        coupler = rotate_z(crank) * translate(1, 0, 0) * rotate_z(p[0] - crank);
        return std::array{cos(crank) + 3 * cos(p[0]) - 2 * cos(p[1]) - 2.5,
                          sin(crank) + 3 * sin(p[0]) - 2 * sin(p[1])};
      });
    }
  } system;
  EXPECT_THAT([&] { system.evaluate(system.initial_state()); },
              ThrowsMessage<ModelError>(
                  AllOf(HasSubstr("body \"coupler\""), HasSubstr("place it after the loop is solved"))));
}

class Pendulum : public System {
 public:
  Coordinate a = coordinate("a", 1.0);
  Body& bob = body("bob", 1.0);
  void positions() override { bob = rotate_y(a) * translate(0, 0, -1); }
  void forces() override { gravity(); }
};

TEST(Frame, OfAnotherSystemIsRefused) {
  Pendulum other;
  class Hanging : public System {
   public:
    const Body* support = nullptr;
    Coordinate b = coordinate("b");
    Body& load = body("load", 1.0);
    void positions() override { load = *support * rotate_y(b) * translate(0, 0, -1); }
  } system;
  system.support = &other.bob;
  other.evaluate(other.initial_state());
  EXPECT_THAT([&] { system.evaluate(system.initial_state()); },
              ThrowsMessage<ModelError>(HasSubstr("frame of another system")));
}

TEST(System, IsNotEvaluatedInsideItsOwnForces) {
  class Recursive : public Pendulum {
   public:
    void forces() override { compute_energy(initial_state()); }
  } system;
  EXPECT_THAT([&] { system.evaluate(system.initial_state()); },
              ThrowsMessage<ModelError>(HasSubstr("inside its own positions() or forces()")));
}

TEST(Forces, OutsideForcesAreRefusedInsteadOfLost) {
  Pendulum p;
  p.evaluate(p.initial_state());
  const auto refused = ThrowsMessage<ModelError>(HasSubstr("act inside forces() only"));
  EXPECT_THAT([&] { p.bob.add_force({1, 0, 0}, p.bob.position()); }, refused);
  EXPECT_THAT([&] { p.bob.add_moment({1, 0, 0}); }, refused);
  class TooEarly : public Pendulum {
   public:
    void positions() override {
      Pendulum::positions();
      bob.add_force({1, 0, 0}, bob.position());
    }
  } early;
  EXPECT_THAT([&] { early.evaluate(early.initial_state()); }, refused);
}

TEST(Linearization, LeavesInputsAsTheyWereWhereItThrows) {
  class Touchy : public Pendulum {
   public:
    Input u = input("u", 0.25);
    void forces() override {
      Pendulum::forces();
      if (u.value() > 0.25) throw ModelError("beyond the table");
    }
  } system;
  EXPECT_THROW(linearize(system, system.initial_state()), ModelError);
  EXPECT_EQ(system.u.value(), 0.25);
  EXPECT_THROW(linearize_state_space(system, system.initial_state()), ModelError);
  EXPECT_EQ(system.u.value(), 0.25);
}

TEST(System, RefusesTwoThingsOfOneName) {
  Pendulum p;
  EXPECT_THROW(p.body("bob", 1.0), ModelError);
  p.input("u");
  EXPECT_THROW(p.input("u"), ModelError);
  p.output("y");
  EXPECT_THROW(p.output("y"), ModelError);
  p.first_order_state("x");
  EXPECT_THROW(p.first_order_state("x"), ModelError);
  p.reaction("r");
  EXPECT_THROW(p.reaction("r"), ModelError);
  p.velocity_constraint("c");
  EXPECT_THROW(p.velocity_constraint("c"), ModelError);
}

TEST(Reaction, ThatIsNeverCutIsRefusedByName) {
  Pendulum p;
  const Reaction forgotten = p.reaction("forgotten");
  EXPECT_THROW(forgotten.force(), ModelError);
  EXPECT_THAT(
      [&] { p.compute_reactions(p.initial_state()); },
      ThrowsMessage<ModelError>(HasSubstr("reaction \"forgotten\" of system \"system\" is cut 0 times")));
}

TEST(Integrators, RefuseCoordinatesThatAreHeldDuringARun) {
  Pendulum p;
  Newmark newmark(p, {.step = 1e-3});
  RungeKutta runge_kutta(p);
  p.a.lock(0.5);
  EXPECT_THROW(newmark.step(), ModelError);
  EXPECT_THROW(runge_kutta.step(), ModelError);
}

TEST(Integrators, RefuseAnEndThatIsNoTime) {
  Pendulum p;
  Newmark newmark(p, {.step = 1e-3});
  RungeKutta runge_kutta(p);
  EXPECT_THROW(newmark.advance(std::nan("")), ModelError);
  EXPECT_THROW(runge_kutta.advance(std::nan("")), ModelError);
}

TEST(Integrators, FollowAMechanismWithoutFreeCoordinates) {
  const auto run = [](auto make) {
    Pendulum p;
    p.a.prescribe([](double t) { return ImposedMotion(2 * t, 2, 0); });
    auto integrator = make(p);
    int steps = 0;
    integrator->advance(0.3, [&](const State&) { ++steps; });
    EXPECT_NEAR(integrator->state().t, 0.3, 1e-9);
    EXPECT_GT(steps, 10);
    // inverse dynamics: the moment of the drive carries the weight
    p.evaluate(integrator->state());
    EXPECT_NEAR(p.holding_force(p.a), 9.81 * std::sin(0.6), 1e-9);
  };
  run([](System& s) { return std::make_unique<Newmark>(s, StepperOptions{.step = 1e-2}); });
  run([](System& s) { return std::make_unique<RungeKutta>(s); });
  run([](System& s) { return std::make_unique<Cvode>(s); });
  run([](System& s) { return std::make_unique<Ida>(s); });
}

// An oscillator pushed from t = 0.5 on: closed form 1 - cos(w (t - 0.5)) times F / k.
class Pushed : public System {
 public:
  Coordinate x = coordinate("x");
  Input push = input("push");
  Body& mass = body("mass", 1.0);
  SpringDamper spring{"spring", 100, 0, 1};
  void positions() override { mass = translate(1 + x, 0, 0); }
  void forces() override {
    spring.apply({}, {0, 0, 0}, mass, {0, 0, 0});
    mass.add_force({push.value(), 0, 0}, mass.position());
  }
};

template <class Make>
double error_after_a_push(Make make) {
  Pushed system;
  auto integrator = make(system);
  integrator->advance(0.5);
  system.push.set(10);
  integrator->advance(1.0);
  return std::abs(integrator->state().q[0] - 0.1 * (1 - std::cos(10 * 0.5)));
}

TEST(Inputs, SetDuringARunActFromTheNextStepOn) {
  const auto newmark = [](double h) {
    return error_after_a_push(
        [h](System& s) { return std::make_unique<Newmark>(s, StepperOptions{.step = h}); });
  };
  EXPECT_NEAR(std::log2(newmark(2e-3) / newmark(1e-3)), 2, 0.1);
  const AdaptiveOptions tight{.relative_tolerance = 1e-9, .absolute_tolerance = 1e-11};
  EXPECT_LT(error_after_a_push([&](System& s) { return std::make_unique<RungeKutta>(s, tight); }), 1e-8);
  EXPECT_LT(error_after_a_push([&](System& s) { return std::make_unique<Cvode>(s, tight); }), 1e-7);
  EXPECT_LT(error_after_a_push([&](System& s) { return std::make_unique<Ida>(s, tight); }), 1e-7);
}

TEST(Integrators, TryASmallerStepWhereATrialIsBeyondTheSystem) {
  class Bounded : public Pushed {
   public:
    void forces() override {
      if (std::abs(x.value()) > 1.05) throw SolverError("beyond");
      Pushed::forces();
    }
  } system;
  State s = system.initial_state();
  s.q[0] = 1;
  RungeKutta runge_kutta(system, s, {.first_step = 0.5});
  runge_kutta.advance(1);
  EXPECT_NEAR(runge_kutta.state().q[0], std::cos(10.0), 1e-4);
  GeneralizedAlpha alpha(system, s, {.step = 0.5, .variable_step = true, .tolerance = 1e-6});
  alpha.advance(1);
  EXPECT_NEAR(alpha.state().q[0], std::cos(10.0), 0.02);
}

TEST(Output, GivenByAFunctionSeesTheAccelerations) {
  class Sensor : public Pushed {
   public:
    Output acceleration = output("acceleration", [this] { return mass.acceleration().x(); });
  } system;
  const StateSpace space = linearize_state_space(system, system.initial_state());
  EXPECT_NEAR(space.C(0, 0), -100, 1e-7);
  EXPECT_NEAR(space.D(0, 0), 1, 1e-9);

  class TooEarly : public Pushed {
   public:
    void forces() override { (void)mass.acceleration(); }
  } early;
  EXPECT_THAT([&] { early.evaluate(early.initial_state()); },
              ThrowsMessage<ModelError>(HasSubstr("accelerations are known after an evaluation")));
}

TEST(Newmark, StartsFromAccelerationsThatSatisfyTheEquations) {
  Pushed system;
  State s = system.initial_state();
  s.q[0] = 1;  // qdd = 0 would be wrong
  Newmark newmark(system, s, {.step = 1e-3});
  EXPECT_NEAR(newmark.state().qdd[0], -100, 1e-9);
}

}  // namespace

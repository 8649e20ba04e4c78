#include "easydyn/sim/adaptive_integrator.hpp"

#include <gmock/gmock.h>

#include "easydyn/easydyn.hpp"

namespace easydyn {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// A point on a rod of 1 m.
class Pendulum : public System {
 public:
  explicit Pendulum(double angle) : a(coordinate("a", angle)) {}
  Coordinate a;
  Body& bob = body("bob", 1.0);

 protected:
  void positions() override { bob = rotate_y(a) * translate(0, 0, -1); }
  void forces() override { gravity(); }
};

/// Complete elliptic integral by the arithmetic-geometric mean: period 4 K(sin(a0 / 2)) / w.
double exact_period(double amplitude) {
  double a = 1, b = std::cos(amplitude / 2);
  for (int i = 0; i < 8; ++i) {
    const double mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
  }
  return 2 * M_PI / std::sqrt(9.81) / a;
}

// The table of the tests: a method by its name.
using Make = std::function<std::unique_ptr<AdaptiveIntegrator>(System&, const AdaptiveOptions&)>;
struct Method {
  const char* name;
  Make make;
  double factor;  ///< allowed error after a period / relative tolerance; measured: adaptive_integrator.hpp
};
const Method methods[] = {
    {"runge_kutta", [](System& s, const AdaptiveOptions& o) { return std::make_unique<RungeKutta>(s, o); },
     50},
    {"adams",
     [](System& s, const AdaptiveOptions& o) { return std::make_unique<Cvode>(s, o, Cvode::Method::adams); },
     500},
    {"bdf", [](System& s, const AdaptiveOptions& o) { return std::make_unique<Cvode>(s, o); }, 1000},
    {"ida", [](System& s, const AdaptiveOptions& o) { return std::make_unique<Ida>(s, o); }, 250}};

class Adaptive : public testing::TestWithParam<Method> {};
INSTANTIATE_TEST_SUITE_P(All, Adaptive, testing::ValuesIn(methods),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(Adaptive, ComesBackAfterAPeriodWithinItsTolerance) {
  const double amplitude = 2.5;
  for (const double tolerance : {1e-5, 1e-7, 1e-9}) {
    Pendulum pendulum(amplitude);
    const auto integrator =
        GetParam().make(pendulum, {.relative_tolerance = tolerance, .absolute_tolerance = 1e-2 * tolerance});
    integrator->advance(exact_period(amplitude));
    EXPECT_EQ(integrator->state().t, exact_period(amplitude));
    const double error = std::abs(integrator->state().q[0] - amplitude) + std::abs(integrator->state().qd[0]);
    EXPECT_LT(error, GetParam().factor * tolerance) << "tolerance " << tolerance;
    RecordProperty("error_over_tolerance_" + std::to_string(-std::log10(tolerance)),
                   std::to_string(error / tolerance));
  }
}

TEST_P(Adaptive, FindsEventsAndTheirDirection) {
  const double amplitude = 1.2, quarter = exact_period(amplitude) / 4;
  Pendulum pendulum(amplitude);
  const auto integrator =
      GetParam().make(pendulum, {.relative_tolerance = 1e-9, .absolute_tolerance = 1e-11});
  integrator->watch({"lowest", [](const State& s) { return s.q[0]; }, 0, false});
  integrator->watch({"from the left", [](const State& s) { return s.q[0]; }, +1, true});
  integrator->advance(10);
  ASSERT_EQ(integrator->events().size(), 3u);
  EXPECT_EQ(integrator->events()[0].name, "lowest");
  EXPECT_EQ(integrator->events()[0].direction, -1);
  EXPECT_NEAR(integrator->events()[0].t, quarter, 1e-6);
  EXPECT_NEAR(integrator->state().t, 3 * quarter, 1e-6);
  EXPECT_NEAR(integrator->state().q[0], 0, 1e-6);
  integrator->advance(4 * quarter);  // goes on
  EXPECT_NEAR(integrator->state().q[0], amplitude, 1e-5);
}

TEST_P(Adaptive, KnowsTheMotionBetweenItsSteps) {
  Pendulum pendulum(0.02);  // nearly a cosine
  const auto integrator =
      GetParam().make(pendulum, {.relative_tolerance = 1e-8, .absolute_tolerance = 1e-10});
  const double w = 2 * M_PI / exact_period(0.02);
  double before = 0;
  for (int i = 0; i < 30; ++i) {
    integrator->step();
    const double t = 0.4 * before + 0.6 * integrator->state().t;
    const State s = integrator->interpolate(t);
    EXPECT_EQ(s.t, t);
    EXPECT_NEAR(s.q[0], 0.02 * std::cos(w * t), 2e-7);
    EXPECT_NEAR(s.qdd[0], -9.81 * std::sin(s.q[0]), 1e-12);
    before = integrator->state().t;
  }
  EXPECT_THROW((void)integrator->interpolate(before + 1), ModelError);
}

/// Skate on a slope, turning at a constant rate: constraint_test.cpp has the solution.
class Skate : public System {
 public:
  Coordinate s = coordinate("s"), u = coordinate("u"), psi = coordinate("psi", 0, 1.7);
  VelocityConstraint& edge = velocity_constraint("edge");
  FirstOrderState lag = first_order_state("lag", 1);
  Body& skate = body("skate", Inertia(2.0, 0.3));

 protected:
  void positions() override {
    skate = translate(s, u, 0) * rotate_z(psi);
    edge = {{-sin(psi), s}, {cos(psi), u}};
  }
  void forces() override {
    gravity(Eigen::Vector3d(3, 0, 0));
    lag.set_rate(-2 * lag.value());
  }
};

TEST_P(Adaptive, HoldsVelocityConstraintsAndFirstOrderStates) {
  Skate skate;
  const auto integrator = GetParam().make(skate, {.relative_tolerance = 1e-8, .absolute_tolerance = 1e-10});
  integrator->advance(2);
  const State& state = integrator->state();
  const double wt = 3.4, k = 3 / (2 * 1.7 * 1.7);
  EXPECT_NEAR(state.q[0], k * std::pow(std::sin(wt), 2), 1e-5);
  EXPECT_NEAR(state.q[1], k * (wt - std::sin(2 * wt) / 2), 1e-5);
  EXPECT_NEAR(state.x[0], std::exp(-4), 1e-6);
  EXPECT_LT(std::abs(-std::sin(state.q[2]) * state.qd[0] + std::cos(state.q[2]) * state.qd[1]), 1e-5);
}

TEST_P(Adaptive, SaysWhatIsOutOfRange) {
  Pendulum pendulum(1);
  EXPECT_THAT([&] { GetParam().make(pendulum, {.relative_tolerance = -1}); },
              ThrowsMessage<ModelError>(HasSubstr("relative_tolerance = -1")));
  const auto integrator = GetParam().make(pendulum, {});
  integrator->step();
  EXPECT_THAT(
      [&] {
        integrator->watch({"late", [](const State&) { return 1.0; }});
      },
      ThrowsMessage<ModelError>(HasSubstr("event \"late\"")));
}

TEST_P(Adaptive, LetsTheErrorsOfTheUsersProgramThrough) {
  class Faulty : public Pendulum {
   public:
    Faulty() : Pendulum(1) {}

   protected:
    void forces() override {
      if (time().value() > 0.1) throw ModelError("no rope is that long");
      gravity();
    }
  } faulty;
  const auto integrator = GetParam().make(faulty, {});
  EXPECT_THAT([&] { integrator->advance(1); }, ThrowsMessage<ModelError>(HasSubstr("no rope")));
}

}  // namespace
}  // namespace easydyn

// The measured order of every integrator on one system that has everything: coupled coordinates, a velocity constraint,
// a first-order state and a drive.

#include <gtest/gtest.h>

#include "easydyn/easydyn.hpp"

namespace easydyn {
namespace {

/// A cart on a rolling wheel, driven by a motor; a pendulum hangs from the cart, whose pivot is shaken.
class EverythingCart : public System {
 public:
  static constexpr double r = 0.3, L = 0.05, R = 0.8, k = 2.0;
  Coordinate x = coordinate("x"), spin = coordinate("spin"), a = coordinate("a", 1.2);
  FirstOrderState current = first_order_state("current");
  VelocityConstraint& rolling = velocity_constraint("rolling");
  Body& wheel = body("wheel", Inertia::cylinder_y(4, r, 0.1));
  Body& bob = body("bob", Inertia(2, 0.05));

 protected:
  void positions() override {
    wheel = translate(x, 0, r) * rotate_y(spin);
    bob = translate(x, 0, r + 0.05 * sin(5 * time())) * rotate_y(a) * translate(0, 0, -0.7);
    rolling = {{1, x}, {-r, spin}};
  }
  void forces() override {
    gravity();
    current.set_rate((24 - R * current.value() - k * spin.rate()) / L);
    wheel.add_moment({0, k * current.value(), 0});
  }
};

const State& exact() {  // Dormand and Prince with its tolerance at the end of what numbers allow
  static const State state = [] {
    EverythingCart cart;
    RungeKutta fine(cart, {.relative_tolerance = 1e-13, .absolute_tolerance = 1e-14});
    fine.advance(1);
    return fine.state();
  }();
  return state;
}

/// Errors of coordinates, rates and the first-order state after a second.
Eigen::Vector3d error_of(const State& s) {
  return {(s.q - exact().q).norm(), (s.qd - exact().qd).norm(), (s.x - exact().x).norm()};
}

struct Stepper {
  const char* name;
  std::function<std::unique_ptr<ImplicitStepper>(System&, const StepperOptions&)> make;
};
const Stepper steppers[] = {
    {"newmark", [](System& s, const StepperOptions& o) { return std::make_unique<Newmark>(s, o); }},
    {"hht", [](System& s, const StepperOptions& o) { return std::make_unique<Hht>(s, o, -0.2); }},
    {"generalized_alpha_0",
     [](System& s, const StepperOptions& o) { return std::make_unique<GeneralizedAlpha>(s, o, 0.0); }},
    {"generalized_alpha_08",
     [](System& s, const StepperOptions& o) { return std::make_unique<GeneralizedAlpha>(s, o, 0.8); }}};

class ImplicitSteppers : public testing::TestWithParam<Stepper> {};
INSTANTIATE_TEST_SUITE_P(All, ImplicitSteppers, testing::ValuesIn(steppers),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(ImplicitSteppers, AreOfSecondOrderInCoordinatesRatesAndStates) {
  const auto error = [&](double h) {
    EverythingCart cart;
    const auto stepper = GetParam().make(cart, {.step = h, .newton_tolerance = 1e-12});
    stepper->advance(1);
    // The constraint holds at the end of every step.
    EXPECT_NEAR(stepper->state().qd[0], EverythingCart::r * stepper->state().qd[1], 1e-9);
    return error_of(stepper->state());
  };
  const Eigen::Vector3d coarse = error(2e-3), fine = error(1e-3);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(std::log2(coarse[i] / fine[i]), 2, 0.1) << "0: q, 1: qd, 2: x: " << i;
  }
}

/// x. = -rate (x - cos t) beside a mass at rest: all that moves is of first order.
class Relaxation : public System {
 public:
  explicit Relaxation(double rate) : rate_(rate) {}
  Coordinate q = coordinate("q");
  FirstOrderState x = first_order_state("x", 0);
  Body& mass = body("mass", 1.0);
  /// Exact: particular solution rate (rate cos t + sin t) / (rate^2 + 1) and a decaying rest.
  double exact(double t) const {
    const double p = rate_ / (rate_ * rate_ + 1);
    return p * (rate_ * std::cos(t) + std::sin(t)) - p * rate_ * std::exp(-rate_ * t);
  }

 protected:
  void positions() override { mass = translate(q, 0, 0); }
  void forces() override { x.set_rate(-rate_ * (x.value() - std::cos(time().value()))); }

 private:
  double rate_;
};

TEST_P(ImplicitSteppers, WithAVariableStepSeeFirstOrderStates) {
  // Nothing but the state asks for small steps, the first one included: 0.1 s is five times its time constant.
  const auto run = [&](double tolerance) {
    Relaxation system(50);
    const auto stepper = GetParam().make(
        system, {.step = 0.1, .variable_step = true, .tolerance = tolerance, .max_step = 0.1});
    double worst = 0;
    stepper->advance(2,
                     [&](const State& s) { worst = std::max(worst, std::abs(s.x[0] - system.exact(s.t))); });
    return std::pair(worst, stepper->statistics().steps);
  };
  const auto [coarse, coarse_steps] = run(1e-4);
  const auto [fine, fine_steps] = run(1e-6);
  // The bound C h^3 |x...| <= tolerance, C up to 0.6, is on each step's error; the decay forgets within 1 / (50 h) steps,
  // cbrt(C / tolerance) of them: so many tolerances may meet (measured half as many).
  EXPECT_LT(coarse, std::cbrt(0.6 / 1e-4) * 1e-4);
  EXPECT_LT(fine, std::cbrt(0.6 / 1e-6) * 1e-6);
  EXPECT_GT(fine_steps, 2 * coarse_steps);
}

/// Two oscillators side by side of 1 and 7 rad/s.
class TwoOscillators : public System {
 public:
  Coordinate x = coordinate("x", 1), y = coordinate("y", 0, 1);
  Body &a = body("a", 1.0), &b = body("b", 1.0);
  static Eigen::Vector2d exact(const Eigen::Vector2d& q, const Eigen::Vector2d& qd, double h) {
    return {q[0] * std::cos(h) + qd[0] * std::sin(h), q[1] * std::cos(7 * h) + qd[1] / 7 * std::sin(7 * h)};
  }

 protected:
  void positions() override {
    a = translate(x, 0, 0);
    b = translate(0, y, 0);
  }
  void forces() override {
    a.add_force({-x.value(), 0, 0}, a.position());
    b.add_force({0, -49 * y.value(), 0}, b.position());
  }
};

TEST_P(ImplicitSteppers, WithAVariableStepBoundTheErrorThatEachStepAddsToTheCoordinates) {
  for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
    TwoOscillators system;
    const auto stepper =
        GetParam().make(system, {.step = 1e-4, .variable_step = true, .tolerance = tolerance});
    State before = stepper->state();
    double worst = 0;
    stepper->advance(3, [&](const State& s) {  // against the exact motion from the state before
      const Eigen::Vector2d exact = TwoOscillators::exact(before.q, before.qd, s.t - before.t);
      worst = std::max(worst, (s.q - exact).lpNorm<Eigen::Infinity>());
      before = s;
    });
    // The estimate is the leading term: where q... passes zero the step grows, and the next term counts (measured 2.1).
    EXPECT_LT(worst, 2.5 * tolerance) << "tolerance " << tolerance;
    EXPECT_GT(worst, 0.3 * tolerance) << "tolerance " << tolerance;  // no step is wasted
    RecordProperty("local_error_over_tolerance", std::to_string(worst / tolerance));
  }
}

using Make = std::function<std::unique_ptr<AdaptiveIntegrator>(System&, const AdaptiveOptions&)>;
struct Adaptive {
  const char* name;
  Make make;
  double factor;  ///< allowed error after a second / relative tolerance; measured 0.5, 5, 19, 21
};
const Adaptive adaptive[] = {
    {"runge_kutta", [](System& s, const AdaptiveOptions& o) { return std::make_unique<RungeKutta>(s, o); },
     3},
    {"adams",
     [](System& s, const AdaptiveOptions& o) { return std::make_unique<Cvode>(s, o, Cvode::Method::adams); },
     30},
    {"bdf", [](System& s, const AdaptiveOptions& o) { return std::make_unique<Cvode>(s, o); }, 60},
    {"ida", [](System& s, const AdaptiveOptions& o) { return std::make_unique<Ida>(s, o); }, 60}};

class AdaptiveIntegrators : public testing::TestWithParam<Adaptive> {};
INSTANTIATE_TEST_SUITE_P(All, AdaptiveIntegrators, testing::ValuesIn(adaptive),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(AdaptiveIntegrators, HaveErrorsInProportionToTheTolerance) {
  for (const double tolerance : {1e-5, 1e-7, 1e-9}) {
    EverythingCart cart;
    const auto integrator =
        GetParam().make(cart, {.relative_tolerance = tolerance, .absolute_tolerance = 1e-2 * tolerance});
    integrator->advance(1);
    const double ratio = error_of(integrator->state()).maxCoeff() / tolerance;
    EXPECT_LT(ratio, GetParam().factor) << tolerance;
  }
}

}  // namespace
}  // namespace easydyn

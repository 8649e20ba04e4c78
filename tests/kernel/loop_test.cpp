#include "easydyn/mbs/loop.hpp"

#include <gmock/gmock.h>

#include "easydyn/easydyn.hpp"

namespace easydyn {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double r = 0.3, l = 0.8;  // crank, connecting rod [m]

/// Slider-crank in the plane x-z, crank angle a from x: the rod's angle explicitly, by an equation or by frames.
enum class Closure { formula, equation, frames, redundant };
class SliderCrank : public System {
 public:
  explicit SliderCrank(Closure closure) : System("slider-crank"), closure_(closure) {}
  Coordinate a = coordinate("a", 0.7, 2.0);
  Loop<1> closing = loop<1>("rod", {0.1});
  Body& crank = body("crank", Inertia::box(2, r, 0.1, 0.1));
  Body& rod = body("rod", Inertia::box(3, l, 0.1, 0.1));
  Body& slider = body("slider", 1.5);

 protected:
  Expr rod_angle() {
    switch (closure_) {
      case Closure::formula:
        return asin(r / l * sin(a));
      case Closure::equation:
        return closing.solve([&](const auto& p) { return std::array{r * sin(a) - l * sin(p[0])}; })[0];
      case Closure::frames:  // rotate_y turns z toward x: minus for angles from x toward z
        return closing.solve([&](const auto& p) {
          const Frame end = rotate_y(-a) * translate(r, 0, 0) * rotate_y(p[0] + a) * translate(l, 0, 0);
          return std::array{end.express_point({0, 0, 0}).z()};
        })[0];
      default:
        return closing.solve([&](const auto& p) {
          const Expr g = r * sin(a) - l * sin(p[0]);
          return std::array{g, 2 * g, g * cos(a)};
        })[0];
    }
  }
  void positions() override {
    const Expr b = rod_angle();
    crank = rotate_y(-a) * translate(r / 2, 0, 0);
    rod = rotate_y(-a) * translate(r, 0, 0) * rotate_y(b + a) * translate(l / 2, 0, 0);
    slider = translate(r * cos(a) + l * cos(b), 0, 0);
  }
  void forces() override { gravity(); }

 private:
  Closure closure_;
};

TEST(Loop, IsTheFormulaThatItsEquationStandsFor) {
  SliderCrank explicit_one(Closure::formula);
  for (const Closure closure : {Closure::equation, Closure::frames, Closure::redundant}) {
    SliderCrank implicit_one(closure);
    State s = explicit_one.initial_state();
    for (double angle = 0.2; angle < 13; angle += 0.37) {  // two turns
      s.q[0] = angle;
      s.qdd[0] = -1.3;
      EXPECT_NEAR(implicit_one.compute_mass_matrix(s)(0, 0), explicit_one.compute_mass_matrix(s)(0, 0),
                  1e-12);
      EXPECT_NEAR(implicit_one.compute_residual(s)[0], explicit_one.compute_residual(s)[0], 1e-10);
    }
  }
}

/// Four bars a, b, c on a base d: unknown angles of coupler and rocker.
class FourBar : public System {
 public:
  FourBar(double a, double b, double c, double d, std::array<double, 2> guess)
      : System("linkage"), closing(loop<2>("four-bar", guess)), a_(a), b_(b), c_(c), d_(d) {}
  Coordinate q = coordinate("q", 1.0, 0.8);
  Loop<2> closing;
  std::array<Expr, 2> solution;

 protected:
  void positions() override {
    solution = closing.solve([&](const auto& p) {
      return std::array{a_ * cos(q) + b_ * cos(p[0]) - c_ * cos(p[1]) - d_,
                        a_ * sin(q) + b_ * sin(p[0]) - c_ * sin(p[1])};
    });
  }

 private:
  double a_, b_, c_, d_;
};

TEST(Loop, CarriesRateBiasAndGradientOfItsUnknowns) {
  FourBar bar(0.4, 1.0, 0.8, 0.9, {0.3, 1.5});
  const auto at = [&](double t) {  // along q(t) = 1 + 0.8 t
    State s = bar.initial_state();
    s.q[0] += 0.8 * t;
    bar.evaluate(s);
    return bar.solution;
  };
  const double d = 2e-3;
  const auto p = at(0), p1 = at(-2 * d), p2 = at(-d), p3 = at(d), p4 = at(2 * d);
  for (std::size_t i = 0; i < 2; ++i) {
    const double rate = (p1[i].value() - 8 * p2[i].value() + 8 * p3[i].value() - p4[i].value()) / (12 * d);
    const double bias =
        (-p1[i].value() + 16 * p2[i].value() - 30 * p[i].value() + 16 * p3[i].value() - p4[i].value()) /
        (12 * d * d);
    EXPECT_NEAR(p[i].rate(), rate, 1e-10);
    EXPECT_NEAR(p[i].bias(), bias, 1e-8);
    EXPECT_NEAR(p[i].gradient()[0], rate / 0.8, 1e-10);
    EXPECT_EQ(p[i].gradient().size(), 1u);  // no trace of the unknowns
  }
}

TEST(Loop, KeepsItsBranchAndTakesTheGuessed) {
  FourBar up(0.4, 1.0, 0.8, 0.9, {0.3, 1.5}), down(0.4, 1.0, 0.8, 0.9, {-1.5, -2.5});
  State s_up = up.initial_state(), s_down = down.initial_state();
  for (double q = 1; q < 1 + 2 * M_PI + 0.01; q += 0.05) {
    s_up.q[0] = s_down.q[0] = q;
    up.evaluate(s_up);
    down.evaluate(s_down);
    EXPECT_GT(std::sin(up.solution[1].value() - up.solution[0].value()), 0.1);
    EXPECT_LT(std::sin(down.solution[1].value() - down.solution[0].value()), -0.1);
  }
}

TEST(Loop, NamesItselfWhereItIsSingular) {
  FourBar parallelogram(1, 2, 1, 2, {0.0, 1.0});  // flat at q = 0: parallelogram and its crossed twin meet
  parallelogram.evaluate(parallelogram.initial_state());
  parallelogram.closing.set_guess({0, 0});
  State s = parallelogram.initial_state();
  s.q[0] = 0;
  EXPECT_THAT(
      [&] { parallelogram.evaluate(s); },
      ThrowsMessage<SolverError>(
          AllOf(HasSubstr("loop \"four-bar\" of system \"linkage\" is singular"), HasSubstr("rank 1 of 2"))));
}

TEST(Loop, RefusesToPassADeadPointUnseen) {
  // Newton's tangent would step over the flat position without touching it.
  FourBar parallelogram(1, 1, 1, 1, {0.0, 1.0});
  parallelogram.closing.set_guess({0, 0.01});
  State s = parallelogram.initial_state();
  s.q[0] = 0.01;
  parallelogram.evaluate(s);
  s.q[0] = -0.008;
  EXPECT_THAT([&] { parallelogram.evaluate(s); },
              ThrowsMessage<SolverError>(
                  AllOf(HasSubstr("loop \"four-bar\" of system \"linkage\" has passed a dead point"))));
  s.q[0] = 0.01;  // the refused solution has left no trace
  parallelogram.evaluate(s);
  EXPECT_NEAR(parallelogram.solution[1].value(), 0.01, 1e-12);
  parallelogram.closing.set_guess({0, -0.008});  // the user knows how it goes on
  s = parallelogram.initial_state();
  s.q[0] = -0.008;
  parallelogram.evaluate(s);
  EXPECT_NEAR(parallelogram.solution[1].value(), -0.008, 1e-12);
}

// A drag link, whose dependent angles turn round and round: from the initial guess most states would close in another
// turn or on the other branch.
TEST(Loop, KeepsItsBranchAndTurnInAStateWhateverWasEvaluatedBefore) {
  class DragLink : public FourBar {
   public:
    Body& crank = body("crank", Inertia(1, 0.2));
    DragLink() : FourBar(1, 0.9, 1.1, 0.3, {0.5, 1.0}) {}
    void positions() override {
      FourBar::positions();
      crank = rotate_z(q);
    }
  } link, fresh;
  State s = link.initial_state();
  s.qd[0] = 3;
  RungeKutta integrator(link, s, {.relative_tolerance = 1e-8, .absolute_tolerance = 1e-8, .max_step = 0.02});
  std::vector<State> states;
  std::vector<double> rockers;
  integrator.advance(4, [&](const State& now) {
    states.push_back(now);
    link.evaluate(now);
    rockers.push_back(link.solution[1].value());
  });
  EXPECT_GT(std::abs(rockers.back() - rockers.front()), 3 * M_PI);
  for (std::size_t i = states.size(); i-- > 0;) {  // backwards, to make it harder
    fresh.evaluate(states[i]);
    EXPECT_NEAR(fresh.solution[1].value(), rockers[i], 1e-10);
  }
  fresh.evaluate(fresh.initial_state());
  const double first = fresh.solution[1].value();
  link.evaluate(link.initial_state());  // after the run
  EXPECT_EQ(link.solution[1].value(), first);
}

// Newton's step leaves the domain of the square root: it is halved, and a failure leaves no trace.
TEST(Loop, ComesBackFromOutsideTheDomainOfAFunction) {
  class Root : public System {
   public:
    Coordinate x = coordinate("x", 0.05);
    Body& mass = body("mass", 1.0);
    Loop<1> closing = loop<1>("root", {1.0});
    void positions() override {
      const auto [p] = closing.solve([&](const auto& u) { return std::array{sqrt(u[0]) - x}; });
      mass = translate(p, 0, 0);
    }
  } system;
  State s = system.initial_state();
  system.evaluate(s);
  EXPECT_NEAR(system.mass.position().x(), 0.0025, 1e-12);
}

TEST(Loop, NamesItselfWhereItCannotBeClosed) {
  FourBar torn(0.4, 0.5, 0.3, 3.0, {0.3, 1.5});
  EXPECT_THAT(
      [&] { torn.evaluate(torn.initial_state()); },
      ThrowsMessage<SolverError>(AllOf(HasSubstr("loop \"four-bar\""), HasSubstr("cannot be closed"))));
}

TEST(Loop, RefusesEquationsThatContradictEachOther) {
  class Contradiction : public System {
   public:
    Loop<1> closing = loop<1>("pair", {0.0});
    void positions() override {
      closing.solve([&](const auto& p) { return std::array{p[0] - 1, p[0] - 2}; });
    }
  } system;
  EXPECT_THAT([&] { system.evaluate(system.initial_state()); },
              ThrowsMessage<SolverError>(HasSubstr("contradict each other")));
}

/// One loop inside the equations of another: outer u with u + v = q, inner v with v^3 + v = u.
class Nested : public System {
 public:
  Coordinate q = coordinate("q", 1.3, 0.6);
  Loop<1> outer = loop<1>("outer", {0.5}), inner = loop<1>("inner", {0.5});
  Expr u;

 protected:
  void positions() override {
    u = outer.solve([&](const auto& p) {
      const Expr v = inner.solve([&](const auto& w) { return std::array{pow(w[0], 3) + w[0] - p[0]}; })[0];
      return std::array{p[0] + v - q};
    })[0];
  }
};

TEST(Loop, MayHoldAnotherLoop) {
  Nested nested;
  nested.evaluate(nested.initial_state());
  // v^3 + 2 v = q: u = q - v, with v' = 1 / (3 v^2 + 2), v'' = -6 v v'^3.
  double v = 0.5;
  for (int i = 0; i < 50; ++i) v -= (v * v * v + 2 * v - 1.3) / (3 * v * v + 2);
  const double v1 = 1 / (3 * v * v + 2), v2 = -6 * v * v1 * v1 * v1;
  EXPECT_NEAR(nested.u.value(), 1.3 - v, 1e-13);
  EXPECT_NEAR(nested.u.gradient()[0], 1 - v1, 1e-13);
  EXPECT_NEAR(nested.u.rate(), 0.6 * (1 - v1), 1e-13);
  EXPECT_NEAR(nested.u.bias(), -0.36 * v2, 1e-12);
  EXPECT_EQ(nested.u.gradient().size(), 1u);
}

}  // namespace
}  // namespace easydyn

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "easydyn/easydyn.hpp"

using namespace easydyn;

namespace {

class Oscillator : public System {
 public:
  explicit Oscillator(double initial) : x(coordinate("x", initial)) {}
  Coordinate x;
  Body& mass = body("mass", 1.0);
  void positions() override { mass = translate(x, 0, 0); }
  void forces() override { mass.add_force({-omega * omega * x.value(), 0, 0}, mass.position()); }
  static constexpr double omega = 4;
};

double error_after(double h, double t_end) {
  Oscillator system(1.0);
  Newmark integrator(system, {.step = h});
  integrator.advance(t_end);
  return std::abs(integrator.state().q[0] - std::cos(Oscillator::omega * t_end));
}

TEST(Newmark, IsOfSecondOrder) {
  EXPECT_NEAR(std::log2(error_after(0.02, 2) / error_after(0.01, 2)), 2.0, 0.02);
}

TEST(Newmark, HasThePeriodErrorOfTheTrapezoidalRule) {
  // The discrete frequency satisfies tan(W h / 2) = w h / 2.
  const double h = 0.05, W = 2 / h * std::atan(Oscillator::omega * h / 2);
  Oscillator system(1.0);
  Newmark integrator(system, {.step = h});
  integrator.advance(5.0);
  EXPECT_NEAR(integrator.state().q[0], std::cos(W * 5.0), 1e-10);
}

TEST(Newmark, MeetsTheEndTimeExactly) {
  Oscillator system(1.0);
  Newmark integrator(system, {.step = 0.03});
  integrator.advance(0.1);
  EXPECT_DOUBLE_EQ(integrator.state().t, 0.1);
  EXPECT_EQ(integrator.statistics().steps, 4);
  EXPECT_DOUBLE_EQ(integrator.step_size(), 0.03);
}

TEST(Newmark, WithAVariableStepKeepsTheLocalErrorAtTheTolerance) {
  // Halving the tolerance by 1000 shortens the step by about 10 (third-order local error): error by about
  // 100.
  const auto run = [](double tolerance) {
    Oscillator system(1.0);
    Newmark integrator(system, {.step = 1e-3, .variable_step = true, .tolerance = tolerance});
    integrator.advance(5.0);
    return std::pair(std::abs(integrator.state().q[0] - std::cos(Oscillator::omega * 5.0)),
                     integrator.statistics().steps);
  };
  const auto [coarse, coarse_steps] = run(1e-4);
  const auto [fine, fine_steps] = run(1e-7);
  EXPECT_LT(fine, coarse / 30);
  EXPECT_LT(coarse_steps * 5, fine_steps);
  EXPECT_LT(fine, 1e-3);
}

/// Half a unit of the last of three significant digits.
double half_a_unit_of_three_digits(double x) {
  return 0.5 * std::pow(10, std::floor(std::log10(x)) - 2);
}

// Two degrees of freedom under a step load, K. J. Bathe, Finite Element Procedures, example 9.1/9.4
// (trapezoidal rule, step 0.28): table to three digits. The book works with coefficients of three digits
// (a0 = 51.0 for 51.02 ...), which at u1(0.56) = 0.05045 moves the third digit: 0.0505 printed.
TEST(Newmark, GivesBathesTableForTwoDegreesOfFreedom) {
  class TwoMasses : public System {
   public:
    Coordinate u1 = coordinate("u1"), u2 = coordinate("u2");
    Body& b1 = body("1", 2.0);
    Body& b2 = body("2", 1.0);
    void positions() override {
      b1 = translate(u1, 0, 0);
      b2 = translate(u2, 0, 0);
    }
    void forces() override {
      b1.add_force({-6 * u1.value() + 2 * u2.value(), 0, 0}, b1.position());
      b2.add_force({10 + 2 * u1.value() - 4 * u2.value(), 0, 0}, b2.position());
    }
  } system;
  const double u1[] = {0.00673, 0.0505, 0.189, 0.485, 0.961, 1.58, 2.23, 2.76, 3.00, 2.85, 2.28, 1.40};
  const double u2[] = {0.364, 1.35, 2.68, 4.00, 4.95, 5.34, 5.13, 4.48, 3.64, 2.90, 2.44, 2.31};
  Newmark integrator(system, {.step = 0.28});
  for (int i = 0; i < 12; ++i) {
    integrator.step();
    const double of_working = i == 1 ? 1e-4 : 0;  // one unit of that digit, see above
    EXPECT_NEAR(integrator.state().q[0], u1[i], std::max(half_a_unit_of_three_digits(u1[i]), of_working))
        << i;
    EXPECT_NEAR(integrator.state().q[1], u2[i], half_a_unit_of_three_digits(u2[i])) << i;
  }
}

TEST(Newmark, RefusesImpossibleOptions) {
  Oscillator system(1.0);
  EXPECT_THROW(Newmark(system, {.step = 0}), ModelError);
  EXPECT_THROW(Newmark(system, {.step = std::nan("")}), ModelError);
  EXPECT_THROW(Newmark(system, {.tolerance = -1}), ModelError);
}

TEST(Newmark, SaysWhenTheMassMatrixIsSingular) {
  class Massless : public System {
   public:
    Coordinate x = coordinate("x");
    Body& b = body("b", 0.0);
    void positions() override { b = translate(x, 0, 0); }
  } system;
  EXPECT_THROW(Newmark integrator(system), SolverError);
}

TEST(Newmark, SaysWhereItDoesNotConverge) {
  class Absurd : public Oscillator {
   public:
    Absurd() : Oscillator(1.0) {}
    void forces() override {
      if (time().value() > 0.05) mass.add_force({std::nan(""), 0, 0}, mass.position());
    }
  } system;
  Newmark integrator(system, {.step = 0.01});
  try {
    integrator.advance(1);
    FAIL();
  } catch (const SolverError& e) {
    EXPECT_NE(std::string(e.what()).find("t = 0.05"), std::string::npos) << e.what();
  }
}

}  // namespace

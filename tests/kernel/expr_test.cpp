#include "easydyn/math/expr.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

using namespace easydyn;

namespace {

// Coordinates a(t) = 0.6 + 0.7 t, b(t) = 0.4 - 0.3 t: their accelerations vanish, so that along this line the
// second total derivative is the bias.
Expr coordinate_a(double t) {
  return Expr::coordinate(0, 0.6 + 0.7 * t, 0.7);
}
Expr coordinate_b(double t) {
  return Expr::coordinate(3, 0.4 - 0.3 * t, -0.3);
}
Expr time_at(double t) {
  return Expr::of_time(t, 1, 0);
}

struct Function {
  std::string name;
  std::function<Expr(const Expr&, const Expr&, const Expr&)> f;
};

class ExprFunctions : public testing::TestWithParam<Function> {};

TEST_P(ExprFunctions, CarriesRateBiasAndGradientOfEveryFunction) {
  const auto& f = GetParam().f;
  const auto at = [&](double t) { return f(coordinate_a(t), coordinate_b(t), time_at(t)).value(); };
  const Expr e = f(coordinate_a(0), coordinate_b(0), time_at(0));

  // Fourth-order differences: error about 1e-16 / d^2 for the second derivative.
  const double d = 2e-3;
  const double rate = (at(-2 * d) - 8 * at(-d) + 8 * at(d) - at(2 * d)) / (12 * d);
  const double bias = (-at(-2 * d) + 16 * at(-d) - 30 * at(0) + 16 * at(d) - at(2 * d)) / (12 * d * d);
  EXPECT_NEAR(e.rate(), rate, 1e-9);
  EXPECT_NEAR(e.bias(), bias, 1e-8);

  const auto shifted = [&](double da, double db) {
    return f(Expr::coordinate(0, 0.6 + da, 0.7), Expr::coordinate(3, 0.4 + db, -0.3), time_at(0)).value();
  };
  const double df_da =
      (shifted(-2 * d, 0) - 8 * shifted(-d, 0) + 8 * shifted(d, 0) - shifted(2 * d, 0)) / (12 * d);
  const double df_db =
      (shifted(0, -2 * d) - 8 * shifted(0, -d) + 8 * shifted(0, d) - shifted(0, 2 * d)) / (12 * d);
  double ga = 0, gb = 0;
  for (const Gradient::Entry& g : e.gradient()) (g.coordinate == 0 ? ga : gb) = g.value;
  EXPECT_NEAR(ga, df_da, 1e-9);
  EXPECT_NEAR(gb, df_db, 1e-9);
}

const Function functions[] = {
    Function{"sum", [](const Expr& a, const Expr& b, const Expr& t) { return 2 * a + b - t + 1; }},
    Function{"product", [](const Expr& a, const Expr& b, const Expr& t) { return a * b * (t + 2); }},
    Function{"quotient", [](const Expr& a, const Expr& b, const Expr& t) { return (a + t) / (b + 2); }},
    Function{"sin", [](const Expr& a, const Expr& b, const Expr& t) { return sin(a * b + t); }},
    Function{"cos", [](const Expr& a, const Expr& b, const Expr& t) { return cos(a - b * t); }},
    Function{"tan", [](const Expr& a, const Expr& b, const Expr& t) { return tan(a * b + t); }},
    Function{"asin", [](const Expr& a, const Expr& b, const Expr& t) { return asin(a * b + t); }},
    Function{"acos", [](const Expr& a, const Expr& b, const Expr& t) { return acos(a * b + t); }},
    Function{"atan", [](const Expr& a, const Expr& b, const Expr& t) { return atan(a * b + t); }},
    Function{"atan2", [](const Expr& a, const Expr& b, const Expr& t) { return atan2(a + t, -b); }},
    Function{"atan2_steep", [](const Expr& a, const Expr& b, const Expr& t) { return atan2(-a - 2, b + t); }},
    Function{"sqrt", [](const Expr& a, const Expr& b, const Expr& t) { return sqrt(a * b + t + 1); }},
    Function{"exp", [](const Expr& a, const Expr& b, const Expr& t) { return exp(a * b - t); }},
    Function{"log", [](const Expr& a, const Expr& b, const Expr& t) { return log(a + b + t); }},
    Function{"pow", [](const Expr& a, const Expr& b, const Expr& t) { return pow(a + b + t, 2.5); }},
    Function{"pow_of_expr", [](const Expr& a, const Expr& b, const Expr& t) { return pow(a + 1, b + t); }},
    Function{"asinh", [](const Expr& a, const Expr& b, const Expr& t) { return asinh(a * b + t); }},
    Function{"acosh", [](const Expr& a, const Expr& b, const Expr& t) { return acosh(2 + a * b + t); }},
    Function{"atanh", [](const Expr& a, const Expr& b, const Expr& t) { return atanh(a * b + t); }},
    Function{"cbrt", [](const Expr& a, const Expr& b, const Expr& t) { return cbrt(-a * b - t - 1); }},
    Function{"log10", [](const Expr& a, const Expr& b, const Expr& t) { return log10(a + b + t); }},
    Function{"abs", [](const Expr& a, const Expr& b, const Expr& t) { return abs(-a - b * t); }},
    Function{"hypot", [](const Expr& a, const Expr& b, const Expr& t) { return hypot(a, b + t); }},
    Function{"function_of_three",
             [](const Expr& a, const Expr& b, const Expr&) {
               return Expr::apply(
                   a * b, [](double x) { return std::sin(3 * x); }, [](double x) { return 3 * std::cos(3 * x); },
                   [](double x) { return -9 * std::sin(3 * x); });
             }},
    Function{"hyperbolic",
             [](const Expr& a, const Expr& b, const Expr& t) { return sinh(a) * cosh(b) + tanh(t + a); }},
    Function{"user_function", [](const Expr& a, const Expr&, const Expr&) {
               const double x = a.value();
               return Expr::apply(a, x * x * x, 3 * x * x, 6 * x);
             }}};

INSTANTIATE_TEST_SUITE_P(All, ExprFunctions, testing::ValuesIn(functions),
                         [](const auto& test) { return test.param.name; });

TEST(Expr, OfNumbersStaysConstant) {
  EXPECT_TRUE((2 * sin(Expr(0.5)) + 1).is_constant());
  EXPECT_FALSE(time_at(0).is_constant());
  EXPECT_FALSE((0.0 * coordinate_a(0)).is_constant());
}

TEST(Gradient, KeepsItsEntriesBeyondTheInlineCapacity) {
  Expr sum = 0;
  for (int i = 9; i >= 0; --i) sum += (i + 1.0) * Expr::coordinate(i, 1, 0);
  Expr copy = sum;
  const Expr moved = std::move(copy);
  ASSERT_EQ(moved.gradient().size(), 10u);
  int i = 0;
  for (const Gradient::Entry& g : moved.gradient()) {
    EXPECT_EQ(g.coordinate, i);
    EXPECT_EQ(g.value, i + 1.0);
    ++i;
  }
}

}  // namespace

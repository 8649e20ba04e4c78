#include "easydyn/math/characteristic.hpp"

#include <gtest/gtest.h>

#include <cmath>

using easydyn::Characteristic;

namespace {

TEST(Characteristic, OfATablePassesThroughItsPoints) {
  const std::vector<double> x{-2, -0.5, 0, 1, 4}, y{-9, -1, 0, 3, 5};
  const Characteristic c = Characteristic::table("law", x, y);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(c.value(x[i]), y[i], 1e-14);
}

TEST(Characteristic, OfATableIsMonotoneWhereItsPointsAre) {
  const Characteristic c = Characteristic::table("law", {0, 1, 2, 3, 4}, {0, 0, 0.01, 5, 5});
  for (double x = -0.5, last = -1; x < 4.5; x += 0.01) {
    EXPECT_GE(c.value(x), last - 1e-15 * std::abs(last)) << x;  // rounding
    last = c.value(x);
  }
  EXPECT_EQ(c.value(0.5), 0);  // no overshoot before the rise
  EXPECT_EQ(c.value(3.5), 5);
}

TEST(Characteristic, OfAStraightTableIsTheStraightLine) {
  const Characteristic c = Characteristic::table("law", {-1, 0, 3}, {-2, 0, 6});
  for (double x : {-7.0, -1.0, 0.3, 2.9, 12.0}) {
    EXPECT_NEAR(c.value(x), 2 * x, 1e-13);
    EXPECT_NEAR(c.slope(x), 2, 1e-13);
    EXPECT_NEAR(c.integral(x), x * x, 1e-12);
  }
}

TEST(Characteristic, HasTheSlopeAndTheIntegralOfItsValue) {
  const Characteristic table = Characteristic::table("law", {-2, -0.5, 0.3, 1, 4}, {-9, -1, 0.5, 3, 5});
  const Characteristic function = Characteristic::function([](double x) { return std::sin(3 * x) + x * x; });
  for (const Characteristic& c : {table, function})
    for (double x : {-3.1, -1.2, 0.1, 0.77, 2.5, 5.3}) {
      const double d = 1e-4;
      // central differences of second order: d^2 / 6 of the third derivative (below 30), rounding 1e-15 / d
      EXPECT_NEAR((c.value(x + d) - c.value(x - d)) / (2 * d), c.slope(x), 1e-6) << x;
      EXPECT_NEAR((c.integral(x + d) - c.integral(x - d)) / (2 * d), c.value(x), 1e-6) << x;
    }
  EXPECT_NEAR(table.integral(0), 0, 1e-15);
  EXPECT_NEAR(function.integral(2), (1 - std::cos(6.0)) / 3 + 8.0 / 3, 1e-12);
}

TEST(Characteristic, TakesTheIntegralOfTheUser) {
  const Characteristic c =
      Characteristic::function([](double x) { return x; }, [](double x) { return 7 + x * x / 2; });
  EXPECT_NEAR(c.integral(3), 4.5, 1e-14);  // from 0, whatever the constant
}

}  // namespace

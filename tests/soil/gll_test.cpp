#include "soil/gll.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace easydyn::soil {
namespace {

TEST(GllRule, IntegratesPolynomialsToDegreeTwoNMinusOne) {
  for (const int N : {3, 4, 5, 6}) {
    const GllRule rule(N);
    for (int p = 0; p <= 2 * N - 1; ++p) {
      double sum = 0;
      for (int i = 0; i <= N; ++i) sum += rule.weights(i) * std::pow(rule.points(i), p);
      EXPECT_NEAR(sum, p % 2 ? 0.0 : 2.0 / (p + 1), 1e-14) << "N " << N << " p " << p;
    }
  }
}

TEST(GllRule, DifferentiatesAndInterpolatesPolynomialsOfItsDegree) {
  const GllRule rule(5);
  for (int p = 0; p <= 5; ++p) {
    const Eigen::VectorXd values = rule.points.array().pow(p);
    for (int i = 0; i <= 5; ++i)
      EXPECT_NEAR(rule.derivative.row(i).dot(values), p == 0 ? 0.0 : p * std::pow(rule.points(i), p - 1),
                  1e-13);
    EXPECT_NEAR(rule.compute_shape(0.37).dot(values), std::pow(0.37, p), 1e-14);
    EXPECT_NEAR(rule.integrate_shape(-0.2, 0.7).dot(values),
                (std::pow(0.7, p + 1) - std::pow(-0.2, p + 1)) / (p + 1), 1e-14);
  }
}

TEST(GllRule, HasTheKnownPointsOfDegreeFour) {
  const GllRule rule(4);  // +-sqrt(3/7), weights 1/10, 49/90, 32/45
  EXPECT_NEAR(rule.points(3), std::sqrt(3.0 / 7), 1e-15);
  EXPECT_NEAR(rule.weights(0), 0.1, 1e-15);
  EXPECT_NEAR(rule.weights(1), 49.0 / 90, 1e-15);
  EXPECT_NEAR(rule.weights(2), 32.0 / 45, 1e-15);
}

}  // namespace
}  // namespace easydyn::soil

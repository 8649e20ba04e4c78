#include "easydyn/mbs/frame.hpp"

#include <gtest/gtest.h>

#include "easydyn/easydyn.hpp"

namespace easydyn {
namespace {

/// A skew chain; keeps expressions of a point and a direction of its last frame.
class Chain : public System {
 public:
  Coordinate a = coordinate("a", 0.7, 0.9), b = coordinate("b", -0.4, 1.3), c = coordinate("c", 0.2, -0.6);
  Body& last = body("last", 1.0);
  ExprVector point, direction;

 protected:
  void positions() override {
    last = translate(0, 0.3 * time(), 1) * rotate_y(a) * translate(0.1, 0.2, -0.6) *
           rotate({1, 2, 0.5}, b * c) * translate(sin(c), 0, 0.4);
    point = last.frame().express_point({0.3, -0.2, 0.5});
    direction = last.frame().express_direction({0.6, 0, 0.8});
  }
};

TEST(FrameExpression, CarriesRateBiasAndGradientOfPointsAndDirections) {
  Chain chain;
  const State start = chain.initial_state();
  const auto at = [&](double t, int shifted = -1) {  // along q + qd t, or with one coordinate moved by t
    State s = start;
    if (shifted < 0) {
      s.t = t;
      s.q += t * s.qd;
    } else {
      s.q[shifted] += t;
    }
    chain.evaluate(s);
    return std::pair(chain.point.value(), chain.direction.value());
  };
  const double d = 2e-3;
  for (int which = 0; which < 2; ++which) {
    chain.evaluate(start);
    const ExprVector e = which == 0 ? chain.point : chain.direction;
    const auto value = [&](double t, int shifted = -1) {
      const auto both = at(t, shifted);
      return which == 0 ? both.first : both.second;
    };
    const auto slope = [&](int shifted) -> Eigen::Vector3d {
      return (value(-2 * d, shifted) - 8 * value(-d, shifted) + 8 * value(d, shifted) -
              value(2 * d, shifted)) /
             (12 * d);
    };
    const Eigen::Vector3d bias =
        (-value(-2 * d) + 16 * value(-d) - 30 * value(0) + 16 * value(d) - value(2 * d)) / (12 * d * d);
    EXPECT_LT((e.rate() - slope(-1)).norm(), 1e-9);
    EXPECT_LT((e.bias() - bias).norm(), 1e-8);
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d gradient(e[0].gradient()[i], e[1].gradient()[i], e[2].gradient()[i]);
      EXPECT_LT((gradient - slope(i)).norm(), 1e-9) << "coordinate " << i;
    }
  }
  // In the ground it is constant.
  EXPECT_TRUE(Frame().express_point({1, 2, 3}).x().is_constant());
}

TEST(ExprVector, HasProductsAndALength) {
  const Expr q = Expr::coordinate(0, 0.5, 2.0);
  const ExprVector a(q, 2 * q, 1), b(1, q, -q);
  EXPECT_DOUBLE_EQ(dot(a, b).value(), 0.5 + 2 * 0.25 - 0.5);
  EXPECT_DOUBLE_EQ(dot(a, b).rate(), 2.0 * (1 + 4 * 0.5 - 1));
  EXPECT_DOUBLE_EQ(cross(a, b)[0].value(), -2 * 0.25 - 0.5);
  EXPECT_DOUBLE_EQ(norm(a).value(), std::sqrt(5 * 0.25 + 1));
  EXPECT_DOUBLE_EQ((a - b)[2].value(), 1.5);
}

}  // namespace
}  // namespace easydyn

// Every derivative of the kernel against sixth-order central differences, at random points.

#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "easydyn/easydyn.hpp"

namespace easydyn {
namespace {

using Eigen::Vector3d, Eigen::VectorXd;

/// First and second derivative of f at 0 by seven points; truncation d^6, rounding about 3e-16 / d and 5e-16 / d^2.
struct Slopes {
  double first, second;
};
Slopes differentiate(const std::function<double(double)>& f, double d = 8e-3) {
  const double m3 = f(-3 * d), m2 = f(-2 * d), m1 = f(-d), z = f(0), p1 = f(d), p2 = f(2 * d), p3 = f(3 * d);
  return {(p3 - m3 - 9 * (p2 - m2) + 45 * (p1 - m1)) / (60 * d),
          (2 * (p3 + m3) - 27 * (p2 + m2) + 270 * (p1 + m1) - 490 * z) / (180 * d * d)};
}

/// q(t) = q + qd t + qdd t^2 / 2 from a random point: along it f.. = gradient . qdd + bias.
struct Path {
  double q[3], qd[3], qdd[3], t0;
  explicit Path(unsigned seed) {
    std::mt19937 engine(seed);
    const auto random = [&](double low, double high) {
      return std::uniform_real_distribution<>(low, high)(engine);
    };
    for (int i = 0; i < 3; ++i) {
      q[i] = random(0.2, 0.8);
      qd[i] = random(-1, 1);
      qdd[i] = random(-1, 1);
    }
    t0 = random(0, 1);
  }
  Expr coordinate(int i, double t) const {
    return Expr::coordinate(2 * i, q[i] + t * (qd[i] + t * qdd[i] / 2), qd[i] + t * qdd[i]);
  }
  Expr time(double t) const { return Expr::of_time(0.1 * (t0 + t), 0.1, 0); }
};

using E = const Expr&;
struct Function {
  const char* name;
  std::function<Expr(E, E, E, E)> f;  // of a, b, c in 0.2 to 0.8 and time
};
const Function functions[] = {
    {"sum", [](E a, E b, E c, E t) { return 2 * a + b - c / 3 - t + 1; }},
    {"negative", [](E a, E b, E c, E t) { return -(a * b - c * t); }},
    {"product", [](E a, E b, E c, E t) { return a * b * c * (t + 2); }},
    {"square", [](E a, E, E, E) { return a * a; }},
    {"quotient", [](E a, E b, E c, E t) { return (a + t) / (b * c + 1); }},
    {"number_over", [](E a, E, E, E t) { return 3 / (a + t + 1); }},
    {"compound",
     [](E a, E b, E c, E t) {
       Expr x = a;
       x += b * x;
       x *= x;
       x -= t;
       x /= 2 + c;
       return x;
     }},
    {"sin", [](E a, E b, E c, E t) { return sin(a * b + c - t); }},
    {"cos", [](E a, E b, E c, E t) { return cos(a * b + c - t); }},
    {"tan", [](E a, E b, E c, E t) { return tan(a * b + c / 2 - t); }},
    {"asin", [](E a, E b, E, E t) { return asin(a * b - t); }},
    {"acos", [](E a, E b, E, E t) { return acos(a * b - t); }},
    {"atan", [](E a, E b, E c, E t) { return atan(a * b - c + t); }},
    {"atan2", [](E a, E b, E c, E t) { return atan2(a - 2 * b, c + t - 2); }},
    {"atan2_first_quadrant", [](E a, E b, E c, E t) { return atan2(a * b, c + t); }},
    {"sqrt", [](E a, E b, E c, E t) { return sqrt(a * b + c + t); }},
    {"cbrt", [](E a, E b, E c, E t) { return cbrt(-a * b - c - t); }},
    {"exp", [](E a, E b, E c, E t) { return exp(a * b - c + t); }},
    {"log", [](E a, E b, E c, E t) { return log(a * b + c + t); }},
    {"log10", [](E a, E b, E c, E t) { return log10(a * b + c + t + 1); }},
    {"sinh", [](E a, E b, E c, E t) { return sinh(a * b - c + t); }},
    {"cosh", [](E a, E b, E c, E t) { return cosh(a * b - c + t); }},
    {"tanh", [](E a, E b, E c, E t) { return tanh(a * b - c + t); }},
    {"asinh", [](E a, E b, E c, E t) { return asinh(a * b - c + t); }},
    {"acosh", [](E a, E b, E c, E t) { return acosh(2 + a * b - c / 2 + t); }},
    {"atanh", [](E a, E b, E, E t) { return atanh(a * b - t); }},
    {"pow", [](E a, E b, E c, E t) { return pow(a * b + c + t + 1, -1.7); }},
    {"pow_of_expr", [](E a, E b, E c, E t) { return pow(a + 0.5, b - c + t); }},
    {"abs", [](E a, E b, E c, E t) { return abs(-a * b - c - t); }},
    {"hypot", [](E a, E b, E c, E t) { return hypot(a - c, b + t); }},
    {"apply",
     [](E a, E b, E c, E t) {
       return Expr::apply(
           a * b - c * t, [](double x) { return 1 / (1 + x * x); },
           [](double x) { return -2 * x / std::pow(1 + x * x, 2); },
           [](double x) { return (6 * x * x - 2) / std::pow(1 + x * x, 3); });
     }},
    {"dot", [](E a, E b, E c, E t) { return dot(ExprVector(a, b, t), ExprVector(c * c, 2, a)); }},
    {"cross", [](E a, E b, E c, E t) { return cross(ExprVector(a, b, t), ExprVector(c * c, 2, a)).z(); }},
    {"norm", [](E a, E b, E c, E t) { return norm(a * ExprVector(b, c, t) - Vector3d(1, 0, 2)); }}};

class Derivatives : public testing::TestWithParam<Function> {};
INSTANTIATE_TEST_SUITE_P(OfExpressions, Derivatives, testing::ValuesIn(functions),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(Derivatives, AreThoseOfTheValues) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Path path(seed);
    const auto at = [&](double t) {
      return GetParam().f(path.coordinate(0, t), path.coordinate(1, t), path.coordinate(2, t), path.time(t));
    };
    const Expr e = at(0);
    const Slopes slopes = differentiate([&](double t) { return at(t).value(); });
    double acceleration = e.bias();
    for (int i = 0; i < 3; ++i) acceleration += e.gradient()[2 * i] * path.qdd[i];
    // Functions of the order of one with derivatives up to the eighth below 1e5: d^6 times them.
    EXPECT_NEAR(e.rate(), slopes.first, 1e-9 * (1 + std::abs(slopes.first))) << "seed " << seed;
    EXPECT_NEAR(acceleration, slopes.second, 1e-7 * (1 + std::abs(slopes.second))) << "seed " << seed;
    for (int i = 0; i < 3; ++i) {
      const double slope =
          differentiate([&](double d) {
            Path moved = path;
            moved.q[i] += d;
            return GetParam()
                .f(moved.coordinate(0, 0), moved.coordinate(1, 0), moved.coordinate(2, 0), moved.time(0))
                .value();
          }).first;
      EXPECT_NEAR(e.gradient()[2 * i], slope, 1e-9 * (1 + std::abs(slope))) << "coordinate " << i;
    }
  }
}

/// A mechanism whose positions hold a loop of frames within a loop, points, directions and a velocity constraint.
class Everything : public System {
 public:
  Coordinate a = coordinate("a", 0.5), b = coordinate("b", 0.2), c = coordinate("c", -0.3);
  Loop<2> four_bar = loop<2>("four-bar", {0.8, 1.8});
  Loop<1> reach = loop<1>("reach", {0.3});
  VelocityConstraint& rolling = velocity_constraint("rolling");
  Body& tip = body("tip", Inertia(1, 0.1));
  std::vector<Expr> watched;

 protected:
  void positions() override {
    const Expr crank = a + 0.2 * sin(3 * time());
    const auto p = four_bar.solve([&](const auto& x) {
      return std::array{0.3 * cos(crank) + 0.95 * cos(x[0]) - 0.9 * cos(x[1]) - 1.0,
                        0.3 * sin(crank) + 0.95 * sin(x[0]) - 0.9 * sin(x[1])};
    });
    const Frame rocker = rotate_x(b) * translate(1, 0, 0) * rotate_z(p[1]) * translate(0, 0, 0.2 * c);
    const auto s = reach.solve([&](const auto& x) {
      const Frame end = rocker * rotate({1, 2, -1}, x[0]) * translate(0.4, 0.1, 0);
      return std::array{dot(end.express_point({0.2, 0, 0.1}), ExprVector(0, 0, 1)) - 0.1 * time() - 0.3};
    });
    tip = rocker * rotate({1, 2, -1}, s[0]) * translate(0.4, 0.1, 0);
    const ExprVector point = tip.frame().express_point({0.1, 0.2, 0.3}),
                     direction = tip.frame().express_direction({0.6, 0, 0.8});
    rolling = {{direction.x(), point.x()}, {sin(a * time()), point.y()}, {-0.3, b * c}, {1, p[0]}};
    watched = {p[0],      p[1],          s[0],          point.x(),    point.y(),
               point.z(), direction.x(), direction.y(), direction.z()};
  }
};

TEST(Derivatives, OfLoopsAndFramesAreThoseOfTheirValues) {
  Everything system;
  constexpr double d = 2e-3;  // loops have larger high derivatives
  for (unsigned seed = 0; seed < 8; ++seed) {
    std::mt19937 engine(seed);
    const auto random = [&] { return std::uniform_real_distribution<>(-1, 1)(engine); };
    State s = system.initial_state();
    s.t = 0.2 * random();
    for (int i = 0; i < 3; ++i) {
      s.q[i] += 0.1 * random();
      s.qd[i] = random();
      s.qdd[i] = random();
    }
    const auto at = [&](double t) {
      State moved = s;
      moved.t += t;
      moved.q += t * s.qd + t * t / 2 * s.qdd;
      moved.qd += t * s.qdd;
      system.evaluate(moved);
    };
    at(0);
    const std::vector<Expr> e = system.watched;
    const double phi = system.rolling.velocity(), phi_bias = system.rolling.bias();
    const Gradient row = system.rolling.row();
    for (std::size_t k = 0; k < e.size(); ++k) {
      const Slopes slopes = differentiate(
          [&](double t) {
            at(t);
            return system.watched[k].value();
          },
          d);
      EXPECT_NEAR(e[k].rate(), slopes.first, 1e-9) << "watched " << k << " seed " << seed;
      EXPECT_NEAR(e[k].bias() + e[k].gradient().dot(s.qdd), slopes.second, 1e-6) << "watched " << k;
      for (int i = 0; i < 3; ++i) {
        const double slope = differentiate(
                                 [&](double shift) {
                                   State moved = s;
                                   moved.q[i] += shift;
                                   system.evaluate(moved);
                                   return system.watched[k].value();
                                 },
                                 d)
                                 .first;
        EXPECT_NEAR(e[k].gradient()[i], slope, 1e-9) << "watched " << k << " coordinate " << i;
      }
    }
    // phi. = A qdd + bias; A = d phi / d qd, in which phi is linear.
    const double rate = differentiate(
                            [&](double t) {
                              at(t);
                              return system.rolling.velocity();
                            },
                            d)
                            .first;
    EXPECT_NEAR(row.dot(s.qdd) + phi_bias, rate, 1e-8);
    for (int i = 0; i < 3; ++i) {
      State moved = s;
      moved.qd[i] += 1;
      system.evaluate(moved);
      EXPECT_NEAR(row[i], system.rolling.velocity() - phi, 1e-12);
    }
  }
}

/// A cart on a spring with a pendulum:
///   (M + m) x.. + m l cos a a.. - m l sin a a.^2 + c x. + k x = F
///   m l cos a x.. + m l^2 a.. + m g l sin a = 0
class CartPendulum : public System {
 public:
  static constexpr double M = 3, m = 1.5, l = 0.8, c = 2, k = 40, g = 9.81;
  Coordinate x = coordinate("x"), a = coordinate("a");
  Input push = input("push");
  Body &cart = body("cart", M), &bob = body("bob", m);

 protected:
  void positions() override {
    cart = translate(x, 0, 0);
    bob = translate(x, 0, 0) * rotate_y(-a) * translate(0, 0, -l);
  }
  void forces() override {
    gravity();
    cart.add_force({push.value() - c * x.rate() - k * x.value(), 0, 0}, cart.position());
  }
};

TEST(Linearization, OfAMovingCartWithPendulumIsTheHandDerived) {
  using P = CartPendulum;
  CartPendulum system;
  State s = system.initial_state();
  s.q << 0.3, 0.9;
  s.qd << -0.5, 2.2;
  set_consistent_accelerations(system, s);
  const double S = P::m * P::l * std::sin(s.q[1]), C = P::m * P::l * std::cos(s.q[1]), w = s.qd[1];
  Eigen::Matrix2d M, D, K;
  M << P::M + P::m, C, C, P::m * P::l * P::l;
  D << P::c, -2 * S * w, 0, 0;
  K << P::k, -S * s.qdd[1] - C * w * w, 0, -S * s.qdd[0] + C * P::g;
  const Linearization linear = linearize(system, s);
  EXPECT_LT((linear.M - M).norm(), 1e-13 * M.norm());
  EXPECT_LT((linear.C - D).norm(), 1e-10 * D.norm());  // fourth-order differences, steps of 1e-4
  EXPECT_LT((linear.K - K).norm(), 1e-10 * K.norm());

  // y = (q, qd): qdd = -M^-1 (...) with the accelerations in balance.
  const StateSpace space = linearize_state_space(system, s);
  Eigen::Matrix4d A = Eigen::Matrix4d::Zero();
  A.topRightCorner<2, 2>().setIdentity();
  A.bottomLeftCorner<2, 2>() = -M.inverse() * K;
  A.bottomRightCorner<2, 2>() = -M.inverse() * D;
  Eigen::Vector4d B = Eigen::Vector4d::Zero();
  B.tail<2>() = M.inverse().col(0);
  EXPECT_LT((space.A - A).norm(), 1e-9 * A.norm());
  EXPECT_LT((space.B - B).norm(), 1e-9 * B.norm());
}

}  // namespace
}  // namespace easydyn

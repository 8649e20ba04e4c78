#include <gtest/gtest.h>

#include "easydyn/easydyn.hpp"
#include "tests/reference/textbook_dynamics.hpp"

using namespace easydyn;
using Eigen::VectorXd;
using reference::Jet;
using reference::JetPose;

namespace {

constexpr double l1 = 1.2, l2 = 0.8, m1 = 3, m2 = 2;
const Inertia rod1 = Inertia::box(m1, 0.1, 0.2, l1), rod2 = Inertia::box(m2, 0.3, 0.1, l2);

// Two rods about non-parallel axes, the second sliding along a skew direction driven by a gear and by time.
class SkewMechanism : public System {
 public:
  Coordinate a = coordinate("a", 0.7, 0.9), b = coordinate("b", -0.4, 1.3), c = coordinate("c", 0.2, -0.6);
  Body& first = body("first", rod1);
  Body& second = body("second", rod2);
  void positions() override {
    const Frame arm = rotate_y(a) * translate(0, 0, -l1 / 2);
    first = arm;
    second = arm * translate(0.1, 0, -l1 / 2) * rotate_x(b) *
             rotate_z(0.3 * a + 0.2 * b * b + 0.5 * sin(2 * time())) *
             translate(0.1 * sin(c), 0.2 * c, -l2 / 2);
  }
  void forces() override { gravity(); }
};

reference::TextbookDynamics skew_reference(const State& s) {
  const Jet a = Jet::variable(4, 0, s.q[0]), b = Jet::variable(4, 1, s.q[1]), c = Jet::variable(4, 2, s.q[2]),
            t = Jet::variable(4, 3, s.t);
  const auto k = [](double v) { return Jet::constant(4, v); };
  const JetPose arm = JetPose::identity(4).rotated(1, a).translated(k(0), k(0), k(-l1 / 2));
  const JetPose tip = arm.translated(k(0.1), k(0), k(-l1 / 2))
                          .rotated(0, b)
                          .rotated(2, 0.3 * a + 0.2 * b * b + 0.5 * sin(2 * t))
                          .translated(0.1 * sin(c), 0.2 * c, k(-l2 / 2));
  return reference::textbook_dynamics({{m1, rod1.J, arm}, {m2, rod2.J, tip}}, s.qd, 9.81);
}

TEST(Dynamics, AgreesWithTheTextbookSumOverBodies) {
  SkewMechanism system;
  State s = system.initial_state();
  for (int trial = 0; trial < 20; ++trial) {
    s.q = VectorXd::Random(3) * 2;
    s.qd = VectorXd::Random(3) * 3;
    s.qdd = VectorXd::Random(3) * 5;
    s.t = VectorXd::Random(1)[0] * 3;
    const reference::TextbookDynamics expected = skew_reference(s);
    const Eigen::MatrixXd M = system.compute_mass_matrix(s);
    // 1e-12: the same sums in another order, some hundred roundings of 1e-16 and cancellation between them
    const double scale = expected.M.norm();
    EXPECT_LT((M - expected.M).norm(), 1e-12 * scale);
    EXPECT_LT((system.compute_bias(s) - expected.h).norm(), 1e-12 * (1 + expected.h.norm()));
    EXPECT_LT((system.compute_residual(s) - (expected.M * s.qdd + expected.h)).norm(), 1e-12 * (100 + scale));
    EXPECT_NEAR(system.compute_energy(s).kinetic, expected.kinetic, 1e-12 * (1 + expected.kinetic));
    Eigen::MatrixXd M_direct(3, 3);
    VectorXd bias(3);
    system.compute_mass_and_bias(s, M_direct, bias);
    EXPECT_LT((M_direct - expected.M).norm() + (bias - expected.h).norm(), 1e-12 * (100 + scale));
  }
}

// Plane double pendulum against the equations derived by hand from the Lagrangian (point masses on rods).
class PlanePendulum : public System {
 public:
  Coordinate a = coordinate("a"), b = coordinate("b");
  Body& p1 = body("bob 1", m1);
  Body& p2 = body("bob 2", m2);
  void positions() override {
    p1 = rotate_y(a) * translate(0, 0, -l1);
    p2 = rotate_y(a) * translate(0, 0, -l1) * rotate_y(b - a) * translate(0, 0, -l2);
  }
  void forces() override { gravity(); }
};

TEST(Dynamics, OfThePlaneDoublePendulumIsThatOfLagrange) {
  PlanePendulum system;
  State s = system.initial_state();
  s.q << 0.9, -0.5;
  s.qd << 1.7, -2.2;
  const double c = std::cos(s.q[0] - s.q[1]), sn = std::sin(s.q[0] - s.q[1]), g = 9.81;
  Eigen::Matrix2d M;
  M << (m1 + m2) * l1 * l1, m2 * l1 * l2 * c, m2 * l1 * l2 * c, m2 * l2 * l2;
  const Eigen::Vector2d h(m2 * l1 * l2 * sn * s.qd[1] * s.qd[1] + (m1 + m2) * g * l1 * std::sin(s.q[0]),
                          -m2 * l1 * l2 * sn * s.qd[0] * s.qd[0] + m2 * g * l2 * std::sin(s.q[1]));
  EXPECT_LT((system.compute_mass_matrix(s) - M).norm(), 1e-12 * M.norm());
  EXPECT_LT((system.compute_bias(s) - h).norm(), 1e-12 * h.norm());
}

// Far from the origin the same mechanism must keep its digits.
class TravellingPendulum : public System {
 public:
  explicit TravellingPendulum(double x0) : x0_(x0) {}
  Coordinate a = coordinate("a", 0.5, 1.0);
  Body& bob = body("bob", Inertia(m1, 0.1));
  void positions() override { bob = translate(x0_ + 80 * time(), 0, 0) * rotate_y(a) * translate(0, 0, -l1); }
  void forces() override { gravity(); }

 private:
  double x0_;
};

TEST(Dynamics, LosesNoDigitsTenKilometresAway) {
  TravellingPendulum near(0), far(1e4);
  State s = near.initial_state();
  s.qdd[0] = 2;
  EXPECT_NEAR(near.compute_residual(s)[0], far.compute_residual(s)[0], 1e-10);
}

TEST(Dynamics, OfAnImposedMotionIsExact) {
  // A point on an arm of length r that turns as w t^2: the coordinate slides along the arm.
  class Slider : public System {
   public:
    Coordinate r = coordinate("r", 0.5, 0.3);
    Body& bead = body("bead", 2.0);
    void positions() override { bead = rotate_z(1.5 * time() * time()) * translate(r, 0, 0); }
  } system;
  State s = system.initial_state();
  s.t = 0.8;
  s.qdd[0] = 0.7;
  const double omega = 3 * s.t;
  EXPECT_NEAR(system.compute_residual(s)[0], 2.0 * (0.7 - 0.5 * omega * omega), 1e-13);
  // The drive supplies the moment times the speed: d/dt (m r^2 w) w.
  const double moment = 2.0 * (2 * 0.5 * 0.3 * omega + 0.25 * 3);
  EXPECT_NEAR(system.compute_energy(s).supplied, moment * omega, 1e-12);
}

TEST(System, ReportsAccelerationsOfBodies) {
  SkewMechanism system;
  State s = system.initial_state();
  s.t = 0.6;
  s.qdd << 0.3, -0.8, 1.1;
  const auto position = [&](double t) {
    State moved = s;
    moved.t = s.t + t;
    moved.q = s.q + t * s.qd + 0.5 * t * t * s.qdd;
    system.evaluate(moved);
    return Eigen::Vector3d(system.second.position());
  };
  const double d = 1e-3;
  const Eigen::Vector3d expected =
      (-position(-2 * d) + 16 * position(-d) - 30 * position(0) + 16 * position(d) - position(2 * d)) /
      (12 * d * d);
  system.evaluate(s);
  // rounding 64 eps / (12 d^2) = 1e-9, truncation d^4 / 90 of the sixth derivative, here of the order of 1e3
  EXPECT_LT((system.second.acceleration() - expected).norm(), 1e-8);
}

TEST(System, NamesTheBodyThatIsNotPlaced) {
  class Forgetful : public System {
   public:
    Body& lost = body("lost", 1.0);
    void positions() override {}
  } system;
  try {
    system.evaluate(system.initial_state());
    FAIL();
  } catch (const ModelError& e) {
    EXPECT_STREQ(e.what(), "body \"lost\" of system \"system\" is not placed by positions()");
  }
}

TEST(System, RefusesImpossibleDataByName) {
  class Bad : public System {
   public:
    using System::body;
    using System::coordinate;
    void positions() override {}
  } system;
  EXPECT_THROW(system.body("b", Inertia(-1)), ModelError);
  EXPECT_THROW(system.body("b", Inertia(std::nan(""))), ModelError);
  EXPECT_THROW(system.body("b", Inertia(1, 1, 1, 3)), ModelError);  // triangle inequality
  system.coordinate("x");
  EXPECT_THROW(system.coordinate("x"), ModelError);
  EXPECT_THROW(system.coordinate("y", std::nan("")), ModelError);
}

TEST(Frame, RefusesVelocitiesBeforeTheyAreKnown) {
  class Eager : public System {
   public:
    Coordinate x = coordinate("x");
    Body& b = body("b", 1.0);
    void positions() override {
      b = translate(x, 0, 0);
      (void)b.velocity();
    }
  } system;
  EXPECT_THROW(system.evaluate(system.initial_state()), ModelError);
}

// A trunk with two branches, of rotations about all kinds of axes and of displacements; one motion has a gear. The same
// motions are written in three ways: with coordinates in the order of the motions, in reverse order, and with a second,
// vanishing term in each, so that no motion has a gradient of one entry.
class Branches : public System {
 public:
  enum class Writing { in_order, reversed, with_two_terms };
  explicit Branches(Writing writing) : writing_(writing) {
    for (int i = 0; i < size_of_tree; ++i) {
      const int motion = motion_of(i);
      q_.push_back(coordinate("q" + std::to_string(motion), 0.3 + 0.17 * motion, 0.5 - 0.11 * motion));
    }
    for (int i = 0; i < 3; ++i)
      bodies_.push_back(&body("body " + std::to_string(i), Inertia::box(1 + i, 0.3, 0.4, 0.5)));
  }
  /// Coordinate of motion k, and the reverse.
  int motion_of(int k) const { return writing_ == Writing::reversed ? size_of_tree - 1 - k : k; }

  void positions() override {
    const auto q = [this](int k) {
      const Coordinate& own = q_[static_cast<std::size_t>(motion_of(k))];
      const Coordinate& other = q_[static_cast<std::size_t>(motion_of((k + 3) % size_of_tree))];
      return writing_ == Writing::with_two_terms ? own + 0 * other : Expr(own);
    };
    const Frame trunk = translate(q(0), 0.2, q(1)) * rotate_z(q(2)) * translate(0.3, 0.1, -0.2) *
                        rotate_y(q(3)) * rotate(Eigen::Vector3d(1, 2, -1), q(4));
    *bodies_[0] = trunk * translate(0.1, 0, 0);
    const Frame first = trunk * translate(0, 0.5, 0) * rotate_x(q(5)) * rotate_y(1.5 * q(6)) *
                        translate(0, 0, -0.4) * rotate_x(q(7)) * rotate_z(q(8)) * translate(0.1, q(9), 0);
    *bodies_[1] = first * translate(0, 0.1, 0.2);
    *bodies_[2] = trunk * rotate_z(q(10)) * translate(q(11), 0, 0) * rotate_y(q(12));
  }
  void forces() override { gravity(); }

  static constexpr int size_of_tree = 13;

 private:
  Writing writing_;
  std::vector<Coordinate> q_;
  std::vector<Body*> bodies_;
};

TEST(Dynamics, DoesNotDependOnHowTheMotionsAreWritten) {
  static constexpr int n = Branches::size_of_tree;
  const auto mass_and_bias = [](Branches& system) {
    Eigen::MatrixXd M(n, n), M_by_motion(n, n);
    VectorXd bias(n), bias_by_motion(n);
    system.compute_mass_and_bias(system.initial_state(), M, bias);
    for (int i = 0; i < n; ++i) {
      bias_by_motion[i] = bias[system.motion_of(i)];
      for (int j = 0; j < n; ++j) M_by_motion(i, j) = M(system.motion_of(i), system.motion_of(j));
    }
    return std::pair(M_by_motion, bias_by_motion);
  };
  Branches in_order(Branches::Writing::in_order), reversed(Branches::Writing::reversed),
      two_terms(Branches::Writing::with_two_terms);
  const auto [M, bias] = mass_and_bias(in_order);
  EXPECT_GT(M.norm(), 1);
  for (Branches* other : {&reversed, &two_terms}) {
    const auto [M_other, bias_other] = mass_and_bias(*other);
    // 1e-14: the same products, added in another order
    EXPECT_LT((M_other - M).norm(), 1e-14 * M.norm());
    EXPECT_LT((bias_other - bias).norm(), 1e-14 * (1 + bias.norm()));
  }
}

}  // namespace

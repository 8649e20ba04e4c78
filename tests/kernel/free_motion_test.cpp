#include "easydyn/mbs/free_motion.hpp"

#include <gtest/gtest.h>

#include "easydyn/easydyn.hpp"

namespace easydyn {
namespace {

/// A body without forces, thrown with a spin about its middle axis: it tumbles through every orientation.
class Tumbler : public System {
 public:
  FreeMotion motion = free_motion("body", {1, 2, 3});
  Body& thrown = body("body", Inertia(2, 0.1, 0.2, 0.3));

 protected:
  void positions() override { thrown = motion.frame(); }
};

State thrown(Tumbler& tumbler) {
  State s = tumbler.initial_state();
  s.qd << 0.5, 0, 1, 0.01, 4, 0.02;
  set_consistent_accelerations(tumbler, s);
  return s;
}

Eigen::Vector3d angular_momentum(Tumbler& tumbler, const State& s) {
  tumbler.evaluate(s);
  const Eigen::Matrix3d R = tumbler.thrown.frame().rotation();
  return R * Eigen::Vector3d(0.1, 0.2, 0.3).asDiagonal() * R.transpose() * tumbler.thrown.angular_velocity();
}

TEST(FreeMotion, ChangesItsChartWithoutAJump) {
  Tumbler tumbler;
  State s = thrown(tumbler);
  s.q.tail(3) << 0.3, 1.1, -0.7;
  s.qd.tail(3) << 0.4, -1.2, 0.9;
  s.qdd.tail(3) << 2.0, 1.5, -0.8;
  tumbler.evaluate(s);
  const Eigen::Matrix3d R = tumbler.thrown.frame().rotation();
  const Eigen::Vector3d w = tumbler.thrown.angular_velocity(), v = tumbler.thrown.velocity();
  const Eigen::Vector3d point = tumbler.thrown.position();
  const double energy = tumbler.compute_energy(s).kinetic;
  // The angular acceleration shows in the residual: moments about the world axes.
  const auto moment = [&](const State& state) -> Eigen::Vector3d {
    const double h = 1e-4;
    const auto at = [&](double t) {
      State moved = state;
      moved.q += t * state.qd + 0.5 * t * t * state.qdd;
      moved.qd += t * state.qdd;
      return angular_momentum(tumbler, moved);
    };
    return (at(h) - at(-h)) / (2 * h);
  };
  const Eigen::Vector3d before = moment(s);
  State changed = s;
  Eigen::VectorXd pseudo = s.qdd;
  ASSERT_TRUE(tumbler.update_charts(changed, &pseudo));
  EXPECT_EQ(changed.q.tail(3).norm(), 0);
  EXPECT_EQ(pseudo, changed.qdd);
  tumbler.evaluate(changed);
  EXPECT_LT((tumbler.thrown.frame().rotation() - R).norm(), 1e-14);
  EXPECT_LT((tumbler.thrown.angular_velocity() - w).norm(), 1e-14);
  EXPECT_LT((tumbler.thrown.velocity() - v).norm(), 1e-14);
  EXPECT_LT((tumbler.thrown.position() - point).norm(), 1e-14);
  EXPECT_NEAR(tumbler.compute_energy(changed).kinetic, energy, 1e-14);
  EXPECT_LT((moment(changed) - before).norm(), 1e-7);
  EXPECT_FALSE(tumbler.update_charts(changed));
  // The old state is still what it was.
  tumbler.evaluate(s);
  EXPECT_LT((tumbler.thrown.frame().rotation() - R).norm(), 1e-15);
}

TEST(FreeMotion, TumblesThroughEveryOrientation) {
  Tumbler tumbler;
  const State start = thrown(tumbler);
  const Eigen::Vector3d momentum = angular_momentum(tumbler, start);
  const double energy = tumbler.compute_energy(start).kinetic;
  const AdaptiveOptions tight{.relative_tolerance = 1e-9, .absolute_tolerance = 1e-11};
  RungeKutta runge_kutta(tumbler, start, tight);
  Cvode adams(tumbler, start, tight, Cvode::Method::adams);
  Ida ida(tumbler, start, tight);
  Newmark newmark(tumbler, start, {.step = 1e-3});
  Integrator* const all[] = {&runge_kutta, &adams, &ida, &newmark};
  const double allowed[] = {1e-6, 1e-6, 1e-5, 1e-4};
  Eigen::Matrix3d exact;
  for (int i = 0; i < 4; ++i) {
    int changes = 0;
    Eigen::Matrix3d chart = start.charts[0];
    all[i]->advance(10, [&](const State& s) {
      changes += s.charts[0] != chart;
      chart = s.charts[0];
    });
    const State& s = all[i]->state();
    EXPECT_GT(changes, 20) << i;
    EXPECT_LT((angular_momentum(tumbler, s) - momentum).norm() / momentum.norm(), allowed[i]) << i;
    EXPECT_NEAR(tumbler.compute_energy(s).kinetic / energy, 1, allowed[i]) << i;
    EXPECT_NEAR(tumbler.thrown.position().x(), 1 + 5, 1e-6) << i;
    if (i == 0) exact = tumbler.thrown.frame().rotation();
    EXPECT_LT((tumbler.thrown.frame().rotation() - exact).norm(), 300 * allowed[i]) << i;
  }
}

TEST(FreeMotion, TurnsThroughEveryOrientationOfAMovingFrame) {
  class Carried : public System {
   public:
    FreeMotion motion = free_motion("body");
    Body& carried = body("body", {2, 0.1, 0.2, 0.3});
    bool on_ground = false;

   protected:
    void positions() override {
      const Expr t = time();
      carried = motion.frame(on_ground ? Frame() : Frame(translate(0.3 * t * t, 0, 0) * rotate_z(1.5 * t)));
    }
  };
  // Without forces the path in space does not depend on the frame that the coordinates count from.
  Carried inertial, rotating;
  inertial.on_ground = true;
  State a = inertial.initial_state(), b = rotating.initial_state();
  a.qd << 0, 0, 1, 0.01, 4, 0.02;
  b.qd << 0, 0, 1, 0.01, 4, 0.02 - 1.5;
  const AdaptiveOptions tight{.relative_tolerance = 1e-10, .absolute_tolerance = 1e-12};
  RungeKutta first(inertial, a, tight), second(rotating, b, tight);
  first.advance(3);
  second.advance(3);
  inertial.evaluate(first.state());
  rotating.evaluate(second.state());
  EXPECT_NE(second.state().charts[0], b.charts[0]);
  // Measured 2e-9: the two runs err along the spin of 12 rad.
  EXPECT_LT((inertial.carried.frame().rotation() - rotating.carried.frame().rotation()).norm(), 2e-8);
  EXPECT_LT((inertial.carried.position() - rotating.carried.position()).norm(), 2e-8);
}

}  // namespace
}  // namespace easydyn

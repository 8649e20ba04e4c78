#pragma once

#include <gtest/gtest.h>

#include <functional>

#include "easydyn/easydyn.hpp"

namespace easydyn {

/// Two free bodies with one force element between them, to test what every element must satisfy.
class TwoBodies : public System {
 public:
  FreeMotion motion_A = free_motion("A"), motion_B = free_motion("B");
  Body& A = body("A", Inertia(2, 0.3, 0.4, 0.5));
  Body& B = body("B", Inertia(3, 0.6, 0.5, 0.8));
  std::function<void(TwoBodies&)> element;
  bool is_active = true;

  explicit TwoBodies(std::function<void(TwoBodies&)> e) : System("two bodies"), element(std::move(e)) {}

  double now() const { return time().value(); }

  void positions() override {
    A = motion_A.frame();
    B = motion_B.frame();
  }
  void forces() override {
    if (is_active) element(*this);
  }

  /// Generalised forces of the element alone.
  Eigen::VectorXd forces_of_element(const State& s) {
    is_active = true;
    const Eigen::VectorXd with = compute_residual(s);
    is_active = false;
    const Eigen::VectorXd without = compute_residual(s);
    is_active = true;
    return without - with;
  }
};

/// A random state: A near the origin, B near `place_of_B`, both turned and moving.
inline State random_state(TwoBodies& system, const Eigen::Vector3d& place_of_B, double spread = 0.3) {
  State s = system.initial_state();
  s.t = 0.3;
  s.q = spread * Eigen::VectorXd::Random(12);
  s.q.segment(6, 3) += place_of_B;
  s.qd = Eigen::VectorXd::Random(12);
  return s;
}

/// What the element takes from the motion it stores, turns into heat, or it has brought in itself:
///   qd . Q + dV/dt + dissipated - supplied = 0
/// with dV/dt by differences of fourth order along the motion. And it exerts no force on the whole (nor moment), as
/// the forces on A and B are opposite, unless it comes from outside.
inline void expect_balance(TwoBodies& system, const State& s, bool is_from_outside = false) {
  const Eigen::VectorXd Q = system.forces_of_element(s);
  const EnergyBalance e = system.compute_energy(s);
  const auto potential = [&](double h) {
    State moved = s;
    moved.t += h;
    moved.q += h * s.qd;
    return system.compute_energy(moved).potential;
  };
  constexpr double h = 1e-3;
  const double V_rate =
      (potential(-2 * h) - 8 * potential(-h) + 8 * potential(h) - potential(2 * h)) / (12 * h);
  const double scale = Q.cwiseProduct(s.qd).cwiseAbs().sum() + std::abs(V_rate) + std::abs(e.supplied);
  // 1e-8: differences of fourth order with h = 1e-3 leave 1e-10, rounding 1e-13 / h
  EXPECT_NEAR(s.qd.dot(Q) + V_rate + e.dissipated - e.supplied, 0, 1e-8 * scale);
  EXPECT_GT(scale, 0) << "the element does nothing at this state";
  if (is_from_outside) return;
  EXPECT_LT((Q.segment(0, 3) + Q.segment(6, 3)).norm(), 1e-10 * Q.norm()) << "sum of the forces";
}

}  // namespace easydyn

#pragma once

#include <initializer_list>
#include <string>
#include <utility>

#include "easydyn/math/expr.hpp"

namespace easydyn {

/// A condition on velocities that no condition on positions replaces (non-holonomic): rolling without slip, a
/// skate's edge. Linear in the rates of expressions e_i with coefficients c_i:
///
///   phi = sum_i c_i(q, t) e_i.(q, t) = 0        e.g. x. - r cos(psi) spin. = 0
///
///     VelocityConstraint& no_slip = velocity_constraint("no slip along x");
///     void positions() override { ...; no_slip = {{1, x}, {-r * cos(psi), spin}}; }
///
/// Its force is lambda times the row A = d phi / d qd; lambda is what the constraint exerts along phi.
/// Made by `System::velocity_constraint`, assigned in positions().
class VelocityConstraint {
 public:
  using Term = std::pair<Expr, Expr>;  ///< coefficient, and the expression whose rate it multiplies

  explicit VelocityConstraint(std::string name) : name_(std::move(name)) {}
  VelocityConstraint(const VelocityConstraint&) = delete;
  VelocityConstraint& operator=(std::initializer_list<Term> terms) {
    velocity_ = bias_ = 0;
    row_ = Gradient();
    for (const auto& [c, e] : terms) {
      velocity_ += c.value() * e.rate();
      bias_ += c.rate() * e.rate() + c.value() * e.bias();
      row_ = Gradient::combine(1, row_, c.value(), e.gradient());
    }
    is_given_ = true;
    return *this;
  }

  const std::string& name() const { return name_; }
  double velocity() const { return velocity_; }  ///< phi at the last evaluation
  double bias() const { return bias_; }          ///< phi. with qdd = 0
  const Gradient& row() const { return row_; }   ///< A
  double force() const { return lambda_; }       ///< lambda

 private:
  friend class System;
  std::string name_;
  bool is_given_ = false;
  double velocity_ = 0, bias_ = 0, lambda_ = 0;
  Gradient row_;
};

}  // namespace easydyn

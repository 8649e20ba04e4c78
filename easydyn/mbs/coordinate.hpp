#pragma once

#include <functional>
#include <string>

#include "easydyn/math/expr.hpp"

namespace easydyn {

class System;

/// A motion given in time: value, rate, acceleration.
struct ImposedMotion {
  double value = 0, rate = 0, acceleration = 0;
  ImposedMotion() = default;
  /// All three, which must agree: rate and acceleration are not derived from the value.
  ImposedMotion(double value_, double rate_, double acceleration_)
      : value(value_), rate(rate_), acceleration(acceleration_) {}
};

/// A generalised coordinate q_i of a system; in expressions it stands for its current value and rate.
/// Made by `System::coordinate`.
///
/// A coordinate that is held (locked, or given in time) leaves the unknowns: q, qd and qdd of a State no longer
/// contain it, and `System::holding_force` tells the generalised force that holds it. Hold and release between
/// runs, not during one.
class Coordinate {
 public:
  operator Expr() const;  // NOLINT: a coordinate is an expression
  double value() const;
  double rate() const;
  /// Where it stands in State::q. @throws ModelError if it is held
  int index() const;

  /// Adds the generalised force Q [N, N m] that works on this coordinate, in System::forces(). Its energy is the
  /// caller's to account for; where the coordinate is held, what holds it supplies -Q times its rate. @throws ModelError outside forces()
  void add_force(double Q) const;

  void lock(double value);                                        ///< holds it at a value
  void prescribe(std::function<ImposedMotion(double t)> motion);  ///< moves it as given
  void release();                                                 ///< makes it free again
  bool is_held() const;

  friend Expr operator-(const Coordinate& a) { return -Expr(a); }
  friend Expr operator+(const Coordinate& a, const Expr& b) { return Expr(a) + b; }
  friend Expr operator+(const Expr& a, const Coordinate& b) { return a + Expr(b); }
  friend Expr operator+(const Coordinate& a, const Coordinate& b) { return Expr(a) + Expr(b); }
  friend Expr operator-(const Coordinate& a, const Expr& b) { return Expr(a) - b; }
  friend Expr operator-(const Expr& a, const Coordinate& b) { return a - Expr(b); }
  friend Expr operator-(const Coordinate& a, const Coordinate& b) { return Expr(a) - Expr(b); }
  friend Expr operator*(const Coordinate& a, const Expr& b) { return Expr(a) * b; }
  friend Expr operator*(const Expr& a, const Coordinate& b) { return a * Expr(b); }
  friend Expr operator*(const Coordinate& a, const Coordinate& b) { return Expr(a) * Expr(b); }
  friend Expr operator/(const Coordinate& a, const Expr& b) { return Expr(a) / b; }
  friend Expr operator/(const Expr& a, const Coordinate& b) { return a / Expr(b); }

 private:
  friend class System;
  Coordinate(System& system, int number) : system_(&system), number_(number) {}
  System* system_;
  int number_;  // in the order of declaration
};

}  // namespace easydyn

#pragma once

#include <string>

#include "easydyn/math/expr.hpp"

namespace easydyn {

class System;

/// A generalised coordinate q_i of a system; in expressions it stands for its current value and rate.
/// Made by `System::coordinate`.
class Coordinate {
 public:
  operator Expr() const;  // NOLINT: a coordinate is an expression
  double value() const;
  double rate() const;
  int index() const { return index_; }

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
  Coordinate(const System& system, int index) : system_(&system), index_(index) {}
  const System* system_;
  int index_;
};

}  // namespace easydyn

#pragma once

#include <cmath>

#include "easydyn/math/gradient.hpp"

namespace easydyn {

/// A scalar function f(q, t) with everything that dynamics needs of it, exact and propagated by the chain
/// rule:
///
///   value     f
///   rate      f.  = sum_i (df/dq_i) qd_i + df/dt            total time rate
///   bias      f.. with qdd = 0                              velocity-dependent part of f..
///   gradient  df/dq_i                                       partial velocities
///
/// so that f.. = gradient . qdd + bias. Coordinates, the time and numbers convert to Expr; + - * / and the
/// functions below apply. A function of the user's enters by its value and two derivatives: `apply`.
///
/// Outside the domain of a function (the root of a negative number) the result is not a number, as in the standard library.
class Expr {
 public:
  Expr(double constant = 0) : value_(constant) {}  // NOLINT: numbers are expressions

  /// The coordinate q_i with its rate.
  static Expr coordinate(int i, double q, double qd) { return Expr(q, qd, 0, Gradient::unit(i)); }
  /// A given function of time f(t): imposed motion.
  static Expr of_time(double f, double f_dot, double f_ddot) { return Expr(f, f_dot, f_ddot, Gradient()); }
  /// From its parts, as a solver of implicit equations knows them.
  static Expr of_parts(double value, double rate, double bias, Gradient gradient) {
    return Expr(value, rate, bias, std::move(gradient));
  }
  /// f(a) from f, f', f'' taken at the value of a.
  static Expr apply(const Expr& a, double f, double f1, double f2) {
    if (a.is_constant()) return Expr(f);
    return Expr(f, f1 * a.rate_, f2 * a.rate_ * a.rate_ + f1 * a.bias_, Gradient::scale(f1, a.gradient_));
  }
  /// f(a) from the functions f, f' and f'', e.g. of a cam or a table.
  template <class F, class F1, class F2>
  requires requires(F f, F1 f1, F2 f2, double x) { f(x) + f1(x) + f2(x); }
  static Expr apply(const Expr& a, const F& f, const F1& f1, const F2& f2) {
    return apply(a, double(f(a.value_)), double(f1(a.value_)), double(f2(a.value_)));
  }

  double value() const { return value_; }
  double rate() const { return rate_; }
  double bias() const { return bias_; }
  const Gradient& gradient() const { return gradient_; }
  /// True for numbers and functions of numbers: depends neither on q nor on t.
  bool is_constant() const { return constant_; }

  Expr operator-() const { return scaled(-1, *this); }
  friend Expr operator+(const Expr& a, const Expr& b) { return linear(1, a, 1, b); }
  friend Expr operator-(const Expr& a, const Expr& b) { return linear(1, a, -1, b); }
  friend Expr operator*(const Expr& a, const Expr& b) {
    if (a.constant_) return scaled(a.value_, b);
    if (b.constant_) return scaled(b.value_, a);
    return Expr(a.value_ * b.value_, a.rate_ * b.value_ + a.value_ * b.rate_,
                a.bias_ * b.value_ + 2 * a.rate_ * b.rate_ + a.value_ * b.bias_,
                Gradient::combine(b.value_, a.gradient_, a.value_, b.gradient_));
  }
  friend Expr operator/(const Expr& a, const Expr& b) {
    const double r = 1 / b.value_;
    return a * apply(b, r, -r * r, 2 * r * r * r);
  }
  Expr& operator+=(const Expr& b) { return *this = *this + b; }
  Expr& operator-=(const Expr& b) { return *this = *this - b; }
  Expr& operator*=(const Expr& b) { return *this = *this * b; }
  Expr& operator/=(const Expr& b) { return *this = *this / b; }

 private:
  Expr(double value, double rate, double bias, Gradient gradient)
      : value_(value), rate_(rate), bias_(bias), constant_(false), gradient_(std::move(gradient)) {}
  static Expr scaled(double a, const Expr& A) {
    if (A.constant_) return Expr(a * A.value_);
    return Expr(a * A.value_, a * A.rate_, a * A.bias_, Gradient::scale(a, A.gradient_));
  }
  static Expr linear(double a, const Expr& A, double b, const Expr& B) {
    const double value = a * A.value_ + b * B.value_;
    if (A.constant_ && B.constant_) return Expr(value);
    return Expr(value, a * A.rate_ + b * B.rate_, a * A.bias_ + b * B.bias_,
                Gradient::combine(a, A.gradient_, b, B.gradient_));
  }

  double value_ = 0, rate_ = 0, bias_ = 0;
  bool constant_ = true;
  Gradient gradient_;
};

inline Expr sin(const Expr& a) {
  const double s = std::sin(a.value());
  return Expr::apply(a, s, std::cos(a.value()), -s);
}
inline Expr cos(const Expr& a) {
  const double c = std::cos(a.value());
  return Expr::apply(a, c, -std::sin(a.value()), -c);
}
inline Expr tan(const Expr& a) {
  const double t = std::tan(a.value()), d = 1 + t * t;
  return Expr::apply(a, t, d, 2 * t * d);
}
inline Expr asin(const Expr& a) {
  const double x = a.value(), d = 1 / std::sqrt(1 - x * x);
  return Expr::apply(a, std::asin(x), d, x * d * d * d);
}
inline Expr acos(const Expr& a) {
  const double x = a.value(), d = 1 / std::sqrt(1 - x * x);
  return Expr::apply(a, std::acos(x), -d, -x * d * d * d);
}
inline Expr atan(const Expr& a) {
  const double x = a.value(), d = 1 / (1 + x * x);
  return Expr::apply(a, std::atan(x), d, -2 * x * d * d);
}
inline Expr sqrt(const Expr& a) {
  const double r = std::sqrt(a.value());
  return Expr::apply(a, r, 0.5 / r, -0.25 / (r * a.value()));
}
inline Expr exp(const Expr& a) {
  const double e = std::exp(a.value());
  return Expr::apply(a, e, e, e);
}
inline Expr log(const Expr& a) {
  const double x = a.value();
  return Expr::apply(a, std::log(x), 1 / x, -1 / (x * x));
}
inline Expr sinh(const Expr& a) {
  const double s = std::sinh(a.value());
  return Expr::apply(a, s, std::cosh(a.value()), s);
}
inline Expr cosh(const Expr& a) {
  const double c = std::cosh(a.value());
  return Expr::apply(a, c, std::sinh(a.value()), c);
}
inline Expr asinh(const Expr& a) {
  const double x = a.value(), d = 1 / std::sqrt(1 + x * x);
  return Expr::apply(a, std::asinh(x), d, -x * d * d * d);
}
inline Expr acosh(const Expr& a) {
  const double x = a.value(), d = 1 / std::sqrt(x * x - 1);
  return Expr::apply(a, std::acosh(x), d, -x * d * d * d);
}
inline Expr atanh(const Expr& a) {
  const double x = a.value(), d = 1 / (1 - x * x);
  return Expr::apply(a, std::atanh(x), d, 2 * x * d * d);
}
inline Expr cbrt(const Expr& a) {
  const double r = std::cbrt(a.value()), d = 1 / (3 * r * r);
  return Expr::apply(a, r, d, -2 * d / (3 * a.value()));
}
inline Expr log10(const Expr& a) {
  return log(a) * 0.43429448190325182765;
}
/// |a|; its derivative at a = 0 is taken as 0.
inline Expr abs(const Expr& a) {
  const double x = a.value();
  return Expr::apply(a, std::abs(x), x > 0 ? 1.0 : x < 0 ? -1.0 : 0.0, 0.0);
}
inline Expr tanh(const Expr& a) {
  const double t = std::tanh(a.value()), d = 1 - t * t;
  return Expr::apply(a, t, d, -2 * t * d);
}
/// a^p for a constant exponent.
inline Expr pow(const Expr& a, double p) {
  const double x = a.value();
  const double f1 = p == 0 ? 0 : p * std::pow(x, p - 1);  // no 0 * infinity at x = 0
  const double f2 = p == 0 || p == 1 ? 0 : p * (p - 1) * std::pow(x, p - 2);
  return Expr::apply(a, std::pow(x, p), f1, f2);
}
/// a^b = exp(b log a), a > 0.
inline Expr pow(const Expr& a, const Expr& b) {
  return b.is_constant() ? pow(a, b.value()) : exp(b * log(a));
}
/// Distance sqrt(x^2 + y^2) of the point (x, y), not at the origin.
inline Expr hypot(const Expr& x, const Expr& y) {
  return sqrt(x * x + y * y);
}
/// Angle of the point (x, y), continuous through all four quadrants (jump at the negative x axis).
Expr atan2(const Expr& y, const Expr& x);

}  // namespace easydyn

#pragma once

#include <Eigen/Core>

#include "easydyn/math/expr.hpp"

namespace easydyn {

/// Three expressions: a point or a direction in world axes with its rate, bias and gradient.
class ExprVector {
 public:
  ExprVector() = default;
  ExprVector(Expr x, Expr y, Expr z) : e_{std::move(x), std::move(y), std::move(z)} {}
  ExprVector(const Eigen::Vector3d& v) : e_{v.x(), v.y(), v.z()} {}  // NOLINT: vectors are expressions

  const Expr& operator[](int i) const { return e_[i]; }
  Expr& operator[](int i) { return e_[i]; }
  const Expr& x() const { return e_[0]; }
  const Expr& y() const { return e_[1]; }
  const Expr& z() const { return e_[2]; }
  Eigen::Vector3d value() const { return {e_[0].value(), e_[1].value(), e_[2].value()}; }
  Eigen::Vector3d rate() const { return {e_[0].rate(), e_[1].rate(), e_[2].rate()}; }
  Eigen::Vector3d bias() const { return {e_[0].bias(), e_[1].bias(), e_[2].bias()}; }

  friend ExprVector operator+(const ExprVector& a, const ExprVector& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
  }
  friend ExprVector operator-(const ExprVector& a, const ExprVector& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  }
  friend ExprVector operator*(const Expr& s, const ExprVector& a) { return {s * a[0], s * a[1], s * a[2]}; }

 private:
  Expr e_[3];
};

inline Expr dot(const ExprVector& a, const ExprVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline ExprVector cross(const ExprVector& a, const ExprVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
/// Length, not zero.
inline Expr norm(const ExprVector& a) {
  return sqrt(dot(a, a));
}

}  // namespace easydyn

#include "easydyn/math/expr.hpp"

namespace easydyn {

Expr atan2(const Expr& y, const Expr& x) {
  // Locally atan2 is an arc tangent of the smaller ratio plus a constant, whose derivatives vanish.
  const double angle = std::atan2(y.value(), x.value());
  const Expr local = std::abs(x.value()) >= std::abs(y.value()) ? atan(y / x) : -atan(x / y);
  return local + (angle - local.value());
}

}  // namespace easydyn

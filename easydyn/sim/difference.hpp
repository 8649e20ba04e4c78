#pragma once

#include "easydyn/mbs/system.hpp"

namespace easydyn {

/// Derivative at d = 0 of what `at(d)` returns, an error of order step^4:
///
///   (f(-2d) - 8 f(-d) + 8 f(d) - f(2d)) / 12 d
///
/// `at(0)` is called at the end, so that what it sets is as before.
template <class Function>
Eigen::VectorXd central_difference(Function at, double step) {
  Eigen::VectorXd sum = at(-2 * step);
  sum -= 8 * at(-step);
  sum += 8 * at(step);
  sum -= at(2 * step);
  at(0.0);
  return sum / (12 * step);
}

/// An input that returns to its value at the end of the scope, however that ends.
class KeptInput {
 public:
  KeptInput(System& system, int i) : system_(system), index_(i), value_(system.input_value(i)) {}
  ~KeptInput() { system_.set_input(index_, value_); }
  KeptInput(const KeptInput&) = delete;
  double value() const { return value_; }

 private:
  System& system_;
  int index_;
  double value_;
};

}  // namespace easydyn

#pragma once

namespace easydyn {

class System;

/// A first-order state x_i of a system, x. = f(q, qd, x, t): a current, an oil pressure, the integral of a
/// controller. Made by `System::first_order_state`; forces() reads its value and sets its rate.
class FirstOrderState {
 public:
  double value() const;
  /// f, at each evaluation. @throws ModelError outside forces()
  void set_rate(double f) const;
  int index() const { return index_; }  ///< where it stands in State::x

 private:
  friend class System;
  FirstOrderState(System& system, int index) : system_(&system), index_(index) {}
  System* system_;
  int index_;
};

/// A number that acts on the system from outside: a voltage, a valve, a force. Constant between calls of set();
/// `linearize` gives the matrix of its effect. Made by `System::input`.
class Input {
 public:
  double value() const;
  void set(double value) const;
  int index() const { return index_; }

 private:
  friend class System;
  Input(System& system, int index) : system_(&system), index_(index) {}
  System* system_;
  int index_;
};

/// A number that the system gives to the outside: a sensor, a measured force. forces() sets it at each evaluation, or a
/// function gives it once accelerations are known, too; `linearize_state_space` gives the matrices of what it sees.
/// Made by `System::output`.
///
///     Output comfort = output("comfort", [this] { return car_body.acceleration().z(); });
class Output {
 public:
  /// @throws ModelError outside forces()
  void set(double value) const;
  double value() const;  ///< at the last evaluation
  int index() const { return index_; }

 private:
  friend class System;
  Output(System& system, int index) : system_(&system), index_(index) {}
  System* system_;
  int index_;
};

}  // namespace easydyn

#pragma once

#include <Eigen/Core>
#include <string>

#include "easydyn/mbs/system.hpp"

namespace easydyn {

/// Direct-current motor with permanent magnets between a stator A and a rotor B.
///
///   L i. = u - R i - k n w          M = n k i        on B about the axis of A
///
/// w relative angular velocity about the axis, u voltage, n gear ratio (motor speed n w). The inertia of the motor's own
/// rotor belongs to a body (turned by n times the angle, if geared). The current is a first-order state "name.current".
/// Potential energy L i^2 / 2, dissipated power R i^2, supplied power u i.
class DcMotor {
 public:
  struct Data {
    double resistance = 0;  ///< R [ohm], >= 0
    double inductance = 0;  ///< L [H], > 0
    double constant = 0;    ///< k [N m/A = V s/rad], > 0
    double gear_ratio = 1;  ///< n, not 0
  };

  /// @throws ModelError naming the motor, the value and the range
  DcMotor(System& system, std::string name, const Data& data, double initial_current = 0);

  /// Applies the moment and sets the rate of the current. Once per evaluation, in System::forces().
  void apply(const Frame& stator_A, const Frame& rotor_B, const Eigen::Vector3d& axis_A, double voltage);

  const FirstOrderState& current() const { return current_; }  ///< i [A]
  double moment() const { return moment_; }                    ///< M at the last evaluation [N m]
  const std::string& name() const { return name_; }

 private:
  std::string name_, object_;  // object_: as errors call it
  Data data_;
  FirstOrderState current_;
  double moment_ = 0;
};

}  // namespace easydyn

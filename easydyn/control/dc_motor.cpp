#include "easydyn/control/dc_motor.hpp"

#include "easydyn/forces/account.hpp"
#include "easydyn/require.hpp"

namespace easydyn {

using Eigen::Vector3d;

DcMotor::DcMotor(System& system, std::string name, const Data& data, double initial_current)
    : name_(std::move(name)),
      object_("motor \"" + name_ + "\""),
      data_(data),
      current_(system.first_order_state(name_ + ".current", initial_current)) {
  require_not_negative(object_, "resistance", data.resistance, "ohm");
  require_positive(object_, "inductance", data.inductance, "H");
  require_positive(object_, "constant", data.constant, "N m/A");
  require(data.gear_ratio != 0, object_, "gear ratio", data.gear_ratio, "", "not 0");
}

void DcMotor::apply(const Frame& stator_A, const Frame& rotor_B, const Vector3d& axis_A, double voltage) {
  require_finite(object_, "voltage", voltage, "V");
  const double length = axis_A.norm();
  require(length > 0, object_, "length of the axis", length, "", "> 0");
  const Vector3d axis = stator_A.direction(axis_A / length);
  const double i = current_.value(), k = data_.constant * data_.gear_ratio,
               w = axis.dot(rotor_B.angular_velocity() - stator_A.angular_velocity());
  current_.set_rate((voltage - data_.resistance * i - k * w) / data_.inductance);
  moment_ = k * i;
  rotor_B.add_moment(moment_ * axis);
  stator_A.add_moment(-moment_ * axis);
  account(stator_A, rotor_B, 0.5 * data_.inductance * i * i, data_.resistance * i * i, voltage * i);
}

}  // namespace easydyn

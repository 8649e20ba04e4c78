#include "easydyn/control/pid.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "easydyn/require.hpp"

namespace easydyn {

Pid::Pid(System& system, std::string name, const Data& data)
    : name_(std::move(name)),
      data_(data),
      integral_(system.first_order_state(name_ + ".integral")),
      filter_(system.first_order_state(name_ + ".filter")) {
  const std::string object = "controller \"" + name_ + "\"";
  require_finite(object, "proportional gain", data.proportional, "");
  require_finite(object, "integral gain", data.integral, "1/s");
  require_finite(object, "derivative gain", data.derivative, "s");
  if (data.derivative != 0) require_positive(object, "filter time", data.filter_time, "s");
  if (!(data.lower < data.upper))
    throw ModelError(
        fmt::format("{}: limits {:g} and {:g}, the first must be less", object, data.lower, data.upper));
  const bool is_limited = std::isfinite(data.lower) || std::isfinite(data.upper);
  if (is_limited && data.integral != 0) require_positive(object, "tracking time", data.tracking_time, "s");
}

double Pid::compute(double error) {
  const double e_rate = data_.derivative != 0 ? (error - filter_.value()) / data_.filter_time : 0;
  const double wanted =
      data_.proportional * error + data_.integral * integral_.value() + data_.derivative * e_rate;
  u_ = std::clamp(wanted, data_.lower, data_.upper);
  filter_.set_rate(e_rate);
  double integral_rate = error;
  if (u_ != wanted && data_.integral != 0)
    integral_rate += (u_ - wanted) / (data_.integral * data_.tracking_time);
  integral_.set_rate(data_.integral != 0 ? integral_rate : 0);
  return u_;
}

}  // namespace easydyn

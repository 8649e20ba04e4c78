#include "easydyn/error.hpp"
#include "easydyn/mbs/system.hpp"

namespace easydyn {

double FirstOrderState::value() const {
  if (!system_->x_) throw ModelError("a first-order state has a value in positions() and forces() only");
  return system_->x_[index_];
}

void FirstOrderState::set_rate(double f) const {
  if (!system_->in_forces_) throw ModelError("the rate of a first-order state is set inside forces() only");
  system_->rates_[static_cast<std::size_t>(index_)] = f;
}

double Input::value() const {
  return system_->input_value(index_);
}

void Input::set(double value) const {
  system_->set_input(index_, value);
}

void Output::set(double value) const {
  if (!system_->in_forces_) throw ModelError("an output is set inside forces() only");
  system_->outputs_[static_cast<std::size_t>(index_)].value = value;
}

double Output::value() const {
  return system_->output_value(index_);
}

}  // namespace easydyn

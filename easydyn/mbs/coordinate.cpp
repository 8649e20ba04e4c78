#include <fmt/format.h>

#include "easydyn/error.hpp"
#include "easydyn/mbs/system.hpp"

namespace easydyn {

Coordinate::operator Expr() const {
  const System::CoordinateData& c = system_->data_of(*this);
  if (!c.is_held && system_->q_) return Expr::coordinate(c.slot, system_->q_[c.slot], system_->qd_[c.slot]);
  return Expr::of_parts(value(), c.now.rate, c.now.acceleration, Gradient::unit(c.slot));
}

double Coordinate::value() const {
  if (!system_->q_)
    throw ModelError(
        fmt::format("coordinate \"{}\" has a value in positions() and forces() only; elsewhere it is in "
                    "State::q",
                    system_->data_of(*this).name));
  const System::CoordinateData& c = system_->data_of(*this);
  return c.is_held ? c.now.value : system_->q_[c.slot];
}

double Coordinate::rate() const {
  if (!system_->qd_)
    throw ModelError(
        fmt::format("coordinate \"{}\" has a rate in positions() and forces() only; elsewhere it is in "
                    "State::qd",
                    system_->data_of(*this).name));
  const System::CoordinateData& c = system_->data_of(*this);
  return c.is_held ? c.now.rate : system_->qd_[c.slot];
}

int Coordinate::index() const {
  const System::CoordinateData& c = system_->data_of(*this);
  if (c.is_held)
    throw ModelError(fmt::format("coordinate \"{}\" is held: it is not among the unknowns", c.name));
  return c.slot;
}

void Coordinate::add_force(double Q) const {
  if (!system_->in_forces_) throw ModelError("a generalised force is added inside forces() only");
  const System::CoordinateData& c = system_->data_of(*this);
  system_->generalized_forces_.push_back({c.slot, Q});
  if (c.is_held) system_->energy().supplied -= Q * c.now.rate;
}

void Coordinate::lock(double value) {
  if (!std::isfinite(value))
    throw ModelError(
        fmt::format("coordinate \"{}\" locked at {}: must be finite", system_->data_of(*this).name, value));
  prescribe([value](double) { return ImposedMotion{value, 0, 0}; });
}

void Coordinate::prescribe(std::function<ImposedMotion(double)> motion) {
  System::CoordinateData& c = system_->coordinates_[static_cast<std::size_t>(number_)];
  c.is_held = true;
  c.imposed = std::move(motion);
  system_->assign_slots();
}

void Coordinate::release() {
  system_->coordinates_[static_cast<std::size_t>(number_)].is_held = false;
  system_->assign_slots();
}

bool Coordinate::is_held() const {
  return system_->data_of(*this).is_held;
}

}  // namespace easydyn

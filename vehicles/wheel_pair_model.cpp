#include "vehicles/wheel_pair_model.hpp"

namespace easydyn::vehicles {

WheelPairModel::WheelPairModel(System& system, const WheelPair& pair, const WheelPairLoad& load)
    : hub_(&system.body(pair.name + (pair.resilient ? ", hub" : ""),
                        Inertia(pair.mass - (pair.resilient ? double(pair.resilient->tyre_mass) : 0.0)))),
      hub_heave_(system.coordinate(hub_->name() + ", heave")) {
  if (pair.resilient) {
    tyre_ = &system.body(pair.name + ", tyre", Inertia(pair.resilient->tyre_mass));
    tyre_heave_ = system.coordinate(pair.name + ", tyre, heave");
    resilient_.emplace(pair.name + ", resilient wheel", pair.resilient->stiffness, pair.resilient->damping, 0,
                       load.resilient);
  }
  wheel_ = {pair.name, tyre_ ? tyre_ : hub_, pair.x, pair.radius, pair.contacts, load.axle_load};
}

void WheelPairModel::place(const Expr& x) {
  *hub_ = translate(x + wheel_.x, 0, hub_heave_);
  if (tyre_) *tyre_ = translate(x + wheel_.x, 0, *tyre_heave_);
}

void WheelPairModel::apply_resilience() {
  if (tyre_) resilient_->apply(*tyre_, {0, 0, 0}, *hub_, {0, 0, 0});
}

void WheelPairModel::hold() {
  (tyre_ ? *tyre_heave_ : hub_heave_).lock(0);
}

}  // namespace easydyn::vehicles

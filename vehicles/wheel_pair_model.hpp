#pragma once

#include <optional>

#include "vehicles/axle_loads.hpp"
#include "vehicles/vehicle_model.hpp"

namespace easydyn::vehicles {

/// One wheel pair in a multibody system: a solid pair heaves as one body, a resilient one as a hub on a tyre.
/// The primary suspension stands on the hub and belongs to what is above.
class WheelPairModel {
 public:
  WheelPairModel(System& system, const WheelPair& pair, const WheelPairLoad& load);

  Body& hub() const { return *hub_; }
  const VehicleModel::Wheel& wheel() const { return wheel_; }

  /// x = position of the vehicle's origin [m].
  void place(const Expr& x);
  /// Between tyre and hub.
  void apply_resilience();
  /// Holds what runs on the rail at z = 0.
  void hold();

 private:
  Body* hub_;
  Coordinate hub_heave_;
  Body* tyre_ = nullptr;  // null for a solid pair
  std::optional<Coordinate> tyre_heave_;
  std::optional<VerticalSpringDamper> resilient_;
  VehicleModel::Wheel wheel_;
};

}  // namespace easydyn::vehicles

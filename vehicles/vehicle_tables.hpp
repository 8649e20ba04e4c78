#pragma once

#include <vector>

#include "easydyn/visu/report.hpp"
#include "vehicles/axle_loads.hpp"
#include "vehicles/rail_vehicle.hpp"
#include "vehicles/vehicle_modes.hpp"

namespace easydyn::vehicles {

/// Where the mass of a vehicle is [kg].
struct MassBalance {
  int body_count = 0, frame_count = 0, wheel_pair_count = 0;
  double bodies = 0, frames = 0, wheel_pairs = 0;

  double total() const { return bodies + frames + wheel_pairs; }
  double per_axle() const { return total() / wheel_pair_count; }
};

MassBalance compute_mass_balance(const RailVehicle& vehicle);

/// Bodies, frames, wheel pairs, total and per axle, in tonnes.
visu::Table mass_balance_table(const RailVehicle& vehicle);
/// Every axle with its place, its load on the rails and the static force of its primary suspension.
visu::Table axle_load_table(const RailVehicle& vehicle, const AxleLoads& loads);
/// Frequency, damping and what moves most.
visu::Table mode_table(const std::vector<VehicleMode>& modes);

}  // namespace easydyn::vehicles

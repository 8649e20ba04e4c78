#pragma once

#include <string>
#include <vector>

#include "vehicles/rail_vehicle.hpp"

namespace easydyn::vehicles {

/// Couples cars into a train, from front to rear. A car reaches half of its length to either side of its origin; the
/// cars touch there, without a force, and the train's origin is its middle. Names are prefixed by the car: "car 1 body",
/// "car 1 axle 4", "car 2 front bogie".
/// @throws ModelError if there is no car, or on impossible data
RailVehicle couple(std::string name, const std::vector<RailVehicle>& cars);

}  // namespace easydyn::vehicles

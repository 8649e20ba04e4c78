#pragma once

#include <string>
#include <vector>

#include "vehicles/rail_vehicle.hpp"

namespace easydyn::vehicles {

/// A constant force that moves with the train.
struct MovingLoad {
  std::string name;  ///< of the axle
  Sourced x;         ///< from the train's origin, forward [m]
  Sourced load;      ///< downward on the rails, both together [N]
};

/// A train as nothing but its axle loads: neither mass nor spring.
struct MovingLoads {
  std::string name;
  std::vector<MovingLoad> loads;  ///< from front to rear

  double total() const;   ///< [N]
  double length() const;  ///< from the first to the last load [m]
};

/// The static axle loads of a vehicle at their places.
/// @throws ModelError as compute_axle_loads()
MovingLoads moving_loads(const RailVehicle& vehicle);

/// The X2000 test train of Ledsgard: 20 axles over 108.0 m, 2740 kN; the origin is midway between the outer axles (C.
/// Madshus, A.M. Kaynia, J. Sound Vib. 231(3), 2000, doi:10.1006/jsvi.1999.2647).
MovingLoads x2000_ledsgard();

/// Every value with its unit and its provenance, for the report.
std::vector<Parameter> parameters(const MovingLoads& train);

}  // namespace easydyn::vehicles

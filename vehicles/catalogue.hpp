#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "vehicles/rail_vehicle.hpp"

namespace easydyn::vehicles {

/// The Manchester benchmark's vehicle 1: a passenger coach (S. Iwnicki, Manchester benchmarks for rail vehicle
/// simulation, Veh. Syst. Dyn. 30, 1998).
RailVehicle manchester_benchmark_1();

/// A train of 8 cars like the Velaro E (ICE 3 family, S103); cars 4 and 5 are lighter.
RailVehicle ice3_like();

/// A car like the Shinkansen S300's.
RailVehicle shinkansen_s300_like();

/// A power car like the China Star's.
RailVehicle china_star_like();

/// A bundled vehicle and who makes it.
struct CatalogueEntry {
  std::string name;         ///< e.g. "thalys_like"
  std::string description;  ///< a few words
  std::function<RailVehicle()> make;
};

/// All bundled vehicles, in the order in which a list shows them.
const std::vector<CatalogueEntry>& vehicle_catalogue();

/// @throws ModelError if there is none of that name: names the nearest one, and lists all
RailVehicle find_vehicle(std::string_view name);

}  // namespace easydyn::vehicles

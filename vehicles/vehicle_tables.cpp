#include "vehicles/vehicle_tables.hpp"

#include <fmt/format.h>

#include "easydyn/math/units.hpp"

namespace easydyn::vehicles {

using namespace easydyn::units;

MassBalance compute_mass_balance(const RailVehicle& vehicle) {
  MassBalance balance;
  for (const CarBody& body : vehicle.bodies) {
    ++balance.body_count;
    balance.bodies += body.mass;
  }
  for (const RunningGear& gear : vehicle.gears) {
    if (gear.has_frame()) ++balance.frame_count;
    balance.frames += gear.frame_mass;
    for (const WheelPair& pair : gear.wheel_pairs) {
      ++balance.wheel_pair_count;
      balance.wheel_pairs += pair.mass;
    }
  }
  return balance;
}

visu::Table mass_balance_table(const RailVehicle& vehicle) {
  const MassBalance balance = compute_mass_balance(vehicle);
  visu::Table table{{"part", "number", "mass [t]", "share [%]"}, {}, "Mass balance of " + vehicle.label()};
  const auto add = [&](const char* part, const std::string& number, double mass) {
    table.rows.push_back(
        {part, number, fmt::format("{:.3f}", mass / t), fmt::format("{:.1f}", 100 * mass / balance.total())});
  };
  add("bodies", std::to_string(balance.body_count), balance.bodies);
  add("bogie frames", std::to_string(balance.frame_count), balance.frames);
  add("wheel pairs", std::to_string(balance.wheel_pair_count), balance.wheel_pairs);
  add("total", "", balance.total());
  add("per axle", std::to_string(balance.wheel_pair_count), balance.per_axle());
  return table;
}

visu::Table axle_load_table(const RailVehicle& vehicle, const AxleLoads& loads) {
  visu::Table table{{"axle", "gear", "x [m]", "axle load [kN]", "axle load [t]", "primary preload [kN]"},
                    {},
                    "Static axle loads of " + vehicle.label()};
  for (std::size_t g = 0; g < vehicle.gears.size(); ++g)
    for (const WheelPairLoad& pair : loads.wheel_pairs[g])
      table.rows.push_back({pair.name, vehicle.gears[g].name, fmt::format("{:.3f}", pair.x),
                            fmt::format("{:.2f}", pair.axle_load / kN),
                            fmt::format("{:.3f}", pair.axle_load / gravity / t),
                            fmt::format("{:.2f}", pair.primary / kN)});
  return table;
}

visu::Table mode_table(const std::vector<VehicleMode>& modes) {
  visu::Table table{{"frequency [Hz]", "damping ratio", "modes", "moves most", "its share of the energy [%]"},
                    {},
                    "Modes on rigid rails"};
  for (const VehicleMode& mode : modes)
    table.rows.push_back({fmt::format("{:.3f}", mode.frequency), fmt::format("{:.3f}", mode.damping),
                          std::to_string(mode.count), mode.motion,
                          fmt::format("{:.0f}", 100 * mode.energy_share)});
  return table;
}

}  // namespace easydyn::vehicles

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "easydyn/math/units.hpp"
#include "easydyn/require.hpp"
#include "vehicles/rail_vehicle.hpp"
#include "vehicles/vehicle_modes.hpp"

namespace easydyn::vehicles {

using namespace easydyn::units;

std::vector<std::string> unusual_values(const RailVehicle& vehicle, double track_stiffness) {
  require_positive(vehicle.label(), "track stiffness under a wheel pair", track_stiffness, "N/m");
  std::vector<std::string> sentences;
  const auto check = [&](const std::string& object, const std::string& quantity, double value, double low,
                         double high, const std::string& unit) {
    const double slack = 1e-9 * high;         // of unit factors
    const int digits = unit == "Hz" ? 4 : 6;  // a result, or a given value
    if (value < low - slack || value > high + slack)
      sentences.push_back(fmt::format("{}{}: {} = {:.{}g} {} is unusual, mostly {:g} to {:g}",
                                      vehicle.label(), object, quantity, value, digits, unit, low, high));
  };
  for (const CarBody& body : vehicle.bodies)
    check(fmt::format(", body \"{}\"", body.name), "mass", body.mass, 8 * t, 60 * t, "kg");
  for (const RunningGear& gear : vehicle.gears) {
    const std::string object = fmt::format(", running gear \"{}\"", gear.name);
    double secondary = 0;
    for (const SecondarySuspension& s : gear.secondaries) secondary += s.stiffness;
    if (gear.has_frame()) {
      check(object, "frame mass", gear.frame_mass, 1.7 * t, 7 * t, "kg");
      check(object, "secondary stiffness", secondary, 0.2 * MN / m, 6 * MN / m, "N/m");
    }
    for (const WheelPair& pair : gear.wheel_pairs) {
      const std::string pair_name = fmt::format(", wheel pair \"{}\"", pair.name);
      check(pair_name, "mass", pair.mass, 0.35 * t, 2.3 * t, "kg");
      check(pair_name, pair.has_rubber_primary ? "primary stiffness, rubber" : "primary stiffness",
            pair.primary_stiffness, 0.5 * MN / m, (pair.has_rubber_primary ? 44 : 5) * MN / m, "N/m");
      check(pair_name, fmt::format("frequency on a track of {:g} N/m", track_stiffness),
            std::sqrt(track_stiffness / pair.mass) / (2 * pi), 30 * Hz, 90 * Hz, "Hz");
    }
  }
  for (const VehicleMode& mode : compute_vehicle_modes(vehicle)) {
    if (mode.damping >= 1) continue;  // creeps back, has no frequency
    const std::string quantity = "frequency of the mode \"" + mode.motion + "\"";
    if (mode.part == VehicleMode::Part::body) {
      // The stiff secondary suspensions of traction cars pitch a little faster than anything bounces.
      check("", quantity, mode.frequency, 0.4 * Hz, (mode.is_pitch ? 2.5 : 2) * Hz, "Hz");
    } else if (mode.part == VehicleMode::Part::frame && !mode.is_pitch) {
      const auto& pairs = vehicle.gears[static_cast<std::size_t>(mode.index)].wheel_pairs;
      const bool is_rubber = std::ranges::all_of(pairs, &WheelPair::has_rubber_primary);
      check("", quantity, mode.frequency, 4 * Hz, (is_rubber ? 40 : 12) * Hz, "Hz");
    }
  }
  return sentences;
}

}  // namespace easydyn::vehicles

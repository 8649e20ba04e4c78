#include "vehicles/catalogue.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "easydyn/error.hpp"
#include "easydyn/math/units.hpp"
#include "easydyn/nearest_name.hpp"
#include "vehicles/t2000_like.hpp"
#include "vehicles/thalys_like.hpp"
#include "vehicles/train.hpp"
#include "vehicles/two_bogie_car.hpp"

namespace easydyn::vehicles {
namespace {

using namespace easydyn::units;

/// A car of the ICE 3 family: the light ones differ in the body and in the pitch inertia of the bogies.
RailVehicle ice3_car(bool is_light) {
  const std::string goicolea = "F: TTB-2D after Goicolea 2014";
  return two_bogie_car(
      {.name = is_light ? "ice3-like light car" : "ice3-like car",
       .length = {24.775 * m, "M-m: middle cars of the ICE 3"},
       .body_mass = {is_light ? 41200 * kg : 47800 * kg, goicolea},
       .body_pitch_inertia = {is_light ? 1.688e6 * kg * m * m : 1.958e6 * kg * m * m, goicolea},
       .bogie_spacing = {17.375 * m, goicolea},
       .bogie_mass = {3500 * kg, goicolea},
       .bogie_pitch_inertia = {is_light ? 1372 * kg * m * m : 1715 * kg * m * m, goicolea},
       .wheelbase = {2.5 * m, goicolea},
       .axle_mass = {1800 * kg, goicolea},
       .wheel_radius = {0.46 * m, "M-h: 920 mm diameter, new wheels"},
       .primary_stiffness = {2.4 * MN / m, goicolea},
       .primary_damping = {20 * kN * s / m, goicolea},
       .secondary_stiffness = {0.7 * MN / m, goicolea},
       .secondary_damping = {40 * kN * s / m, goicolea}});
}

}  // namespace

RailVehicle manchester_benchmark_1() {
  const std::string iwnicki = "F: TTB-2D after Iwnicki 1998";
  return two_bogie_car(
      {.name = "Manchester benchmark 1",
       .length = {26.0 * m, "D: bogie spacing and usual overhangs; drawing and coupling only"},
       .body_mass = {32000 * kg, iwnicki},
       .body_pitch_inertia = {1.97e6 * kg * m * m, iwnicki},
       .bogie_spacing = {19.0 * m, iwnicki},
       .bogie_mass = {2615 * kg, iwnicki},
       .bogie_pitch_inertia = {1476 * kg * m * m, iwnicki},
       .wheelbase = {2.56 * m, iwnicki},
       .axle_mass = {1813 * kg, iwnicki},
       .wheel_radius = {0.46 * m, "M-h: Manchester benchmark"},
       .primary_stiffness = {2.4 * MN / m, iwnicki},
       .primary_damping = {8 * kN * s / m, iwnicki},
       .secondary_stiffness = {0.86 * MN / m, iwnicki},
       .secondary_damping = {40 * kN * s / m, iwnicki}});
}

RailVehicle ice3_like() {
  const RailVehicle car = ice3_car(false), light = ice3_car(true);
  return couple("ice3-like", {car, car, car, light, light, car, car, car});
}

RailVehicle shinkansen_s300_like() {
  const std::string set = "F: Shinkansen S300 set, TTB-2D";
  return two_bogie_car({.name = "shinkansen-s300-like",
                        .length = {25.0 * m, "M-h: middle cars of the S300"},
                        .body_mass = {41750 * kg, set},
                        .body_pitch_inertia = {2.08e6 * kg * m * m, set},
                        .bogie_spacing = {17.5 * m, set},
                        .bogie_mass = {3040 * kg, set},
                        .bogie_pitch_inertia = {3930 * kg * m * m, set},
                        .wheelbase = {2.5 * m, set},
                        .axle_mass = {1780 * kg, set},
                        .wheel_radius = {0.43 * m, "M-h: 860 mm diameter, new wheels"},
                        .primary_stiffness = {1.18 * MN / m, set},
                        .primary_damping = {39.2 * kN * s / m, set},
                        .secondary_stiffness = {0.53 * MN / m, set},
                        .secondary_damping = {90.2 * kN * s / m, set}});
}

RailVehicle china_star_like() {
  const std::string set = "F: China Star power car set, TTB-2D";
  return two_bogie_car({.name = "china-star-like",
                        .length = {21.7 * m, "M-l: China Star power car; drawing and coupling only"},
                        .body_mass = {59364 * kg, set},
                        .body_pitch_inertia = {1.723e6 * kg * m * m, set},
                        .bogie_spacing = {11.46 * m, set},
                        .bogie_mass = {5631 * kg, set},
                        .bogie_pitch_inertia = {9487 * kg * m * m, set},
                        .wheelbase = {3.0 * m, set},
                        .axle_mass = {1843.5 * kg, set},
                        .wheel_radius = {0.525 * m, "M-l: 1050 mm diameter, new wheels"},
                        .primary_stiffness = {4.80 * MN / m, set},
                        .primary_damping = {60 * kN * s / m, set},
                        .secondary_stiffness = {1.772 * MN / m, set},
                        .secondary_damping = {90 * kN * s / m, set}});
}

const std::vector<CatalogueEntry>& vehicle_catalogue() {
  static const std::vector<CatalogueEntry> entries = {
      {"t2000_like", "low-floor tram of three articulated bodies", t2000_like},
      {"thalys_like", "articulated high-speed train of 10 cars", thalys_like},
      {"manchester_benchmark_1", "passenger coach of the Manchester benchmark", manchester_benchmark_1},
      {"ice3_like", "high-speed train of 8 cars with distributed drive", ice3_like},
      {"shinkansen_s300_like", "car of a high-speed train", shinkansen_s300_like},
      {"china_star_like", "power car of a high-speed train", china_star_like}};
  return entries;
}

RailVehicle find_vehicle(std::string_view name) {
  const std::vector<CatalogueEntry>& entries = vehicle_catalogue();
  const auto found = std::ranges::find(entries, name, &CatalogueEntry::name);
  if (found != entries.end()) return found->make();
  const auto nearest = std::ranges::min_element(
      entries, {}, [&](const CatalogueEntry& entry) { return edit_distance(name, entry.name); });
  std::string names;
  for (const CatalogueEntry& entry : entries) names += (names.empty() ? "" : ", ") + entry.name;
  throw ModelError(
      fmt::format("vehicle \"{}\" is unknown, the nearest is \"{}\" of {}", name, nearest->name, names));
}

}  // namespace easydyn::vehicles

#include "vehicles/t2000_like.hpp"

#include "easydyn/math/units.hpp"

namespace easydyn::vehicles {
namespace {

using namespace easydyn::units;

const std::string geometry = "D: geometry inside 22.8 m";
const std::string estimate = "D: mass balance of 36.5 t";
const std::string slender = "D: m L^2 / 12";
const std::string recalled = "M-l: Brussels T2000";
const std::string wikipedia = "F: Wikipedia, en/de/fr";

WheelPair driven_pair(const std::string& name, double x) {
  return {.name = name,
          .x = {x, geometry},
          .mass = {1.1 * t, estimate + ", with hub motors"},
          .radius = {0.320 * m, wikipedia},
          .primary_stiffness = {44 * MN / m, recalled},
          .primary_damping = {18 * kN * s / m, recalled},
          .resilient = ResilientWheel{.tyre_mass = {0.20 * t, estimate},
                                      .stiffness = {145 * MN / m, recalled},
                                      .damping = {3 * kN * s / m, recalled}},
          .has_rubber_primary = true};
}

WheelPair trailing_pair(const std::string& name, double x) {
  WheelPair pair = driven_pair(name, x);
  pair.mass = {0.35 * t, estimate};
  pair.radius = {0.1875 * m, wikipedia};
  pair.resilient->tyre_mass = {0.08 * t, estimate};
  return pair;
}

RunningGear gear(const std::string& name, const std::string& body, double pivot, double middle) {
  const Sourced stiffness(0.96 * MN / m / 2, recalled + ", half of the gear's"),
      damping(56 * kN * s / m / 2, recalled + ", half of the gear's");
  return {.name = name,
          .frame_mass = {1.8 * t, estimate},
          .frame_pitch_inertia = {8e2 * kg * m * m, "D"},
          .x = {middle, geometry + ", middle of the gear"},
          .pivot_x = {pivot, geometry},
          .secondaries = {{body, {pivot + 0.5 * m, geometry}, stiffness, damping},
                          {body, {pivot - 0.5 * m, geometry}, stiffness, damping}},
          .wheel_pairs = {}};
}

}  // namespace

RailVehicle t2000_like() {
  RailVehicle tram;
  tram.name = "t2000-like";
  tram.length = {22.80 * m, wikipedia};
  // bodies and the hinges between them
  const Sourced end_mass(9.0 * t, estimate), end_inertia(6.1e4 * kg * m * m, slender),
      end_length(9.0 * m, geometry);
  tram.bodies = {{"front body", end_mass, end_inertia, {6.9 * m, geometry}, end_length},
                 {"centre body",
                  {8.0 * t, estimate},
                  {1.5e4 * kg * m * m, slender},
                  {0 * m, geometry},
                  {4.8 * m, geometry}},
                 {"rear body", end_mass, end_inertia, {-6.9 * m, geometry}, end_length}};
  tram.hinges = {{"front hinge", "front body", "centre body", {2.4 * m, geometry}},
                 {"rear hinge", "centre body", "rear body", {-2.4 * m, geometry}}};
  // running gears: the driven pairs of the end gears stand outside
  RunningGear front = gear("front gear", "front body", 8.2 * m, 7.86 * m);
  front.wheel_pairs = {driven_pair("front gear, driven", 8.71 * m),
                       trailing_pair("front gear, trailing", 7.01 * m)};
  RunningGear centre = gear("centre gear", "centre body", 0 * m, 0 * m);
  centre.wheel_pairs = {driven_pair("centre gear, front", 0.85 * m),
                        driven_pair("centre gear, rear", -0.85 * m)};
  RunningGear rear = gear("rear gear", "rear body", -8.2 * m, -7.86 * m);
  rear.wheel_pairs = {trailing_pair("rear gear, trailing", -7.01 * m),
                      driven_pair("rear gear, driven", -8.71 * m)};
  tram.gears = {front, centre, rear};
  return tram;
}

}  // namespace easydyn::vehicles

#include "vehicles/two_bogie_car.hpp"

#include <fmt/format.h>

#include "easydyn/require.hpp"

namespace easydyn::vehicles {

RailVehicle two_bogie_car(const TwoBogieCar& data) {
  RailVehicle car;
  car.name = data.name;
  car.length = data.length;
  require_positive(car.label(), "bogie spacing", data.bogie_spacing, "m");
  require_positive(car.label(), "wheelbase", data.wheelbase, "m");
  require(data.wheelbase < data.bogie_spacing, car.label(), "wheelbase", data.wheelbase, "m",
          fmt::format("< {:g}, the bogie spacing", data.bogie_spacing.value));
  car.bodies = {{.name = "body",
                 .mass = data.body_mass,
                 .pitch_inertia = data.body_pitch_inertia,
                 .x = {0, "D: middle of the car"},
                 .length = data.length}};
  int axle = 0;
  for (const int side : {1, -1}) {
    const Sourced x(side * data.bogie_spacing / 2, data.bogie_spacing.source);
    RunningGear bogie{.name = side > 0 ? "front bogie" : "rear bogie",
                      .frame_mass = data.bogie_mass,
                      .frame_pitch_inertia = data.bogie_pitch_inertia,
                      .x = x,
                      .pivot_x = x,
                      .secondaries = {{.body = "body",
                                       .x = x,
                                       .stiffness = data.secondary_stiffness,
                                       .damping = data.secondary_damping}},
                      .wheel_pairs = {}};
    for (const int end : {1, -1})
      bogie.wheel_pairs.push_back({.name = fmt::format("axle {}", ++axle),
                                   .x = {x + end * data.wheelbase / 2, data.wheelbase.source},
                                   .mass = data.axle_mass,
                                   .radius = data.wheel_radius,
                                   .primary_stiffness = data.primary_stiffness,
                                   .primary_damping = data.primary_damping,
                                   .resilient = {},
                                   .has_rubber_primary = data.has_rubber_primary});
    car.gears.push_back(std::move(bogie));
  }
  validate(car);
  return car;
}

}  // namespace easydyn::vehicles

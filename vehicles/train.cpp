#include "vehicles/train.hpp"

#include <fmt/format.h>

#include "easydyn/error.hpp"

namespace easydyn::vehicles {
namespace {

const std::string along_train = "C: sum of the lengths of the cars";

/// The car with its names behind `prefix` and its origin at x.
RailVehicle placed(RailVehicle car, const std::string& prefix, double x) {
  const auto rename = [&](std::string& name) { name = prefix + name; };
  const auto move = [&](Sourced& place) { place.value += x; };  // its source stays: the car's data sheet
  for (CarBody& body : car.bodies) {
    rename(body.name);
    move(body.x);
  }
  for (Hinge& hinge : car.hinges) {
    for (std::string* const words : {&hinge.name, &hinge.front_body, &hinge.rear_body}) rename(*words);
    move(hinge.x);
  }
  for (RunningGear& gear : car.gears) {
    rename(gear.name);
    if (!gear.has_frame()) rename(gear.body);
    move(gear.x);
    move(gear.pivot_x);
    for (SecondarySuspension& secondary : gear.secondaries) {
      rename(secondary.body);
      move(secondary.x);
    }
    for (WheelPair& pair : gear.wheel_pairs) {
      rename(pair.name);
      move(pair.x);
    }
  }
  return car;
}

template <class Parts>
void append(Parts& parts, const Parts& more) {
  parts.insert(parts.end(), more.begin(), more.end());
}

}  // namespace

RailVehicle couple(std::string name, const std::vector<RailVehicle>& cars) {
  RailVehicle train;
  train.name = std::move(name);
  if (cars.empty()) throw ModelError(train.label() + ": cars = 0, must be >= 1");
  double length = 0;
  for (const RailVehicle& car : cars) {
    validate(car);
    length += car.length;
  }
  train.length = {length, along_train};
  double front = length / 2;
  int number = 0;
  for (const RailVehicle& car : cars) {
    const RailVehicle part = placed(car, fmt::format("car {} ", ++number), front - car.length / 2);
    append(train.bodies, part.bodies);
    append(train.hinges, part.hinges);
    append(train.gears, part.gears);
    front -= car.length;
  }
  validate(train);
  return train;
}

}  // namespace easydyn::vehicles

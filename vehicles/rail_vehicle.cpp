#include "vehicles/rail_vehicle.hpp"

#include <algorithm>
#include <set>

#include "easydyn/require.hpp"

namespace easydyn::vehicles {
namespace {

std::string part(const RailVehicle& vehicle, std::string_view kind, std::string_view name) {
  return fmt::format("{}, {} \"{}\"", vehicle.label(), kind, name);
}

void validate(const WheelPair& pair, const std::string& object) {
  require_finite(object, "x", pair.x, "m");
  require_positive(object, "mass", pair.mass, "kg");
  require_positive(object, "wheel radius", pair.radius, "m");
  require_positive(object, "primary stiffness", pair.primary_stiffness, "N/m");
  require_not_negative(object, "primary damping", pair.primary_damping, "N s/m");
  require(pair.contacts >= 1, object, "contacts", pair.contacts, "", ">= 1");
  if (!pair.resilient) return;
  const ResilientWheel& wheel = *pair.resilient;
  require(wheel.tyre_mass > 0 && wheel.tyre_mass < pair.mass, object, "tyre mass", wheel.tyre_mass, "kg",
          fmt::format("> 0 and < {:g}, the mass of the pair", pair.mass.value));
  require_positive(object, "resilient wheel stiffness", wheel.stiffness, "N/m");
  require_not_negative(object, "resilient wheel damping", wheel.damping, "N s/m");
}

void validate(const RunningGear& gear, const RailVehicle& vehicle) {
  const std::string object = part(vehicle, "running gear", gear.name);
  const auto count = static_cast<double>(gear.secondaries.size());
  if (gear.has_frame()) {
    require_positive(object, "frame mass", gear.frame_mass, "kg");
    require_positive(object, "frame pitch inertia", gear.frame_pitch_inertia, "kg m2");
    require(count > 0, object, "secondary suspensions", count, "", ">= 1");
  } else {
    const std::string without =
        fmt::format("0: its wheel pairs carry body \"{}\" without a frame", gear.body);
    vehicle.body_index(gear.body);
    require(gear.frame_mass == 0, object, "frame mass", gear.frame_mass, "kg", without);
    require(gear.frame_pitch_inertia == 0, object, "frame pitch inertia", gear.frame_pitch_inertia, "kg m2",
            without);
    require(count == 0, object, "secondary suspensions", count, "", without);
  }
  require_finite(object, "x", gear.x, "m");
  require_finite(object, "pivot x", gear.pivot_x, "m");
  require(!gear.wheel_pairs.empty(), object, "wheel pairs", 0, "", ">= 1");
  for (const SecondarySuspension& s : gear.secondaries) {
    vehicle.body_index(s.body);
    require_finite(object, "x of the secondary suspension", s.x, "m");
    require_positive(object, "secondary stiffness", s.stiffness, "N/m");
    require_not_negative(object, "secondary damping", s.damping, "N s/m");
  }
  for (const WheelPair& pair : gear.wheel_pairs) validate(pair, part(vehicle, "wheel pair", pair.name));
}

}  // namespace

int RailVehicle::body_index(std::string_view body) const {
  const auto found = std::ranges::find(bodies, body, &CarBody::name);
  if (found != bodies.end()) return static_cast<int>(found - bodies.begin());
  std::string names;
  for (const CarBody& b : bodies) names += (names.empty() ? "\"" : ", \"") + b.name + "\"";
  throw ModelError(fmt::format("{}: body \"{}\" is unknown, there are {}", label(), body, names));
}

double RailVehicle::mass() const {
  double sum = 0;
  for (const CarBody& body : bodies) sum += body.mass;
  for (const RunningGear& gear : gears) {
    sum += gear.frame_mass;
    for (const WheelPair& pair : gear.wheel_pairs) sum += pair.mass;
  }
  return sum;
}

double RailVehicle::weight() const {
  return gravity * mass();
}

int RailVehicle::wheel_pair_count() const {
  size_t count = 0;
  for (const RunningGear& gear : gears) count += gear.wheel_pairs.size();
  return static_cast<int>(count);
}

void validate(const RailVehicle& vehicle) {
  require(!vehicle.bodies.empty(), vehicle.label(), "bodies", 0, "", ">= 1");
  require(!vehicle.gears.empty(), vehicle.label(), "running gears", 0, "", ">= 1");
  require_positive(vehicle.label(), "length", vehicle.length, "m");
  std::set<std::string> names;
  const auto require_new = [&](const std::string& name) {
    if (!names.insert(name).second)
      throw ModelError(fmt::format("{}: the name \"{}\" is used twice", vehicle.label(), name));
  };
  for (const CarBody& body : vehicle.bodies) {
    const std::string object = part(vehicle, "body", body.name);
    require_new(body.name);
    require_positive(object, "mass", body.mass, "kg");
    require_positive(object, "pitch inertia", body.pitch_inertia, "kg m2");
    require_finite(object, "x", body.x, "m");
    require_positive(object, "length", body.length, "m");
    require_finite(object, "offset of the middle", body.middle_offset, "m");
  }
  std::set<std::string> rear_bodies;
  for (const Hinge& hinge : vehicle.hinges) {
    require_new(hinge.name);
    const std::string object = part(vehicle, "hinge", hinge.name);
    require_finite(object, "x", hinge.x, "m");
    if (hinge.front_body == hinge.rear_body)
      throw ModelError(
          fmt::format("{}: joins body \"{}\" to itself, must be two bodies", object, hinge.front_body));
    if (vehicle.body_index(hinge.front_body) >= vehicle.body_index(hinge.rear_body))
      throw ModelError(
          fmt::format("{}: front body \"{}\" must stand before rear body \"{}\" in the list of bodies",
                      object, hinge.front_body, hinge.rear_body));
    if (!rear_bodies.insert(hinge.rear_body).second)
      throw ModelError(
          fmt::format("{}: body \"{}\" is the rear body of another hinge already, must be of one", object,
                      hinge.rear_body));
  }
  for (const RunningGear& gear : vehicle.gears) {
    require_new(gear.name);
    for (const WheelPair& pair : gear.wheel_pairs) require_new(pair.name);
    validate(gear, vehicle);
  }
}

std::vector<Parameter> parameters(const RailVehicle& vehicle) {
  std::vector<Parameter> table;
  const std::string group = vehicle.label();
  const auto add = [&](const std::string& object, const char* quantity, const Sourced& x, const char* unit) {
    table.push_back({group, object.empty() ? quantity : object + ", " + quantity, x.value, unit, x.source});
  };
  add("", "length", vehicle.length, "m");
  for (const CarBody& body : vehicle.bodies) {
    add(body.name, "mass", body.mass, "kg");
    add(body.name, "pitch inertia", body.pitch_inertia, "kg m2");
    add(body.name, "x of the centre of mass", body.x, "m");
    add(body.name, "length", body.length, "m");
    if (body.middle_offset != 0)
      add(body.name, "middle ahead of the centre of mass", body.middle_offset, "m");
  }
  for (const Hinge& hinge : vehicle.hinges) add(hinge.name, "x", hinge.x, "m");
  for (const RunningGear& gear : vehicle.gears) {
    if (gear.has_frame()) {
      add(gear.name, "frame mass", gear.frame_mass, "kg");
      add(gear.name, "frame pitch inertia", gear.frame_pitch_inertia, "kg m2");
      add(gear.name, "x of the frame", gear.x, "m");
    }
    add(gear.name, "x of the pivot", gear.pivot_x, "m");
    for (const SecondarySuspension& s : gear.secondaries) {
      const std::string object = gear.name + " to " + s.body;
      add(object, "x of the secondary suspension", s.x, "m");
      add(object, "secondary stiffness", s.stiffness, "N/m");
      add(object, "secondary damping", s.damping, "N s/m");
    }
    for (const WheelPair& pair : gear.wheel_pairs) {
      add(pair.name, "x", pair.x, "m");
      add(pair.name, "mass", pair.mass, "kg");
      add(pair.name, "wheel radius", pair.radius, "m");
      add(pair.name, "primary stiffness", pair.primary_stiffness, "N/m");
      add(pair.name, "primary damping", pair.primary_damping, "N s/m");
      if (!pair.resilient) continue;
      add(pair.name, "tyre mass", pair.resilient->tyre_mass, "kg");
      add(pair.name, "resilient wheel stiffness", pair.resilient->stiffness, "N/m");
      add(pair.name, "resilient wheel damping", pair.resilient->damping, "N s/m");
    }
  }
  return table;
}

}  // namespace easydyn::vehicles

#include "vehicles/planar_vehicle.hpp"

namespace easydyn::vehicles {

PlanarVehicle::PlanarVehicle(System& system, RailVehicle data)
    : data_(std::move(data)), loads_(compute_axle_loads(data_)) {
  // Car bodies, from front to rear; a hinge replaces the heave of the body behind it.
  for (const CarBody& car : data_.bodies) {
    car_bodies_.push_back(&system.body(car.name, Inertia(car.mass, car.pitch_inertia)));
    const Hinge* hinge = nullptr;
    for (const Hinge& h : data_.hinges)
      if (h.rear_body == car.name) hinge = &h;
    if (hinge)
      cars_.push_back({std::nullopt, system.coordinate(car.name + ", pitch at the hinge"), hinge->x});
    else
      cars_.push_back({system.coordinate(car.name + ", heave"), system.coordinate(car.name + ", pitch"), 0});
  }

  // Running gears: frame, then its wheel pairs, each with its suspensions.
  for (std::size_t g = 0; g < data_.gears.size(); ++g) {
    const RunningGear& gear = data_.gears[g];
    GearMotion motion;
    if (gear.has_frame()) {
      frames_.push_back(&system.body(gear.name, Inertia(gear.frame_mass, gear.frame_pitch_inertia)));
      motion.frame = {frames_.back(), system.coordinate(gear.name + ", heave"),
                      system.coordinate(gear.name + ", pitch")};
    }
    for (std::size_t s = 0; s < gear.secondaries.size(); ++s) {
      const SecondarySuspension& suspension = gear.secondaries[s];
      motion.secondaries.emplace_back(gear.name + ", secondary suspension", suspension.stiffness,
                                      suspension.damping, 0, loads_.secondary[g][s]);
    }
    for (std::size_t w = 0; w < gear.wheel_pairs.size(); ++w) {
      const WheelPair& pair = gear.wheel_pairs[w];
      const WheelPairLoad& load = loads_.wheel_pairs[g][w];
      motion.wheel_pairs.push_back({WheelPairModel(system, pair, load),
                                    {pair.name + ", primary suspension", pair.primary_stiffness,
                                     pair.primary_damping, 0, load.primary},
                                    pair.x});
      wheels_.push_back(motion.wheel_pairs.back().pair.wheel());
    }
    gears_.push_back(std::move(motion));
  }
}

void PlanarVehicle::place(const Expr& x) {
  std::vector<Frame> frame_of(cars_.size());
  for (std::size_t c = 0; c < cars_.size(); ++c) {
    const CarBody& car = data_.bodies[c];
    if (cars_[c].heave) {
      frame_of[c] = translate(x + double(car.x), 0, *cars_[c].heave) * rotate_y(cars_[c].pitch);
    } else {
      for (const Hinge& hinge : data_.hinges) {
        if (hinge.rear_body != car.name) continue;
        const auto front = static_cast<std::size_t>(data_.body_index(hinge.front_body));
        frame_of[c] = frame_of[front] * translate(hinge.x - data_.bodies[front].x, 0, 0) *
                      rotate_y(cars_[c].pitch) * translate(car.x - hinge.x, 0, 0);
      }
    }
    *car_bodies_[c] = frame_of[c];
  }
  for (std::size_t g = 0; g < gears_.size(); ++g) {
    GearMotion& gear = gears_[g];
    if (gear.frame)
      *gear.frame->body =
          translate(x + double(data_.gears[g].x), 0, gear.frame->heave) * rotate_y(gear.frame->pitch);
    for (WheelPairMotion& wheel : gear.wheel_pairs) wheel.pair.place(x);
  }
}

void PlanarVehicle::apply_suspensions() {
  for (std::size_t g = 0; g < gears_.size(); ++g) {
    GearMotion& gear = gears_[g];
    const auto carried = static_cast<std::size_t>(gear.frame ? 0 : data_.body_index(data_.gears[g].body));
    const Body& above = gear.frame ? *gear.frame->body : *car_bodies_[carried];
    const double above_x = gear.frame ? data_.gears[g].x : data_.bodies[carried].x;
    for (std::size_t s = 0; s < gear.secondaries.size(); ++s) {
      const SecondarySuspension& suspension = data_.gears[g].secondaries[s];
      const auto body = static_cast<std::size_t>(data_.body_index(suspension.body));
      gear.secondaries[s].apply(above, {suspension.x - above_x, 0, 0}, *car_bodies_[body],
                                {suspension.x - data_.bodies[body].x, 0, 0});
    }
    for (WheelPairMotion& wheel : gear.wheel_pairs) {
      wheel.primary.apply(wheel.pair.hub(), {0, 0, 0}, above, {wheel.x - above_x, 0, 0});
      wheel.pair.apply_resilience();
    }
  }
}

void PlanarVehicle::hold_wheels() {
  for (GearMotion& gear : gears_)
    for (WheelPairMotion& wheel : gear.wheel_pairs) wheel.pair.hold();
}

}  // namespace easydyn::vehicles

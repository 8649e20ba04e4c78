// My vehicle: a car from its data sheet, checked, drawn and run over a rail joint. Copy it for a vehicle of your own.
//
//   [================ body ================]
//        >                          >          secondary suspension, per bogie
//     [=====]                    [=====]       bogies
//      >   >                      >   >        primary suspension, per axle
//     (4) (3)                    (2) (1)       --> v
//   =====================|==================   rail, step of 0.2 mm at x = 0
//
// Shows: a data sheet with its sources; warnings; axle loads; modes; a drawing; a passage over a bundled track.
// `examples/outside` builds this program outside the repository.
// Run: ./run my_vehicle
// Prints: 0 warnings
// Prints: axle 1  x =  10.75 m: 107.91 kN
// Prints: axle 4  x = -10.75 m: 107.91 kN
// Prints: 1.068 Hz, damping 0.150: body, bounce
// Prints: 1.357 Hz, damping 0.189: body, pitch
// Prints: axle 1: contact force from 34.1 to 359.3 kN
// Prints: axle 4: contact force from 32.5 to 359.1 kN
// Prints: largest rail deflection 1.784 mm
// Prints: wrote my_vehicle.html and my_vehicle.svg

#include <fmt/format.h>

#include <iostream>

#include "easydyn/easydyn.hpp"
#include "easydyn/visu/report.hpp"
#include "track/passage.hpp"
#include "track/track_scene.hpp"
#include "track/wheel_rail_contact.hpp"
#include "vehicles/planar_vehicle.hpp"
#include "vehicles/two_bogie_car.hpp"
#include "vehicles/vehicle_drawing.hpp"
#include "vehicles/vehicle_modes.hpp"
#include "vehicles/vehicle_scene.hpp"

using namespace easydyn;
using namespace easydyn::units;

// 1. Data sheet: values with units, and where each comes from. Other layouts (articulated bodies, Jacobs bogies,
// resilient wheels) are written part by part: vehicles/rail_vehicle.hpp, vehicles/t2000_like.cpp.
vehicles::RailVehicle my_vehicle() {
  const std::string source = "D: a coach made up for this example";
  return vehicles::two_bogie_car({.name = "my vehicle",
                                  .length = {26.4 * m, source},
                                  .body_mass = {32 * t, source},
                                  .body_pitch_inertia = {1.8e6 * kg * m * m, source},
                                  .bogie_spacing = {19 * m, source},
                                  .bogie_mass = {2.6 * t, source},
                                  .bogie_pitch_inertia = {1500 * kg * m * m, source},
                                  .wheelbase = {2.5 * m, source},
                                  .axle_mass = {1.7 * t, source},
                                  .wheel_radius = {0.46 * m, source},
                                  .primary_stiffness = {2.2 * MN / m, source},  // per axle
                                  .primary_damping = {12 * kN * s / m, source},
                                  .secondary_stiffness = {0.85 * MN / m, source},  // per bogie
                                  .secondary_damping = {45 * kN * s / m, source}});
}

constexpr double speed = 100 * km / h, step_height = 0.2 * mm, start = -20 * m, stop = 20 * m;

// 2. The vehicle on the track: a contact under every axle. A simplified vehicle can stand for the whole one
// (vehicles/simplified_vehicle.hpp).
class CarOnTrack : public System {
 public:
  vehicles::PlanarVehicle car{*this, my_vehicle()};
  track::FlexibleTrack rails{*this, track::TrackModel(track::thalys_like_track(), 160, -79.7 * 0.6)};
  std::vector<track::WheelRailContact> contacts;

  CarOnTrack() : System("my vehicle on a track") {
    const auto joint = std::make_shared<track::StepProfile>(0, step_height);
    for (const auto& w : car.wheels())
      contacts.emplace_back(w.name, track::HertzContact(1e11, w.contacts), w.radius, w.static_load, joint);
  }
  void positions() override { car.place(start + speed * time()); }
  void forces() override {
    gravity(vehicles::gravity);
    car.apply_suspensions();
    for (std::size_t i = 0; i < contacts.size(); ++i) contacts[i].apply(*car.wheels()[i].body, rails);
  }
};

// Vehicle and track at 500 times of the passage.
visu::Scene draw(const CarOnTrack& system, const track::Passage& passage) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < passage.time.size(); i += 1 + passage.time.size() / 500) rows.push_back(i);
  const Eigen::VectorXd time = passage.time(rows);
  visu::Scene scene;
  scene.name = "My vehicle";
  scene.exaggeration = 100;
  vehicles::add_vehicle(scene, system.car.data(),
                        {time, start + speed * time.array(), passage.body_names,
                         passage.body_height(rows, Eigen::all), passage.body_pitch(rows, Eigen::all)},
                        {.floor = 1.1, .width = 2.8});
  track::add_track(scene, passage, system.rails.model().data(), rows);
  scene.camera = {.target = {0, 0, 1}, .width = 32, .azimuth = -75, .elevation = 10, .follow = "body"};
  return scene;
}

int main() try {
  // 3. What the data say: warnings, axle loads, modes, drawing.
  const vehicles::RailVehicle data = my_vehicle();
  const std::vector<std::string> warnings = vehicles::unusual_values(data);
  for (const std::string& warning : warnings) fmt::print("warning: {}\n", warning);
  fmt::print("{} warnings\n", warnings.size());
  CarOnTrack system;
  for (const auto& w : system.car.wheels())
    fmt::print("{}  x = {:6.2f} m: {:.2f} kN\n", w.name, w.x, w.static_load / kN);
  for (const vehicles::VehicleMode& mode : vehicles::compute_vehicle_modes(data))
    fmt::print("{:6.3f} Hz, damping {:.3f}: {}\n", mode.frequency, mode.damping, mode.motion);
  vehicles::write_vehicle_drawing("my_vehicle.svg", data);

  // 4. Passage.
  std::vector<const track::TrackContact*> contacts;
  for (const auto& contact : system.contacts) contacts.push_back(&contact);
  const track::Passage passage = track::compute_passage(
      system, system.rails, contacts,
      {.duration = (stop - start) / speed, .first_sleeper_x = -40, .last_sleeper_x = 40});
  for (const std::string& warning : passage.warnings) fmt::print("warning: {}\n", warning);
  for (Eigen::Index i = 0; i < passage.largest_contact_force.size(); ++i)
    fmt::print("{}: contact force from {:.1f} to {:.1f} kN\n", contacts[static_cast<std::size_t>(i)]->name(),
               passage.smallest_contact_force[i] / kN, passage.largest_contact_force[i] / kN);
  fmt::print("largest rail deflection {:.3f} mm\n", passage.rail_deflection.maxCoeff() / mm);
  fmt::print("largest acceleration of the body {:.3f} m/s2\n",
             passage.body_acceleration.col(0).cwiseAbs().maxCoeff());

  // 5. Report.
  visu::Chart force{"Contact forces", {"time", "s"}, {"force", "kN"}, {}};
  for (std::size_t i = 0; i < contacts.size(); ++i)
    force.series.push_back(
        {contacts[i]->name(), passage.time, passage.contact_force.col(static_cast<Eigen::Index>(i)) / kN});
  const visu::Chart acceleration{"Body",
                                 {"time", "s"},
                                 {"acceleration", "m/s²"},
                                 {{"body", passage.time, passage.body_acceleration.col(0)}}};
  visu::write_animation_page("my_vehicle.html", "My vehicle", draw(system, passage), {force, acceleration},
                             "A car over a rail joint at 100 km/h.");
  fmt::print("wrote my_vehicle.html and my_vehicle.svg\n");
} catch (const std::exception& e) {
  std::cerr << "my_vehicle: " << e.what() << "\n";
  return 1;
}

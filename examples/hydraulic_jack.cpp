// Hydraulic jack: a tipping bed is lifted by oil.
//
//            _____------  bed, angle a
//      o----'   /
//    hinge     / jack: p_1, p_2, valve opening y
//     ________o________
//
// Shows: pressures as first-order states, a jack between two bodies, a controller that opens the valve; oil is a spring of
// its own. Statics by hand: F times its lever carries the weight of the bed.
// Run: ./run hydraulic_jack
// Prints: angle 34.99 deg of 35.00 deg after 20 s
// Prints: jack force 69.13 kN, by its lever 69.13 kN; bottom pressure 118.4 bar
// Prints: on its oil alone 4.56 Hz, by hand 4.56 Hz
// Prints: energy error 9e-07 of the energy supplied
// Next: bogie.cpp (a vehicle on its track)
// Reference: H. E. Merritt, Hydraulic Control Systems, Wiley, 1967.

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iostream>

#include "easydyn/easydyn.hpp"
#include "easydyn/visu/report.hpp"

using namespace easydyn;
using namespace easydyn::units;

// 1. Data: a bed of 5 t, its jack below it [m].
constexpr double mass = 5 * t, bed_length = 5, centre = 2.2, goal = 35 * deg;
const Eigen::Vector3d foot(1.0, 0, -1.0), eye(1.6, 0, -0.1);
const HydraulicJack::Data data{.area_1 = 7.9e-3,
                               .area_2 = 5.5e-3,
                               .shortest = 0.9,
                               .longest = 2.2,
                               .dead_volume = 0.5e-3,
                               .bulk_modulus = 1.0e9,
                               .leakage = 1e-13,
                               .supply_pressure = 200e5,
                               .rated_flow = 1e-3,
                               .pressure_1 = 105e5,
                               .pressure_2 = 9e5};

class Tipper : public System {
 public:
  Tipper() : System("Hydraulic jack") {}

  Coordinate a = coordinate("angle");
  Body& bed = body("bed", Inertia::box(mass, bed_length, 2.2, 0.5));
  HydraulicJack jack{*this, "jack", data};
  TorsionalSpringDamper hinge_friction{"hinge", 0, 5e3};
  double gain = 4, opening = 0;

  // 2. The bed turns upward about the hinge at the origin.
  void positions() override {
    hinge = rotate_y(-a);
    bed = hinge * translate(centre, 0, 0.25);
  }
  // 3. The valve opens with the error, at most fully.
  void forces() override {
    gravity();
    opening = std::clamp(gain * (goal - a.value()), -1., 1.);
    jack.apply({}, foot, hinge, eye, opening);
    hinge_friction.apply({}, bed, {0, 1, 0}, 0);
  }

 private:
  Frame hinge;
};

double compute_lever(double angle) {  // of the jack's line about the hinge [m]
  const Eigen::Vector3d end = Eigen::AngleAxisd(-angle, Eigen::Vector3d::UnitY()) * eye;
  return (end - foot).normalized().cross(end).y();
}

int main() try {
  // 4. Integration: stiff by the oil, so BDF.
  Tipper tipper;
  Cvode integrator(tipper, {.relative_tolerance = 1e-7, .absolute_tolerance = 1e-7, .max_step = 5 * ms});
  Recorder recorder(tipper, 20 * ms);
  recorder.watch("p_1", [](const State& s) { return s.x[0] / 1e5; });
  recorder.watch("p_2", [](const State& s) { return s.x[1] / 1e5; });
  recorder(integrator.state());
  integrator.advance(20, std::ref(recorder));
  const State end = integrator.state();
  fmt::print("angle {:.2f} deg of {:.2f} deg after 20 s\n", end.q[0] / deg, goal / deg);

  // 5. Statics by hand: force times lever of the jack, weight times lever of the bed.
  const double a = end.q[0], r = compute_lever(a), F = tipper.jack.force(), weight = mass * 9.81;
  fmt::print("jack force {:.2f} kN, by its lever {:.2f} kN; bottom pressure {:.1f} bar\n", F / kN,
             weight * (centre * std::cos(a) - 0.25 * std::sin(a)) / r / kN, end.x[0] / 1e5);

  // 6. With the valve shut the bed swings on the oil, k = beta (A_1^2 / V_1 + A_2^2 / V_2); the levers change, too.
  tipper.gain = 0;
  const double V_1 = data.dead_volume + data.area_1 * (tipper.jack.length() - data.shortest),
               V_2 = data.dead_volume + data.area_2 * (data.longest - tipper.jack.length());
  const double k = data.bulk_modulus * (data.area_1 * data.area_1 / V_1 + data.area_2 * data.area_2 / V_2),
               levers = F * (compute_lever(a + 1e-4) - compute_lever(a - 1e-4)) / 2e-4 +
                        weight * (centre * std::sin(a) + 0.25 * std::cos(a)),
               J = tipper.bed.inertia().J(1, 1) + mass * (centre * centre + 0.25 * 0.25);
  fmt::print("on its oil alone {:.2f} Hz, by hand {:.2f} Hz\n",
             compute_modes(linearize_state_space(tipper, end)).back().frequency,
             std::sqrt((k * r * r - levers) / J) / (2 * pi));
  const Eigen::VectorXd energy = recorder.total_energy();
  fmt::print("energy error {:.0e} of the energy supplied\n",
             (energy.array() - energy[0]).abs().maxCoeff() / recorder.supplied_energy());

  // 7. Report.
  const Eigen::Vector3d eye_on_bed = eye - Eigen::Vector3d(centre, 0, 0.25);
  visu::Scene scene = recorder.scene();
  scene.items = {{"bed", "bed", visu::Shape::box, {bed_length, 2.2, 0.5}, "#4477aa"},
                 {"lug",
                  "bed",
                  visu::Shape::box,
                  {0.2, 0.3, 0.14},
                  "#4477aa",
                  {eye_on_bed + Eigen::Vector3d(0, 0, 0.04)}},
                 {"frame", "", visu::Shape::box, {5.5, 0.8, 0.2}, "#999999", {{1.8, 0, -1.1}}},
                 {"hinge", "", visu::Shape::box, {0.3, 0.8, 1.1}, "#999999", {{-0.15, 0, -0.5}}}};
  scene.links = {{"cylinder", {"", foot}, {"bed", eye_on_bed}, visu::LinkShape::line, 0.09, "#bb5566"}};
  scene.ground = -1.2;
  scene.camera = {.target = {2, 0, 0.9}, .width = 12, .azimuth = -75, .elevation = 12};
  visu::write_animation_page(
      "hydraulic_jack.html", "Hydraulic jack", scene,
      {{"Angle", {"time", "s"}, {"a", "deg"}, {{"angle", recorder.time(), recorder.coordinate(0) / deg}}},
       recorder.watched_chart("Pressures", "pressure", "bar", {"p_1", "p_2"}),
       recorder.energy_chart()},
      "A bed of 5 t. The valve opens fully, then closes with the error; half of the "
      "energy is lost in its edges.");
  fmt::print("wrote hydraulic_jack.html\n");
} catch (const std::exception& e) {
  std::cerr << "hydraulic_jack: " << e.what() << "\n";
  return 1;
}

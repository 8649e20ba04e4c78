// Flexible beam: a slender robot arm slews by 30 degrees and must not ring.
//
//      hinge o=====================[]  load
//             beam of steel, seen from above
//
// Shows: a flexible body in a floating frame, its modes with a load at the end, a coordinate given in time. A move in T
// with the acceleration of a sine leaves no ringing of a period P if T / P = 2, 3, 4 ...: half a period less, and it does.
// Run: ./run flexible_beam
// Prints: first mode 3.590 Hz, Rayleigh 3.608 Hz
// Prints: move of 2.5 periods: the load swings by 16.2 mm afterwards
// Prints: move of 3.0 periods: the load swings by 0.1 mm afterwards
// Prints: move of 3.5 periods: the load swings by 5.4 mm afterwards
// Prints: largest energy error 1e-04 J
// Next: tram.cpp (a whole study: vehicle, track, ground)
// Reference: A. A. Shabana, Dynamics of Multibody Systems, 4th ed., Cambridge University Press, 2013, ch. 5.

#include <fmt/format.h>

#include <functional>
#include <iostream>

#include "easydyn/easydyn.hpp"
#include "easydyn/visu/report.hpp"

using namespace easydyn;
using namespace easydyn::units;

// 1. Data: a steel strip, upright, and a load [m, kg].
constexpr double length = 1.2, width = 8 * mm, height = 40 * mm, load = 0.5, slew = 30 * deg, E = 2.1e11,
                 damping_ratio = 0.002;
constexpr int elements = 8;

class Arm : public System {
 public:
  explicit Arm(double move_time) : System("Flexible arm") {
    // 2. The hinge is led: acceleration a sin(2 pi t / T), from rest to rest.
    angle.prescribe([move_time](double time) {
      const double w = 2 * pi / move_time, a = slew * w / move_time;
      if (time >= move_time) return ImposedMotion{slew, 0, 0};
      return ImposedMotion{a * (time / w - std::sin(w * time) / (w * w)), a * (1 - std::cos(w * time)) / w,
                           a * std::sin(w * time)};
    });
    for (int i = 1; i <= elements; ++i) marks.push_back(&body(fmt::format("mark {}", i), 0.0));
  }

  Coordinate angle = coordinate("angle");
  FlexibleBody& beam =
      flexible_body("beam", beam_model(BeamData::rectangle(length, elements, E, 8.1e10, 7850, width, height)),
                    {.clamped_nodes = {0}, .modes = 6}, damping_ratio);
  Body& tip = body("load", Inertia::sphere(load, 0.03));
  std::vector<Body*> marks;  // without mass: they show where the nodes are

  void positions() override {
    beam = rotate_z(angle);
    tip = beam.node(elements);
    for (int i = 1; i <= elements; ++i) *marks[static_cast<std::size_t>(i - 1)] = beam.node(i);
  }
  void forces() override { gravity(); }
};

int main() try {
  // 3. First mode beside Rayleigh's estimate with the load and 33/140 of the beam's mass at the tip.
  Arm still(1);
  still.angle.lock(0);
  const State rest = solve_static_equilibrium(still);
  const Mode first = compute_modes(linearize(still, rest))[0];
  const double EI = E * height * width * width * width / 12, beam_mass = still.beam.mass();
  fmt::print("first mode {:.3f} Hz, Rayleigh {:.3f} Hz\n", first.frequency,
             std::sqrt(3 * EI / (length * length * length * (load + 33 / 140. * beam_mass))) / (2 * pi));

  // 4. Slew in 2.5, 3 and 3.5 periods; how far the load still swings afterwards.
  std::vector<visu::Series> swings;
  double energy_error = 0;
  visu::Scene scene;
  for (const double periods : {2.5, 3.0, 3.5}) {
    const double move_time = periods / first.frequency;
    Arm arm(move_time);
    State start = rest;  // already sagging under its weight
    GeneralizedAlpha integrator(arm, (set_consistent_accelerations(arm, start), start), {.step = 2 * ms});
    Recorder recorder(arm, 10 * ms);
    const std::string name = fmt::format("{:.1f} periods", periods);
    double swing = 0;
    recorder.watch(name, [&](const State& s) {
      const Eigen::Vector3d in_arm = arm.beam.frame().rotation().transpose() * arm.tip.position();
      if (s.t > move_time) swing = std::max(swing, std::abs(in_arm.y()));
      return in_arm.y() / mm;
    });
    recorder(integrator.state());
    integrator.advance(move_time + 2, std::ref(recorder));
    fmt::print("move of {:.1f} periods: the load swings by {:.1f} mm afterwards\n", periods, swing / mm);
    const Eigen::VectorXd energy = recorder.total_energy();
    energy_error = std::max(energy_error, (energy.array() - energy[0]).abs().maxCoeff());
    swings.push_back(recorder.watched_chart("", "", "", {name}).series[0]);
    if (periods == 2.5) scene = recorder.scene();
  }
  fmt::print("largest energy error {:.0e} J\n", energy_error);

  // 5. Report.
  const auto draw = [](visu::Scene& s, double y) {
    s.items = {{"load", "load", visu::Shape::sphere, {0.04, 1, 1}, "#bb5566"},
               {"hinge", "", visu::Shape::box, {0.06, 0.06, 0.1}, "#999999"}};
    for (int i = 0; i < elements; ++i)
      s.links.push_back({fmt::format("beam {}", i),
                         {i ? fmt::format("mark {}", i) : "", {0, 0, 0}},
                         {fmt::format("mark {}", i + 1), {0, 0, 0}},
                         visu::LinkShape::line,
                         0.012,
                         "#4477aa"});
    s.camera = {.target = {0.55, y, 0}, .width = 2, .azimuth = -90, .elevation = 60};
  };
  draw(scene, 0.25);
  visu::Scene mode = mode_scene(still, rest, first, {.amplitude = 0.1});
  draw(mode, 0.1);
  visu::Report report("Flexible beam", "slewing without ringing");
  report.add_section("Slew in 2.5 periods")
      .add_animation(scene)
      .add_chart({"Load beside its place in the turning arm", {"time", "s"}, {"deviation", "mm"}, swings});
  report.add_section("First mode").add_animation(mode, fmt::format("{:.3f} Hz", first.frequency));
  report.write("flexible_beam.html");
  fmt::print("wrote flexible_beam.html\n");
} catch (const std::exception& e) {
  std::cerr << "flexible_beam: " << e.what() << "\n";
  return 1;
}

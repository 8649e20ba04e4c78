// Oscillator: a mass on a spring and a damper, free and driven, beside the closed forms.
//
//     ///////
//      |   |
//    k >   = d       z up, from the ceiling
//      |   |
//     [ m ]
//       | F          force, an input
//
// Shows: a system in a few lines; static equilibrium; an integrator that finds events (the highest points);
// the frequency response from an input.
// Run: ./run oscillator
// Prints: sag                  24.525 mm, m g / k           24.525 mm
// Prints: damped period        0.31438 s, closed form       0.31438 s
// Prints: log decrement        0.23579, closed form         0.23579
// Prints: resonance            3.1786 Hz, closed form       3.1786 Hz
// Prints: magnification there  13.343, closed form          13.343
// Prints: energy error         6.6e-06 J
// Next: pendulum.cpp (a nonlinear motion)
// Reference: J. P. Den Hartog, Mechanical Vibrations, McGraw-Hill, 1956, ch. 2.

#include <fmt/format.h>

#include <functional>
#include <iostream>

#include "easydyn/easydyn.hpp"
#include "easydyn/visu/report.hpp"

using namespace easydyn;
using namespace easydyn::units;

// 1. Data [kg, N/m, N s/m, m]: natural frequency 20 rad/s, damping ratio 0.0375.
constexpr double mass = 2, stiffness = 800, damping = 3, free_length = 0.3, side = 0.1;

class Oscillator : public System {
 public:
  Oscillator() : System("Oscillator") {}

  Coordinate z = coordinate("z", -free_length);
  Body& block = body("block", Inertia::box(mass, side, side, side));
  Input force = input("force");

  // 2. Where the bodies are: z is the height of the top of the block.
  void positions() override { block = translate(0, 0, z - side / 2); }

  // 3. Forces.
  void forces() override {
    gravity();
    suspension_.apply(Frame(), {0, 0, 0}, block, {0, 0, side / 2});
    block.add_force({0, 0, force.value()}, block.position());
  }

 private:
  SpringDamper suspension_{"suspension", stiffness, damping, free_length};
};

const Eigen::Quaterniond upright(Eigen::AngleAxisd(pi / 2,
                                                   Eigen::Vector3d::UnitX()));  // cylinders lie along y

int main() try {
  // 4. Equilibrium.
  Oscillator system;
  const State rest = solve_static_equilibrium(system);
  fmt::print("sag                  {:.3f} mm, m g / k           {:.3f} mm\n", (-free_length - rest.q[0]) / mm,
             mass * 9.81 / stiffness / mm);

  // 5. Integration: pulled down 60 mm and let go; stopped at each highest point.
  State start = rest;
  start.q[0] -= 60 * mm;
  set_consistent_accelerations(system, start);
  RungeKutta integrator(system, start,
                        {.relative_tolerance = 1e-9, .absolute_tolerance = 1e-12, .max_step = 1 * ms});
  integrator.watch({"highest point", [](const State& state) { return state.qd[0]; }, -1});
  Recorder recorder(system, 10 * ms);
  recorder(start);
  std::vector<double> times, heights;
  while (times.size() < 8) {
    integrator.advance(10, std::ref(recorder));
    times.push_back(integrator.state().t);
    heights.push_back(integrator.state().q[0] - rest.q[0]);
  }
  const double w0 = std::sqrt(stiffness / mass), ratio = damping / (2 * mass * w0);
  const double damped_period = 2 * pi / (w0 * std::sqrt(1 - ratio * ratio));
  fmt::print("damped period        {:.5f} s, closed form       {:.5f} s\n", (times[7] - times[0]) / 7,
             damped_period);
  fmt::print("log decrement        {:.5f}, closed form         {:.5f}\n",
             std::log(heights[0] / heights[7]) / 7, ratio * w0 * damped_period);

  // 6. Frequency response to the force: displacement over static displacement F / k.
  const Eigen::VectorXd frequency = Eigen::VectorXd::LinSpaced(30001, 2, 5);
  const auto response = compute_frequency_response(linearize_state_space(system, rest), frequency);
  Eigen::VectorXd magnification(frequency.size());
  for (Eigen::Index i = 0; i < frequency.size(); ++i)
    magnification[i] = stiffness * std::abs(response[static_cast<std::size_t>(i)](0, 0));
  Eigen::Index peak = 0;
  const double largest = magnification.maxCoeff(&peak);
  fmt::print("resonance            {:.4f} Hz, closed form       {:.4f} Hz\n", frequency[peak],
             w0 * std::sqrt(1 - 2 * ratio * ratio) / (2 * pi));
  fmt::print("magnification there  {:.3f}, closed form          {:.3f}\n", largest,
             1 / (2 * ratio * std::sqrt(1 - ratio * ratio)));
  const Eigen::VectorXd energy = recorder.total_energy();
  fmt::print("energy error         {:.1e} J\n", (energy.array() - energy[0]).abs().maxCoeff());

  // 7. Report.
  using enum visu::Shape;
  visu::Scene scene = recorder.scene();
  scene.items = {{"ceiling", "", box, {0.4, 0.2, 0.02}, "#999999", {{0, 0, 0.01}}},
                 {"block", "block", box, {side, side, side}, "#4477aa"},
                 {"tube", "block", cylinder, {0.011, 0.12, 1}, "#777777", {{0.03, 0, 0.11}, upright}}};
  const visu::Anchor top{"", {-0.03, 0, 0}}, bottom{"block", {-0.03, 0, side / 2}},
      piston{"block", {0.03, 0, 0.16}};
  scene.links = {{"spring", top, bottom, visu::LinkShape::spring, 0.018, "#bb5566"},
                 {"rod", {"", {0.03, 0, 0}}, piston, visu::LinkShape::line, 0.005, "#333333"}};
  scene.camera = {.target = {0, 0, -0.2}, .width = 1.2, .azimuth = -70, .elevation = 8};
  const visu::Chart response_chart{"Frequency response",
                                   {"frequency", "Hz"},
                                   {"k |z| / |F|", ""},
                                   {{"magnification", frequency, magnification}}};
  visu::write_animation_page("oscillator.html", "Oscillator", scene,
                             {recorder.coordinate_chart("m"), recorder.energy_chart(), response_chart},
                             "A mass on a spring and a damper, pulled down by 60 mm and let go.");
  fmt::print("wrote oscillator.html\n");
} catch (const std::exception& e) {
  std::cerr << "oscillator: " << e.what() << "\n";
  return 1;
}

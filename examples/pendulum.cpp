// Pendulum: the period of a rod at any amplitude, beside the elliptic integral.
//
//    ===o===        o  bearing, axis y
//        \          a  angle from the vertical
//         \ rod
//          \        T = 4 sqrt(J / (m g s)) K(sin(A / 2))
//
// Shows: a coordinate with a start value; an event; the reaction in a bearing.
// Run: ./run pendulum
// Prints: amplitude   5 deg: period 1.6387 s, closed form 1.6387 s
// Prints: amplitude  90 deg: period 1.9333 s, closed form 1.9333 s
// Prints: amplitude 170 deg: period 3.9955 s, closed form 3.9955 s
// Prints: bearing force at the lowest point, from 90 deg: 2.5000 m g, closed form 2.5000 m g
// Prints: energy error 4.7e-05 J
// Next: double_pendulum.cpp (two coordinates)
// Reference: L. D. Landau, E. M. Lifshitz, Mechanics, 3rd ed., Pergamon, 1976, sect. 11.

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <iostream>

#include "easydyn/easydyn.hpp"
#include "easydyn/visu/report.hpp"

using namespace easydyn;
using namespace easydyn::units;

// 1. Data: a thin homogeneous rod [m, kg].
constexpr double length = 1, mass = 2, g = 9.81;

class Pendulum : public System {
 public:
  Pendulum() : System("Pendulum") {}

  Coordinate a = coordinate("a");
  Body& rod = body("rod", Inertia::rod_z(mass, length));
  Reaction bearing = reaction("bearing");

  // 2. Where the rod is: turned about the bearing, its centre half a length below it.
  void positions() override { rod = bearing.cut(Frame()) * rotate_y(a) * translate(0, 0, -length / 2); }

  // 3. Forces.
  void forces() override { gravity(g); }
};

// 4. From rest at the amplitude to the lowest point: a quarter of a period.
State swing_down(Pendulum& system, double amplitude) {
  State start = system.initial_state();
  start.q[0] = amplitude;
  set_consistent_accelerations(system, start);
  RungeKutta integrator(system, start, {.relative_tolerance = 1e-10, .absolute_tolerance = 1e-12});
  integrator.watch({"lowest point", [](const State& state) { return state.q[0]; }, -1});
  integrator.advance(100);
  return integrator.state();
}

double exact_period(double amplitude) {
  const double J = mass * length * length / 3, lever = length / 2;
  return 4 * std::sqrt(J / (mass * g * lever)) * std::comp_ellint_1(std::sin(amplitude / 2));
}

int main() try {
  Pendulum system;
  for (const double amplitude : {5 * deg, 90 * deg, 170 * deg})
    fmt::print("amplitude {:3.0f} deg: period {:.4f} s, closed form {:.4f} s\n", amplitude / deg,
               4 * swing_down(system, amplitude).t, exact_period(amplitude));
  system.compute_reactions(swing_down(system, 90 * deg));
  fmt::print("bearing force at the lowest point, from 90 deg: {:.4f} m g, closed form {:.4f} m g\n",
             system.bearing.force().z() / (mass * g), 1 + 3. / 2);

  // 5. Integration over two wide swings, for the page.
  State start = system.initial_state();
  start.q[0] = 170 * deg;
  set_consistent_accelerations(system, start);
  Newmark newmark(system, start, {.step = 1 * ms});
  Recorder recorder(system, 20 * ms);
  recorder(start);
  newmark.advance(2 * exact_period(170 * deg), std::ref(recorder));
  const Eigen::VectorXd energy = recorder.total_energy();
  fmt::print("energy error {:.1e} J\n", (energy.array() - energy[0]).abs().maxCoeff());

  // 6. Report.
  const Eigen::VectorXd amplitudes = Eigen::VectorXd::LinSpaced(35, 5, 175);
  const Eigen::VectorXd simulated =
      amplitudes.unaryExpr([&](double A) { return 4 * swing_down(system, A * deg).t; });
  const Eigen::VectorXd exact = amplitudes.unaryExpr([](double A) { return exact_period(A * deg); });
  using enum visu::Shape;
  visu::Scene scene = recorder.scene();
  scene.items = {{"rod", "rod", box, {0.05, 0.03, length}, "#4477aa"},
                 {"pin", "", cylinder, {0.04, 0.12, 1}, "#333333"}};
  scene.camera = {.target = {0, 0, 0}, .width = 5.2, .azimuth = -80, .elevation = 6};
  const visu::Chart period{"Period",
                           {"amplitude", "deg"},
                           {"period", "s"},
                           {{"simulation", amplitudes, simulated, visu::Stroke::points},
                            {"elliptic integral", amplitudes, exact}}};
  visu::write_animation_page(
      "pendulum.html", "Pendulum", scene, {recorder.coordinate_chart("rad"), recorder.energy_chart(), period},
      "A rod let go from 170 degrees lingers at the top: the motion is far from a sine.");
  fmt::print("wrote pendulum.html\n");
} catch (const std::exception& e) {
  std::cerr << "pendulum: " << e.what() << "\n";
  return 1;
}

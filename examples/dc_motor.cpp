// DC motor with a PID controller: lift an arm and hold it.
//
//        u  ┌─────┐ M = n k i      ,o   load
//      ───> │ i   │═══[gear n]═══o'     arm, angle a from hanging
//           └─────┘              hinge
//
// Shows: first-order states (a current, a controller), limits of a controller and its winding up, geared bodies, poles of
// the whole with linearize_state_space. Energy goes from the supply into heat, current, motion and height.
// Run: ./run dc_motor
// Prints: holding current 1.0462 A, m g l sin(a) / (n k) = 1.0462 A
// Prints: goal 60.00 deg, peak 63.18 deg, after 4 s 60.00 deg, voltage at most 12.00 V
// Prints: slowest pole -2.975 +- 0.000i 1/s, of the equation by hand -2.975 +- 0.000i 1/s
// Prints: energy error 9e-06 of the energy supplied
// Next: hydraulic_jack.cpp (oil instead of current)
// Reference: K. J. Astrom, T. Hagglund, Advanced PID Control, ISA, 2006.

#include <fmt/format.h>

#include <algorithm>
#include <complex>
#include <iostream>

#include "easydyn/easydyn.hpp"
#include "easydyn/visu/report.hpp"

using namespace easydyn;
using namespace easydyn::units;

// 1. Data: motor of 12 V with a gear, an arm with a load at its end.
constexpr double R = 1.2, L = 2e-3, k = 0.045, n = 60, rotor_inertia = 8e-6;  // [ohm, H, V s, -, kg m^2]
constexpr double load = 0.8, length = 0.35, arm_mass = 0.3, goal = 60 * deg;  // [kg, m]
constexpr double Kp = 30, Ki = 60, Kd = 1, Tf = 0.01;                         // [V, V/s, V s, s]

class Servo : public System {
 public:
  Servo() : System("DC motor") {}

  Coordinate a = coordinate("angle");
  Body &arm = body("arm", Inertia::box(arm_mass, 0.03, 0.03, length)), &weight = body("load", load),
       &rotor = body("rotor", Inertia(0.1, rotor_inertia));
  DcMotor motor{*this, "motor", {.resistance = R, .inductance = L, .constant = k, .gear_ratio = n}};
  Pid pid{*this,
          "controller",
          {.proportional = Kp,
           .integral = Ki,
           .derivative = Kd,
           .filter_time = Tf,
           .lower = -12,
           .upper = 12,
           .tracking_time = 0.2}};

  // 2. The rotor is a body that turns n times as far.
  void positions() override {
    arm = rotate_y(a) * translate(0, 0, -length / 2);
    weight = rotate_y(a) * translate(0, 0, -length);
    rotor = translate(0, 0.1, 0) * rotate_y(n * a);
  }
  // 3. Error to voltage, voltage to current, current to moment.
  void forces() override {
    gravity();
    motor.apply({}, arm, {0, 1, 0}, pid.compute(goal - a.value()));
  }
};

int main() try {
  // 4. Integration: stiff by the current, so BDF. The filter starts at the error: no jump that it would differentiate.
  Servo servo;
  State start = servo.initial_state();
  start.x[2] = goal;  // after current and integral
  Cvode integrator(servo, start,
                   {.relative_tolerance = 1e-8, .absolute_tolerance = 1e-10, .max_step = 2 * ms});
  Recorder recorder(servo, 5 * ms);
  recorder.watch("voltage [V]", [&](const State&) { return servo.pid.value(); });
  recorder.watch("current [A]", [](const State& s) { return s.x[0]; });
  recorder(integrator.state());
  double largest_voltage = 0;
  integrator.advance(4, [&](const State& s) {
    recorder(s);
    largest_voltage = std::max(largest_voltage, std::abs(servo.pid.value()));
  });

  // 5. What it holds, and how it would answer a disturbance.
  const State end = integrator.state();
  const double lever = (load * length + arm_mass * length / 2) * 9.81;
  fmt::print("holding current {:.4f} A, m g l sin(a) / (n k) = {:.4f} A\n",
             end.x[servo.motor.current().index()], lever * std::sin(goal) / (n * k));
  const Eigen::VectorXd angle = recorder.coordinate(0) / deg;
  fmt::print("goal {:.2f} deg, peak {:.2f} deg, after 4 s {:.2f} deg, voltage at most {:.2f} V\n", goal / deg,
             angle.maxCoeff(), end.q[0] / deg, largest_voltage);
  const Mode slowest = compute_modes(linearize_state_space(servo, end))[0];
  const double J = load * length * length + servo.arm.inertia().J(1, 1) + arm_mass * length * length / 4 +
                   n * n * rotor_inertia;
  const auto equation = [&](std::complex<double> s) {
    const auto controller = Kp + Ki / s + Kd * s / (1. + Tf * s);
    return (J * s * s + lever * std::cos(goal)) * (L * s + R) + n * k * (controller + n * k * s);
  };
  const std::complex<double> s = slowest.pole, ds = 1e-4,
                             by_hand = s - equation(s) * ds / (equation(s + ds) - equation(s));
  fmt::print("slowest pole {:.3f} +- {:.3f}i 1/s, of the equation by hand {:.3f} +- {:.3f}i 1/s\n", s.real(),
             s.imag(), by_hand.real(), by_hand.imag());
  const Eigen::VectorXd energy = recorder.total_energy();
  fmt::print("energy error {:.0e} of the energy supplied\n",
             (energy.array() - energy[0]).abs().maxCoeff() / recorder.supplied_energy());

  // 6. Report.
  visu::Scene scene = recorder.scene();
  scene.items = {{"arm", "arm", visu::Shape::box, {0.03, 0.03, length}, "#4477aa"},
                 {"load", "load", visu::Shape::sphere, {0.05, 1, 1}, "#bb5566"},
                 {"shaft", "arm", visu::Shape::cylinder, {0.012, 0.1, 1}, "#333333", {{0, 0.05, length / 2}}},
                 {"rotor", "rotor", visu::Shape::wheel, {0.04, 0.08, 1}, "#ccbb44"},
                 {"motor", "", visu::Shape::box, {0.1, 0.1, 0.1}, "#999999", {{0, 0.2, 0}}}};
  scene.camera = {.target = {-0.1, 0, -0.15}, .width = 1.2, .azimuth = -65, .elevation = 15};
  visu::write_animation_page(
      "dc_motor.html", "DC motor with PID", scene,
      {{"Angle", {"time", "s"}, {"a", "deg"}, {{"angle", recorder.time(), angle}}},
       recorder.watched_chart("Voltage and current", "u, i", "V, A", {"voltage [V]", "current [A]"}),
       recorder.energy_chart()},
      "The controller asks for more than 12 V at first: it is limited, and its integral follows the limit.");
  fmt::print("wrote dc_motor.html\n");
} catch (const std::exception& e) {
  std::cerr << "dc_motor: " << e.what() << "\n";
  return 1;
}

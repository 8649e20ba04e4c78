// Slider-crank: the loop closed by a formula and by the kernel give the same motion.
//
//        B            a  crank angle from x
//       / \  l        the crank turns about A, the piston slides along x
//   r  /    \                                                     .
//     A------[C]      x_C = r cos a + sqrt(l^2 - r^2 sin^2 a)
//
// Shows: a closed loop in one independent coordinate, explicitly and as a Loop whose equation is given by frames.
// Run: ./run slider_crank
// Prints: acceleration at the outer dead centre -1.3125 r w^2, closed form -1.3125 r w^2
// Prints: acceleration at the inner dead centre 0.6875 r w^2, closed form 0.6875 r w^2
// Prints: formula and loop agree within 1e-9 rad over 2 s: yes
// Prints: the crank turns at 52.68 to 60.01 rad/s
// Prints: energy error 2.4e-04 J
// Next: four_bar.cpp (a loop without a handy formula)
// Reference: J. P. Den Hartog, Mechanical Vibrations, McGraw-Hill, 1956, sect. 5.2.

#include <fmt/format.h>

#include <functional>
#include <iostream>

#include "easydyn/easydyn.hpp"
#include "easydyn/visu/report.hpp"

using namespace easydyn;
using namespace easydyn::units;

// 1. Data [m, kg, kg m^2, rad/s].
constexpr double r = 0.05, l = 0.16, crank_mass = 1.5, rod_mass = 0.6, piston_mass = 0.5, flywheel = 0.008;
constexpr double speed = 60;  // of the crank at the start

enum class Closure { formula, loop };

class SliderCrank : public System {
  const Closure closure_;
  Loop<1> closing_ = loop<1>("connecting rod", {0.1});

 public:
  explicit SliderCrank(Closure closure) : System("Slider-crank"), closure_(closure) {}

  Coordinate a = coordinate("a", 0, speed);
  Body& crank = body("crank", Inertia(crank_mass, flywheel));
  Body& rod = body("rod", Inertia::box(rod_mass, l, 0.02, 0.02));
  Body& piston = body("piston", piston_mass);

  // 2. Where the bodies are; b is the angle of the rod. rotate_y turns z towards x: minus for angles from x to z.
  void positions() override {
    crank = rotate_y(-a);
    const Frame pin = crank * translate(r, 0, 0);
    const Expr b = closure_ == Closure::formula ? asin(r / l * sin(a)) : closing_.solve([&](const auto& p) {
      return std::array{(pin * rotate_y(a + p[0]) * translate(l, 0, 0)).express_point({0, 0, 0}).z()};
    })[0];
    rod = pin * rotate_y(a + b) * translate(l / 2, 0, 0);
    piston = translate(r * cos(a) + l * cos(b), 0, 0);
  }

  // 3. Forces.
  void forces() override { gravity(); }
};

// Acceleration of the piston at a crank angle, at constant speed of the crank.
double piston_acceleration(SliderCrank& system, double angle) {
  State state = system.initial_state();
  state.q[0] = angle;
  system.evaluate(state);  // qdd = 0
  return system.piston.acceleration().x();
}

int main() try {
  SliderCrank formula(Closure::formula), loop(Closure::loop);
  // 4. The dead centres: exactly -r w^2 (1 + r / l) and r w^2 (1 - r / l).
  const double unit = r * speed * speed;
  fmt::print("acceleration at the outer dead centre {:.4f} r w^2, closed form {:.4f} r w^2\n",
             piston_acceleration(loop, 0) / unit, -1 - r / l);
  fmt::print("acceleration at the inner dead centre {:.4f} r w^2, closed form {:.4f} r w^2\n",
             piston_acceleration(loop, pi) / unit, 1 - r / l);

  // 5. Integration: both run freely, with the same steps.
  Newmark first(formula, {.step = 0.2 * ms}), second(loop, {.step = 0.2 * ms});
  Recorder recorder(loop, 1 * ms);
  double difference = 0;
  Eigen::VectorXd times(10000), rates(10000);
  Eigen::Index step = 0;
  recorder(second.state());
  second.advance(2, [&](const State& state) {
    first.step();
    recorder(state);
    difference = std::max(difference, std::abs(first.state().q[0] - state.q[0]));
    times[step] = state.t;
    rates[step++] = state.qd[0];
  });
  fmt::print("formula and loop agree within 1e-9 rad over 2 s: {}\n",
             difference < 1e-9 ? "yes" : fmt::format("no, {:.1e}", difference));
  fmt::print("the crank turns at {:.2f} to {:.2f} rad/s\n", rates.minCoeff(), rates.maxCoeff());
  const Eigen::VectorXd energy = recorder.total_energy();
  fmt::print("energy error {:.1e} J\n", (energy.array() - energy[0]).abs().maxCoeff());

  // 6. Report: acceleration over the crank angle beside one and two harmonics, and the speed of the free crank.
  const Eigen::VectorXd angle = Eigen::VectorXd::LinSpaced(361, 0, 360), phase = angle * deg;
  const Eigen::VectorXd exact =
      phase.unaryExpr([&](double p) { return piston_acceleration(loop, p) / unit; });
  const Eigen::VectorXd one = -phase.array().cos(), two = one.array() - r / l * (2 * phase).array().cos();
  const visu::Chart acceleration{"Piston at constant speed of the crank",
                                 {"crank angle", "deg"},
                                 {"acceleration / (r w^2)", ""},
                                 {{"exact", angle, exact},
                                  {"two harmonics", angle, two, visu::Stroke::dashed},
                                  {"one harmonic", angle, one}}};
  const visu::Chart speeds{"Free crank", {"time", "s"}, {"speed", "rad/s"}, {{"speed", times, rates}}};
  using enum visu::Shape;
  visu::Scene scene = recorder.scene();
  scene.items = {{"flywheel", "crank", wheel, {0.07, 0.012, 1}, "#4477aa", {{0, 0.03, 0}}},
                 {"web", "crank", box, {r + 0.03, 0.012, 0.03}, "#4477aa", {{r / 2, 0, 0}}},
                 {"pin", "crank", cylinder, {0.009, 0.05, 1}, "#333333", {{r, -0.01, 0}}},
                 {"rod", "rod", box, {l, 0.012, 0.018}, "#bb5566", {{0, -0.018, 0}}},
                 {"piston", "piston", box, {0.05, 0.05, 0.05}, "#ccbb44"},
                 {"guide", "", box, {0.2, 0.06, 0.006}, "#999999", {{0.18, 0, -0.028}}}};
  scene.camera = {.target = {0.09, 0, 0}, .width = 0.5, .azimuth = -70, .elevation = 18};
  visu::write_animation_page(
      "slider_crank.html", "Slider-crank", scene, {acceleration, speeds, recorder.energy_chart()},
      "The crank turns freely; piston and rod take its energy and give it back twice a turn.");
  fmt::print("wrote slider_crank.html\n");
} catch (const std::exception& e) {
  std::cerr << "slider_crank: " << e.what() << "\n";
  return 1;
}

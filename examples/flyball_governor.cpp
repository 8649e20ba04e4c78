// Stiff flyball governor: balls that fly out lift a slider through very stiff springs.
//
//            |  shaft
//      ------+------        alpha: fall of the arms below the horizontal
//     /      |      \       s: height of the slider
//    /  \    |    /  \      the short lines are springs with dampers
//   o    \ +-+-+ /    o
//  ball    |   |    ball
//          +-+-+  slider
//            |
//
// Shows: a joint that is not ideal. Springs of 800 kN/m take the place of the couplers, so that the equations are stiff:
// their fastest motion dies out within a fraction of a millisecond. An implicit method follows the slow motion; an
// explicit one is held to the step of the fast one.
// Run: ./run flyball_governor
// Prints: BDF: slider 0.61962 m, arms 22.350 deg, shaft 5.5482 rad/s at 10 s
// Prints: energy error 2e-04 J
// Prints: Runge-Kutta: slider 0.61962 m, arms 22.350 deg, shaft 5.5482 rad/s at 10 s
// Prints: energy error 1e-06 J
// Next: rolling_disc.cpp (conditions on velocities)
// Reference: M. Gonzalez et al., Multibody Syst. Dyn. 16, 2006 (IFToMM library of benchmark problems, A05).

#include <fmt/format.h>

#include <functional>
#include <iostream>

#include "easydyn/easydyn.hpp"
#include "easydyn/visu/report.hpp"

using namespace easydyn;
using namespace easydyn::units;

// 1. Data [m, kg]: shaft and arms 1 x 0.01 x 0.01 m, slider 0.1 m, 3000 kg/m^3; hinges 0.05 m beside the axis.
constexpr double hinge = 0.05, arm = 1, edge = 0.1, thickness = 0.01;
constexpr double arm_mass = 3000 * arm * thickness * thickness, slider_mass = 3000 * edge * edge * edge;

class Governor : public System {
 public:
  Governor() : System("Flyball governor") {}

  // 2. Turn of the shaft, height of the slider, fall of the arms.
  Coordinate psi = coordinate("psi", 0, 2 * pi), s = coordinate("s", 0.5);
  Coordinate alpha_1 = coordinate("alpha 1", 30 * deg), alpha_2 = coordinate("alpha 2", 30 * deg);
  Body& shaft = body("shaft", Inertia::box(arm_mass, thickness, thickness, arm));
  Body& slider = body("slider", Inertia::box(slider_mass, edge, edge, edge));
  Body& arm_1 = body("arm 1", Inertia::box(arm_mass, arm, thickness, thickness));
  Body& arm_2 = body("arm 2", Inertia::box(arm_mass, arm, thickness, thickness));
  Body &ball_1 = body("ball 1", 5), &ball_2 = body("ball 2", 5);
  SpringDamper coupler_1{"coupler 1", 8e5, 4e4, 0.5}, coupler_2{"coupler 2", 8e5, 4e4, 0.5};

  void positions() override {
    const Frame top = rotate_z(psi) * translate(0, 0, 1);
    shaft = top * translate(0, 0, -0.5);
    slider = top * translate(0, 0, s - 1);
    arm_1 = top * translate(hinge, 0, 0) * rotate_y(alpha_1) * translate(arm / 2, 0, 0);
    arm_2 = top * translate(-hinge, 0, 0) * rotate_y(-alpha_2) * translate(-arm / 2, 0, 0);
    ball_1 = arm_1 * translate(arm / 2, 0, 0);
    ball_2 = arm_2 * translate(-arm / 2, 0, 0);
  }
  void forces() override {
    gravity();
    coupler_1.apply(slider, {hinge, 0, 0}, arm_1, {0, 0, 0});
    coupler_2.apply(slider, {-hinge, 0, 0}, arm_2, {0, 0, 0});
  }
};

// 3. What the bodies look like, and an animated page.
visu::Item box(const char* body, const Eigen::Vector3d& size, const char* colour) {
  return {.name = body, .frame = body, .size = size, .colour = colour};
}
visu::Item ball(const char* body) {
  return {
      .name = body, .frame = body, .shape = visu::Shape::sphere, .size = {0.08, 1, 1}, .colour = "#bb5566"};
}
visu::Link spring(const char* coupler, const char* arm_body, double side) {
  const visu::Anchor a{"slider", {side * hinge, 0, 0}}, b{arm_body, {0, 0, 0}};
  return {.name = coupler, .a = a, .b = b, .shape = visu::LinkShape::spring, .colour = "#228833"};
}
void write_page(const Recorder& recorder) {
  visu::Scene scene = recorder.scene();
  scene.items = {box("shaft", {0.03, 0.03, arm}, "#777777"), box("slider", {edge, edge, edge}, "#ddaa33")};
  scene.items.push_back({.name = "cross",
                         .frame = "shaft",
                         .size = {0.12, 0.03, 0.03},
                         .colour = "#777777",
                         .offset = {{0, 0, 0.5}}});
  scene.items.push_back(box("arm 1", {arm, 0.02, 0.02}, "#4477aa"));
  scene.items.push_back(box("arm 2", {arm, 0.02, 0.02}, "#4477aa"));
  scene.items.insert(scene.items.end(), {ball("ball 1"), ball("ball 2")});
  scene.links = {spring("coupler 1", "arm 1", 1), spring("coupler 2", "arm 2", -1)};
  scene.ground = 0;
  scene.camera = {.target = {0, 0, 0.6}, .width = 2.6, .azimuth = -60, .elevation = 15, .follow = ""};
  const visu::Series height{"s", recorder.time(), recorder.coordinate(1)};
  const visu::Chart slider{"Slider", {"time", "s"}, {"height", "m"}, {height}};
  visu::write_animation_page(
      "flyball_governor.html", "Stiff flyball governor", scene, {slider, recorder.energy_chart()},
      "The balls fly out, slow the shaft down and lift the slider through springs of 800 kN/m.");
}

// 4. The same ten seconds with an implicit and an explicit method.
template <class Method>
void simulate(const char* method, void (*write)(const Recorder&)) {
  Governor governor;
  Method integrator(governor, AdaptiveOptions{.relative_tolerance = 1e-7, .absolute_tolerance = 1e-9});
  Recorder recorder(governor, 0.02);
  recorder(integrator.state());
  integrator.advance(10, std::ref(recorder));
  const Eigen::VectorXd &q = integrator.state().q, &qd = integrator.state().qd;
  fmt::print("{}: slider {:.5f} m, arms {:.3f} deg, shaft {:.4f} rad/s at 10 s\n", method, q[1], q[2] / deg,
             qd[0]);
  const Eigen::VectorXd energy = recorder.total_energy();
  fmt::print("energy error {:.0e} J\n", (energy.array() - energy[0]).abs().maxCoeff());
  fmt::print("    {} steps\n", integrator.statistics().steps);
  if (write) write(recorder);
}

int main() try {
  simulate<Cvode>("BDF", write_page);
  simulate<RungeKutta>("Runge-Kutta", nullptr);
  fmt::print("wrote flyball_governor.html\n");
} catch (const std::exception& error) {
  std::cerr << "flyball_governor: " << error.what() << "\n";
  return 1;
}

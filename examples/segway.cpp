// Segway: an inverted pendulum on wheels, balanced by a feedback whose poles are chosen.
//
//          O
//         /|  body      theta  lean, forward
//        / |
//      (o)    wheels    x      way, x = r times angle of the wheels
//     -------------     M      moment of the motors, between body and wheels, an input
//
// Shows: rolling in independent coordinates; A and B from the kernel; a controller inside forces(), which
// first drives backwards to go forwards.
// Run: ./run segway
// Prints: unstable pole 5.35844 1/s, closed form 5.35844 1/s
// Prints: poles with feedback: (-4.500, 0.000) (-4.000, 0.000) (-1.000, 1.000) (-1.000, -1.000)
// Prints: backwards first by 0.150 m, lean up to 11.95 deg, after 8 s at 1.999 m
// Prints: energy error 3.8e-04 J
// Next: robot_arm.cpp (a mechanism from a URDF file)
// Reference: K. J. Astrom, R. M. Murray, Feedback Systems, Princeton, 2008, ch. 6.

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <functional>
#include <iostream>

#include "easydyn/easydyn.hpp"
#include "easydyn/visu/report.hpp"

using namespace easydyn;
using namespace easydyn::units;

// 1. Data [kg, m, kg m^2]: rider and platform, wheels.
constexpr double mass = 80, l = 0.85, J = 14, wheels_mass = 10, r = 0.24, J_wheels = 0.3, g = 9.81;

class Segway : public System {
 public:
  Segway() : System("Segway") {}

  Coordinate x = coordinate("x"), theta = coordinate("theta");
  Input moment = input("moment");
  Body& wheels = body("wheels", Inertia(wheels_mass, J_wheels));
  Body& rider = body("rider", Inertia(mass, J));
  Eigen::RowVector4d gains = Eigen::RowVector4d::Zero();  // of x, theta, x., theta.
  double target = 0;                                      // of x [m]

  // 2. Where the bodies are.
  void positions() override {
    wheels = translate(x, 0, r) * rotate_y(x / r);
    rider = translate(x, 0, r) * rotate_y(theta) * translate(0, 0, l);
  }

  // 3. Forces: weight, and the moment of the motors with its power.
  void forces() override {
    gravity(g);
    const Eigen::Vector4d y(x.value() - target, theta.value(), x.rate(), theta.rate());
    const double M = moment.value() - gains.dot(y);
    wheels.add_moment({0, M, 0});
    rider.add_moment({0, -M, 0});
    energy().supplied += M * (x.rate() / r - theta.rate());
  }
};

int main() try {
  Segway segway;
  // 4. Upright and free: the unstable pole.
  const StateSpace space = linearize_state_space(segway, segway.initial_state());
  const double m_x = mass + wheels_mass + J_wheels / (r * r), m_t = J + mass * l * l;
  fmt::print("unstable pole {:.5f} 1/s, closed form {:.5f} 1/s\n", space.A.eigenvalues().real().maxCoeff(),
             std::sqrt(mass * g * l * m_x / (m_x * m_t - mass * mass * l * l)));

  // 5. Gains that put the poles at -1 +- i, -4 and -4.5 (Ackermann): K = (0 0 0 1) [B AB A^2 B A^3 B]^-1 p(A).
  const Eigen::Matrix4d A = space.A, one = Eigen::Matrix4d::Identity();
  Eigen::Matrix4d reach;
  reach << space.B, A * space.B, A * A * space.B, A * A * A * space.B;
  const Eigen::Matrix4d p = (A * A + 2 * A + 2 * one) * (A + 4 * one) * (A + 4.5 * one);
  segway.gains = Eigen::RowVector4d(0, 0, 0, 1) * reach.inverse() * p;
  fmt::print("poles with feedback:");
  for (const std::complex<double> pole :
       linearize_state_space(segway, segway.initial_state()).A.eigenvalues())
    fmt::print(" ({:.3f}, {:.3f})", pole.real(), pole.imag());
  fmt::print("\n");

  // 6. Integration: two metres forwards.
  segway.target = 2;
  Newmark newmark(segway, {.step = 1 * ms});
  Recorder recorder(segway, 20 * ms);
  double backmost = 0, most_lean = 0;
  recorder(newmark.state());
  newmark.advance(8, [&](const State& state) {
    recorder(state);
    backmost = std::min(backmost, state.q[0]);
    most_lean = std::max(most_lean, std::abs(state.q[1]));
  });
  fmt::print("backwards first by {:.3f} m, lean up to {:.2f} deg, after 8 s at {:.3f} m\n", -backmost,
             most_lean / deg, newmark.state().q[0]);
  const Eigen::VectorXd energy = recorder.total_energy();
  fmt::print("energy error {:.1e} J\n", (energy.array() - energy[0]).abs().maxCoeff());

  // 7. Report.
  using enum visu::Shape;
  visu::Scene scene = recorder.scene();
  for (const double side : {-0.3, 0.3})
    scene.items.push_back({"wheel", "wheels", wheel, {r, 0.06, 1}, "#555555", {{0, side, 0}}});
  scene.items.push_back({"platform", "rider", box, {0.4, 0.5, 0.06}, "#999999", {{0, 0, 0.08 - l}}});
  scene.items.push_back({"post", "rider", box, {0.03, 0.03, 1.0}, "#333333", {{0.17, 0, 0.6 - l}}});
  scene.items.push_back({"bar", "rider", cylinder, {0.018, 0.5, 1}, "#333333", {{0.17, 0, 1.1 - l}}});
  for (const double side : {-0.1, 0.1})
    scene.items.push_back({"leg", "rider", box, {0.12, 0.12, 0.8}, "#4477aa", {{-0.03, side, 0.51 - l}}});
  scene.items.push_back({"trunk", "rider", box, {0.2, 0.42, 0.6}, "#bb5566", {{-0.03, 0, 1.21 - l}}});
  scene.items.push_back({"head", "rider", sphere, {0.12, 1, 1}, "#ddaa77", {{-0.03, 0, 1.66 - l}}});
  scene.ground = 0;
  scene.camera = {.target = {1, 0, 0.9}, .width = 5.5, .azimuth = -70, .elevation = 8};
  const auto chart = [&](const char* title, int i, double unit, const char* name) {
    return visu::Chart{
        title, {"time", "s"}, {title, name}, {{title, recorder.time(), recorder.coordinate(i) / unit}}};
  };
  visu::write_animation_page(
      "segway.html", "Segway", scene,
      {chart("Way", 0, 1, "m"), chart("Lean", 1, deg, "deg"), recorder.energy_chart()},
      "Two metres forwards: the wheels first run backwards, so that the rider falls forwards.");
  fmt::print("wrote segway.html\n");
} catch (const std::exception& e) {
  std::cerr << "segway: " << e.what() << "\n";
  return 1;
}

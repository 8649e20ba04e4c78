// Robot arm from a URDF file: computed torque carries a payload from posture to posture.
//
//              elbow o--------o wrist      z
//                   /         |            |
//        upper arm /         [ ] gripper   o--- x      The gripper has two fingers and one coordinate: the right
//                 /           #  payload               finger mimics the left one.
//       shoulder o
//         waist [|]
//
// Shows: a mechanism read from a file and mixed with a body written by hand; the same model, run as inverse dynamics,
// is the controller; what it costs when the controller does not know the payload.
// Run: ./run robot_arm
// Prints: payload known: largest error 0.000 deg, largest torque 48.3 N m
// Prints: energy error 9e-04 J
// Prints: payload unknown: largest error 14.460 deg, largest torque 48.1 N m
// Prints: energy error 1e-03 J
// Next: flexible_beam.cpp (a body that bends)
// Reference: B. Siciliano et al., Robotics: Modelling, Planning and Control, Springer, 2009, sect. 8.5.

#include <fmt/format.h>

#include <array>
#include <functional>
#include <iostream>

#include "easydyn/easydyn.hpp"
#include "easydyn/urdf/urdf_robot.hpp"
#include "easydyn/visu/report.hpp"

using namespace easydyn;
using namespace easydyn::units;
using Vector5 = Eigen::Vector<double, 5>;
using Controller = std::function<Vector5(const State&)>;

// 1. Data: the joints that have a coordinate, in the order of the tree; two postures; payload [kg]; gains.
const std::array joints = {"waist", "shoulder", "elbow", "wrist", "left finger"};
const Vector5 from{-60 * deg, 20 * deg, 70 * deg, 60 * deg, 0.04},
    to{60 * deg, 50 * deg, 45 * deg, 85 * deg, 0.04};
constexpr double half = 2, payload_mass = 1;
constexpr double w = 12, kp = w * w, kd = 2 * w;  // errors decay at w [rad/s], critically damped

// The path from one posture to the other and back: q, qd and qdd at the time of the state.
State path(State s) {
  const double u = s.t < half ? s.t / half : 2 - s.t / half, sign = s.t < half ? 1 : -1;
  s.q = from + (to - from) * (u * u * u * (10 + u * (6 * u - 15)));
  s.qd = (to - from) * (30 * u * u * (1 - u) * (1 - u) * sign / half);
  s.qdd = (to - from) * (60 * u * (1 - u) * (1 - 2 * u) / (half * half));
  return s;
}

// 2. The system: the robot of the file with a payload in its gripper, moved by what a controller asks for.
class Arm : public System {
 public:
  explicit Arm(double mass, Controller c = {})
      : System("Robot arm"),
        payload(body("payload", Inertia::sphere(mass, 0.04))),
        controller(std::move(c)) {}

  UrdfRobot robot{*this, std::string(EASYDYN_EXAMPLES) + "/robots/arm.urdf"};
  Body& payload;
  Controller controller;  // none: no efforts
  Vector5 effort = Vector5::Zero();

  void positions() override {
    robot.place();
    payload = robot.link("hand") * translate(0, 0, 0.16);
  }
  void forces() override {
    gravity();
    robot.apply_damping_and_friction();
    if (!controller) return;
    State now = initial_state();
    now.t = time().value();
    for (Eigen::Index i = 0; i < 5; ++i) {
      now.q[i] = robot.coordinate(joints[i]).value();
      now.qd[i] = robot.coordinate(joints[i]).rate();
    }
    effort = controller(now);
    for (Eigen::Index i = 0; i < 5; ++i) robot.apply_effort(joints[i], effort[i]);
  }
};

// 3. The motion under computed torque by a model that knows a payload of `known` kg: largest error of the angles.
visu::Series simulate(double known, visu::Scene& scene, visu::Chart& energies) {
  Arm model(known);
  Arm arm(payload_mass, [&](State now) -> Vector5 {
    const State r = path(now);
    now.qdd = r.qdd + kd * (r.qd - now.qd) + kp * (r.q - now.q);
    return model.compute_residual(now);
  });
  RungeKutta integrator(arm, path(arm.initial_state()), {.relative_tolerance = 1e-8, .max_step = 0.02});
  Recorder recorder(arm, 0.01);
  std::vector<double> errors;
  double largest_torque = 0;
  const auto watch = [&](const State& s) {
    recorder(s);
    errors.resize(static_cast<std::size_t>(recorder.time().size()),
                  (s.q - path(s).q).head(4).cwiseAbs().maxCoeff() / deg);
    largest_torque = std::max(largest_torque, arm.effort.head(4).cwiseAbs().maxCoeff());
  };
  watch(integrator.state());
  integrator.advance(2 * half, watch);

  visu::Series error{.name = known > 0 ? "payload known" : "payload unknown",
                     .x = recorder.time(),
                     .y = Eigen::VectorXd::Map(errors.data(), recorder.time().size())};
  fmt::print("{}: largest error {:.3f} deg, largest torque {:.1f} N m\n", error.name, error.y.maxCoeff(),
             largest_torque);
  const Eigen::VectorXd energy = recorder.total_energy();
  fmt::print("energy error {:.0e} J\n", (energy.array() - energy[0]).abs().maxCoeff());
  scene = recorder.scene();
  energies = recorder.energy_chart();
  scene.items = arm.robot.items();
  return error;
}

int main() try {
  visu::Scene scene;
  visu::Chart energies,
      errors{.title = "Largest error of the angles", .x = {"time", "s"}, .y = {"error", "deg"}, .series = {}};
  for (const double known : {payload_mass, 0.0}) errors.series.push_back(simulate(known, scene, energies));
  scene.items.push_back(
      {.name = "payload", .frame = "payload", .shape = visu::Shape::sphere, .size = {0.04, 1, 1}});
  scene.ground = 0;
  scene.camera = {.target = {0.25, 0, 0.5}, .width = 2.6, .azimuth = -50, .elevation = 18, .follow = ""};
  visu::write_animation_page(
      "robot_arm.html", "Robot arm from a URDF file", scene, {errors, energies},
      "The arm of `robots/arm.urdf` carries a payload that its controller does not know.");
  fmt::print("wrote robot_arm.html\n");
} catch (const std::exception& e) {
  std::cerr << "robot_arm: " << e.what() << "\n";
  return 1;
}

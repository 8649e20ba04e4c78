// Rolling disc: a coin that rolls without slip, in a steady circle and upright.
//
//        ____
//      /      \        x, y   contact point on the ground
//     |   o    |       psi    heading, about z
//      \ ____ /        theta  lean, to the right
//   ------x-------     phi    spin
//
// Shows: velocity constraints (five coordinates, three velocities); linearisation along them.
// Run: ./run rolling_disc
// Prints: radius of the circle 1.1434 m, closed form 1.1434 m
// Prints: after one turn within 1e-5 m of the start, the lean within 1e-6 rad: yes
// Prints: at 0.8 of the critical speed 0.9905 m/s: lean ~ exp((3.069 + 0.000 i) t), closed form (3.069 + 0.000 i)
// Prints: at 1.2 of the critical speed 0.9905 m/s: lean ~ exp((0.000 + 3.393 i) t), closed form (0.000 + 3.393 i)
// Prints: energy error 5.1e-05 J
// Next: quarter_car.cpp (modes and frequency response)
// Reference: J. I. Neimark, N. A. Fufaev, Dynamics of Nonholonomic Systems, AMS, 1972.

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <functional>
#include <iostream>

#include "easydyn/easydyn.hpp"
#include "easydyn/visu/report.hpp"

using namespace easydyn;
using namespace easydyn::units;

// 1. Data: a thin disc [m, kg]; A across its axis, C along it [kg m^2].
constexpr double r = 0.3, mass = 5, g = 9.81, A = mass * r * r / 4, C = mass * r * r / 2;

class Disc : public System {
 public:
  Disc() : System("Rolling disc") {}

  Coordinate x = coordinate("x"), y = coordinate("y"), psi = coordinate("psi"), theta = coordinate("theta"),
             phi = coordinate("phi");
  VelocityConstraint &rolls = velocity_constraint("rolls"), &tracks = velocity_constraint("tracks");
  Body& disc = body("disc", Inertia(mass, A, C, A));

  // 2. Where the disc is, and that its material does not slip on the ground.
  void positions() override {
    disc = translate(x, y, 0) * rotate_z(psi) * rotate_x(theta) * translate(0, 0, r) * rotate_y(phi);
    rolls = {{cos(psi), x}, {sin(psi), y}, {-r, phi}};
    tracks = {{-sin(psi), x}, {cos(psi), y}};
  }

  // 3. Forces.
  void forces() override { gravity(g); }

  // 4. A start along x that satisfies the constraints.
  State start(double lean, double turn, double spin) {
    State state = initial_state();
    state.q[3] = lean;
    state.qd << r * spin, 0, turn, 0, spin;
    set_consistent_accelerations(*this, state);
    return state;
  }
};

// Spin of a steady circle, from Euler's equation about the horizontal axis through the disc.
double steady_spin(double lean, double turn) {
  const double sine = std::sin(lean), cosine = std::cos(lean);
  return -turn * sine +
         (A * turn * turn * sine * cosine - mass * g * r * sine) / ((C + mass * r * r) * turn * cosine);
}

// Of the small motions about upright rolling, the eigenvalue that is not zero: a growth, or a frequency.
std::complex<double> lean_pole(Disc& disc, double speed) {
  const Eigen::VectorXcd poles = linearize_state_space(disc, disc.start(0, 0, speed / r)).A.eigenvalues();
  Eigen::Index largest = 0;
  (poles.real() + poles.imag()).maxCoeff(&largest);
  return poles[largest];
}

int main() try {
  Disc disc;
  // 5. A steady circle: 20 degrees of lean to the right, 1.5 rad/s to the right.
  const double lean = 20 * deg, turn = -1.5, spin = steady_spin(lean, turn);
  Newmark circle(disc, disc.start(lean, turn, spin), {.step = 1 * ms});
  double wobble = 0, least_y = 0;
  circle.advance(2 * pi / std::abs(turn), [&](const State& state) {
    wobble = std::max(wobble, std::abs(state.q[3] - lean));
    least_y = std::min(least_y, state.q[1]);
  });
  fmt::print("radius of the circle {:.4f} m, closed form {:.4f} m\n", -least_y / 2,
             r * spin / std::abs(turn));
  fmt::print("after one turn within 1e-5 m of the start, the lean within 1e-6 rad: {}\n",
             circle.state().q.head(2).norm() < 1e-5 && wobble < 1e-6 ? "yes" : "no");

  // 6. Upright rolling: (A + m r^2) theta.. = (m g r - C (C + m r^2) (v / r)^2 / A) theta.
  const double critical = r * std::sqrt(A * mass * g * r / (C * (C + mass * r * r)));
  for (const double ratio : {0.8, 1.2}) {
    const double square = mass * g * r * (1 - ratio * ratio) / (A + mass * r * r);
    const auto rounded = [](double x) { return std::round(x * 1e3) / 1e3 + 0.0; };  // no -0.000
    const std::complex<double> pole = lean_pole(disc, ratio * critical);
    const std::complex<double> closed_form = std::sqrt(std::complex<double>(square));
    fmt::print(
        "at {:.1f} of the critical speed {:.4f} m/s: lean ~ exp(({:.3f} + {:.3f} i) t), closed form ({:.3f} "
        "+ {:.3f} i)\n",
        ratio, critical, rounded(pole.real()), rounded(pole.imag()), closed_form.real(), closed_form.imag());
  }

  // 7. For the page: more lean than the circle needs.
  Newmark newmark(disc, disc.start(30 * deg, turn, spin), {.step = 1 * ms});
  Recorder recorder(disc, 20 * ms);
  recorder(newmark.state());
  newmark.advance(12, std::ref(recorder));
  const Eigen::VectorXd energy = recorder.total_energy();
  fmt::print("energy error {:.1e} J\n", (energy.array() - energy[0]).abs().maxCoeff());

  visu::Scene scene = recorder.scene();
  scene.items = {{"disc", "disc", visu::Shape::wheel, {r, 0.02, 1}, "#4477aa"}};
  const Eigen::VectorXd x = recorder.coordinate(0), y = recorder.coordinate(1);
  for (Eigen::Index i = 0; i < x.size(); i += 2)
    scene.items.push_back({"track", "", visu::Shape::sphere, {0.008, 1, 1}, "#bb5566", {{x[i], y[i], 0}}});
  scene.ground = 0;
  scene.camera = {.target = {0, -1.1, 0.15}, .width = 3.3, .azimuth = -60, .elevation = 22};
  const visu::Chart lean_chart{
      "Lean", {"time", "s"}, {"theta", "deg"}, {{"lean", recorder.time(), recorder.coordinate(3) / deg}}};
  visu::write_animation_page(
      "rolling_disc.html", "Rolling disc", scene, {lean_chart, recorder.energy_chart()},
      "The disc leans more than its circle needs, and nods while it rolls; red: track of the contact.");
  fmt::print("wrote rolling_disc.html\n");
} catch (const std::exception& e) {
  std::cerr << "rolling_disc: " << e.what() << "\n";
  return 1;
}

// Spinning top: precession and nutation of a heavy top, beside the closed forms.
//
//        z|  / spin        psi    precession, about z
//         |_/theta         theta  nutation, from the vertical
//         |/               phi    spin, about the top's own axis
//       __v__  tip
//
// Shows: three rotations one after another; conserved quantities; a motion that no small-angle formula covers.
// Run: ./run spinning_top
// Prints: steady precession    2.8587 rad/s, closed form 2.8587 rad/s
// Prints: tilt stays within    1e-6 rad: yes
// Prints: nutation down to     33.4022 deg, closed form   33.4022 deg
// Prints: period of nutation   0.13055 s, closed form     0.13055 s
// Prints: mean precession      2.853 rad/s, fast top      2.725 rad/s
// Prints: energy error         2.3e-08 J
// Next: gyroscope.cpp (gimbals and a motor)
// Reference: H. Goldstein, Classical Mechanics, 3rd ed., 2002, sect. 5.7.

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <iostream>

#include "easydyn/easydyn.hpp"
#include "easydyn/visu/report.hpp"

using namespace easydyn;
using namespace easydyn::units;

// 1. Data: a disc on a massless stem [kg, m, kg m^2]; A about the tip across the axis, C about the axis.
constexpr double mass = 0.5, radius = 0.06, height = 0.05, g = 9.81;
constexpr double C = mass * radius * radius / 2, A = C / 2 + mass * height * height;
constexpr double tilt = 30 * deg, spin = 100;  // at the start [rad, rad/s]

class Top : public System {
 public:
  Top() : System("Spinning top") {}

  Coordinate psi = coordinate("psi"), theta = coordinate("theta", tilt), phi = coordinate("phi", 0, spin);
  Body& disc = body("disc", Inertia(mass, C / 2, C / 2, C));

  // 2. Where the disc is.
  void positions() override {
    disc = rotate_z(psi) * rotate_x(theta) * rotate_z(phi) * translate(0, 0, height);
  }

  // 3. Forces.
  void forces() override { gravity(g); }

  // 4. The state at the start, with a given rate of precession and the spin n about the top's own axis.
  State start(double precession) {
    State state = initial_state();
    state.qd << precession, 0, spin - precession * std::cos(tilt);
    set_consistent_accelerations(*this, state);
    return state;
  }
};

int main() try {
  Top top;
  // 5. Steady precession: (C n - A psi. cos theta) psi. = m g h, slow root.
  const double u0 = std::cos(tilt), m_g_h = mass * g * height, H = C * spin;
  const double steady = (H - std::sqrt(H * H - 4 * A * u0 * m_g_h)) / (2 * A * u0);
  RungeKutta precessing(top, top.start(steady), {.relative_tolerance = 1e-10, .absolute_tolerance = 1e-12});
  double wobble = 0;
  precessing.advance(5, [&](const State& state) { wobble = std::max(wobble, std::abs(state.q[1] - tilt)); });
  fmt::print("steady precession    {:.4f} rad/s, closed form {:.4f} rad/s\n", precessing.state().q[0] / 5,
             steady);
  fmt::print("tilt stays within    1e-6 rad: {}\n", wobble < 1e-6 ? "yes" : "no");

  // 6. Let go without precession: it falls, and rises again to where it was. With u = cos theta and
  // b = C^2 n^2 / (4 A m g h), the lowest u is u_2 and one nutation takes T:
  //   u_2,3 = b -+ sqrt(b^2 - 2 b u_0 + 1)
  //   T = 4 K(k) / sqrt(2 m g h / A (u_3 - u_2))      k^2 = (u_0 - u_2) / (u_3 - u_2)
  const double b = H * H / (4 * A * m_g_h), root = std::sqrt(b * b - 2 * b * u0 + 1);
  const double u2 = b - root, u3 = b + root;
  const double period =
      4 * std::comp_ellint_1(std::sqrt((u0 - u2) / (u3 - u2))) / std::sqrt(2 * m_g_h / A * (u3 - u2));
  RungeKutta nodding(top, top.start(0), {.relative_tolerance = 1e-10, .absolute_tolerance = 1e-12});
  nodding.watch({"lowest point", [](const State& state) { return state.qd[1]; }, -1});
  nodding.advance(5);
  const State& low = nodding.state();
  fmt::print("nutation down to     {:.4f} deg, closed form   {:.4f} deg\n", low.q[1] / deg,
             std::acos(u2) / deg);
  fmt::print("period of nutation   {:.5f} s, closed form     {:.5f} s\n", 2 * low.t, period);
  fmt::print("mean precession      {:.3f} rad/s, fast top      {:.3f} rad/s\n", low.q[0] / low.t, m_g_h / H);
  Newmark newmark(top, top.start(0), {.step = 0.1 * ms});
  Recorder recorder(top, 2 * ms);
  std::vector<Eigen::Vector3d> path;
  recorder(newmark.state());
  newmark.advance(2.2, [&](const State& state) {
    recorder(state);
    path.push_back(top.disc.point({0, 0, 0.04}));
  });
  const Eigen::VectorXd energy = recorder.total_energy();
  fmt::print("energy error         {:.1e} J\n", (energy.array() - energy[0]).abs().maxCoeff());

  // 7. Report, with the path of the upper end of the stem.
  using enum visu::Shape;
  // cylinders lie along y
  const Eigen::Quaterniond upright(Eigen::AngleAxisd(pi / 2, Eigen::Vector3d::UnitX()));
  visu::Scene scene = recorder.scene();
  scene.items = {{"disc", "disc", wheel, {radius, 0.012, 1}, "#4477aa", {{0, 0, 0}, upright}},
                 {"stem", "disc", cylinder, {0.003, 0.09, 1}, "#333333", {{0, 0, -0.005}, upright}}};
  for (std::size_t i = 0; i < path.size(); i += 60)
    scene.items.push_back({"path", "", sphere, {0.0008, 1, 1}, "#bb5566", {path[i]}});
  scene.ground = 0;
  scene.camera = {.target = {0, 0, 0.045}, .width = 0.36, .azimuth = -60, .elevation = 25};
  const auto chart = [&](const char* title, const char* name, int i) {
    return visu::Chart{
        title, {"time", "s"}, {name, "deg"}, {{name, recorder.time(), recorder.coordinate(i) / deg}}};
  };
  visu::write_animation_page(
      "spinning_top.html", "Spinning top", scene,
      {chart("Nutation", "theta", 1), chart("Precession", "psi", 0), recorder.energy_chart()},
      "Let go at 30 degrees without precession: the top nods while it walks around. The dots are the path of "
      "its upper end.");
  fmt::print("wrote spinning_top.html\n");
} catch (const std::exception& e) {
  std::cerr << "spinning_top: " << e.what() << "\n";
  return 1;
}

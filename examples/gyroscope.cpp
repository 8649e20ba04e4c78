// Gyroscope: a motor-driven rotor in gimbals precesses under a weight and nutates when the weight is let go.
//
//      +---------------+      psi    outer ring, about z
//      |  +---------+  |      theta  inner ring, about x
//    z |  |=[rotor]=|--|--o   Omega  spin of the rotor about y, given
//      |  +---------+  | r W  W      weight on the rotor's axis
//      +---------------+
//
// Shows: a coordinate given in time, and the moment that drives it; small motions about a state that is not
// at rest.
// Run: ./run gyroscope
// Prints: steady precession    0.88290 rad/s, closed form 0.88290 rad/s
// Prints: nutation             7.158 Hz, closed form 7.158 Hz
// Prints: mean precession      0.874 rad/s
// Prints: deepest dip          -2.660 deg, small-angle form -2.661 deg
// Prints: motor moment up to   0.0048 N m
// Prints: energy error         2.1e-08 J
// Next: slider_crank.cpp (a closed loop)
// Reference: K. Magnus, Kreisel, Springer, 1971.

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <iostream>

#include "easydyn/easydyn.hpp"
#include "easydyn/visu/report.hpp"

using namespace easydyn;
using namespace easydyn::units;

// 1. Data [kg m^2, kg, m, rad/s].
constexpr double C = 2.0e-3, A = 1.1e-3;              // rotor along and across its axis
constexpr double J_inner = 0.5e-3, J_outer = 1.5e-3;  // rings, the same about every axis
constexpr double weight = 0.15, arm = 0.12, Omega = 100, g = 9.81;

class Gyroscope : public System {
 public:
  Gyroscope() : System("Gyroscope") {
    spin.prescribe([](double time) { return ImposedMotion{Omega * time, Omega, 0}; });
  }

  Coordinate psi = coordinate("psi"), theta = coordinate("theta"), spin = coordinate("spin");
  Body& outer = body("outer ring", Inertia(0.4, J_outer));
  Body& inner = body("inner ring", Inertia(0.2, J_inner));
  Body& rotor = body("rotor", Inertia(1.0, A, C, A));
  Body& load = body("weight", Inertia(weight));

  // 2. Where the bodies are.
  void positions() override {
    outer = rotate_z(psi);
    inner = outer * rotate_x(theta);
    rotor = inner * rotate_y(spin);
    load = inner * translate(0, arm, 0);
  }

  // 3. Forces.
  void forces() override { gravity(g); }

  State start(double precession) {
    State state = initial_state();
    state.qd[0] = precession;
    set_consistent_accelerations(*this, state);
    return state;
  }
};

int main() try {
  Gyroscope gyroscope;
  // 4. Precession: H psi. = m g r, H = C Omega, exact while the rotor's axis is level.
  const double H = C * Omega, precession = weight * g * arm / H;
  RungeKutta steady(gyroscope, gyroscope.start(precession),
                    {.relative_tolerance = 1e-10, .absolute_tolerance = 1e-12});
  steady.advance(2);
  fmt::print("steady precession    {:.5f} rad/s, closed form {:.5f} rad/s\n", steady.state().q[0] / 2,
             precession);

  // 5. Nutation: the fastest of the small motions about this state, w = H / sqrt(J_x J_z).
  const double J_x = J_inner + A + weight * arm * arm, J_z = J_outer + J_inner + A + weight * arm * arm;
  const double nutation = compute_modes(linearize(gyroscope, gyroscope.start(precession))).back().frequency;
  fmt::print("nutation             {:.3f} Hz, closed form {:.3f} Hz\n", nutation,
             H / std::sqrt(J_x * J_z) / (2 * pi));

  // 6. The weight is let go: the axis dips, nods and walks around.
  Newmark newmark(gyroscope, gyroscope.start(0), {.step = 0.1 * ms});
  Recorder recorder(gyroscope, 2 * ms);
  double lowest = 0, largest_moment = 0;
  recorder(newmark.state());
  newmark.advance(2, [&](const State& state) {
    recorder(state);
    lowest = std::min(lowest, state.q[1]);
    largest_moment = std::max(largest_moment, std::abs(gyroscope.holding_force(gyroscope.spin)));
  });
  const Eigen::VectorXd energy = recorder.total_energy();
  fmt::print("mean precession      {:.3f} rad/s\n", newmark.state().q[0] / newmark.state().t);
  fmt::print("deepest dip          {:.3f} deg, small-angle form {:.3f} deg\n", lowest / deg,
             -2 * weight * g * arm * J_z / (H * H) / deg);
  fmt::print("motor moment up to   {:.4f} N m\n", largest_moment);
  fmt::print("energy error         {:.1e} J\n", (energy.array() - energy[0]).abs().maxCoeff());

  // 7. Report: rings as frames of four bars.
  using enum visu::Shape;
  visu::Scene scene = recorder.scene();
  const double a = 0.08, b = 0.1, w = 0.008;  // half widths of the rings, thickness
  const auto bar = [&](const char* frame, const Eigen::Vector3d& size, const Eigen::Vector3d& place,
                       const char* colour) {
    for (const double side : {-1., 1.})
      scene.items.push_back({"bar", frame, box, size, colour, {side * place}});
  };
  bar("inner ring", {w, 2 * a, w}, {a, 0, 0}, "#bb5566");
  bar("inner ring", {2 * a, w, w}, {0, a, 0}, "#bb5566");
  bar("outer ring", {w, w, 2 * b}, {b, 0, 0}, "#ccbb44");
  bar("outer ring", {2 * b, w, w}, {0, 0, b}, "#ccbb44");
  bar("outer ring", {b - a, w / 2, w / 2}, {(a + b) / 2, 0, 0}, "#333333");
  bar("", {w, w, 0.04}, {0, 0, b + 0.02}, "#999999");
  scene.items.push_back(
      {"axle", "inner ring", cylinder, {0.003, a + arm, 1}, "#333333", {{0, (arm - a) / 2, 0}}});
  scene.items.push_back({"rotor", "rotor", wheel, {0.06, 0.025, 1}, "#4477aa"});
  scene.items.push_back({"weight", "weight", sphere, {0.015, 1, 1}, "#333333"});
  scene.camera = {.target = {0, 0, 0}, .width = 0.7, .azimuth = 100, .elevation = 15};
  const auto chart = [&](const char* title, const char* name, int i) {
    return visu::Chart{
        title, {"time", "s"}, {name, "deg"}, {{name, recorder.time(), recorder.coordinate(i) / deg}}};
  };
  visu::write_animation_page(
      "gyroscope.html", "Gyroscope", scene,
      {chart("Precession", "psi", 0), chart("Nutation", "theta", 1), recorder.energy_chart()},
      "A weight on the axis of a rotor at 100 rad/s is let go: the axis hardly falls, it walks around.");
  fmt::print("wrote gyroscope.html\n");
} catch (const std::exception& e) {
  std::cerr << "gyroscope: " << e.what() << "\n";
  return 1;
}

// Four-bar: a loop of two unknowns, and the forces in its bearings.
//
//          C-----___          a  angle of the crank AB, from x
//   b    /          \  c      crank AB = a, coupler BC = b, rocker CD = c, base AD = d
//      /             \        (AB turns fully: shortest + longest < the other two)
//   B /               \                                                     .
//   A ------- d ------ D
//
// Shows: Loop<2> with equations given by frames; reactions in a closed loop, beside Newton's law.
// Run: ./run four_bar
// Prints: rocker swings 72.182 to 137.364 deg, law of cosines 72.182 to 137.364 deg
// Prints: largest force in bearing A 340.64 N, weight of all bars 40.22 N
// Prints: Newton's law of the crank holds within 1e-9 N: yes
// Prints: energy error 5.2e-04 J
// Next: andrews.cpp (three loops)
// Reference: J. J. Uicker et al., Theory of Machines and Mechanisms, 4th ed., Oxford, 2011.

#include <fmt/format.h>

#include <functional>
#include <iostream>

#include "easydyn/easydyn.hpp"
#include "easydyn/visu/report.hpp"

using namespace easydyn;
using namespace easydyn::units;

// 1. Data: homogeneous bars [m, kg].
constexpr double AB = 0.15, BC = 0.40, CD = 0.32, AD = 0.36;
constexpr double mass_AB = 1.2, mass_BC = 1.6, mass_CD = 1.3, width = 0.03, g = 9.81;

class FourBar : public System {
  Loop<2> closing_ = loop<2>("four-bar", {-0.3, 1.5});

 public:
  FourBar() : System("Four-bar") {}

  Coordinate a = coordinate("crank", 60 * deg, 12);
  Body& crank = body("crank", Inertia::box(mass_AB, AB, width, width));
  Body& coupler = body("coupler", Inertia::box(mass_BC, BC, width, width));
  Body& rocker = body("rocker", Inertia::box(mass_CD, CD, width, width));
  Reaction bearing_A = reaction("bearing A"), pin_B = reaction("pin B");
  double rocker_angle() const { return closing_.value(1); }

  // 2. Where the bodies are; p = angles of coupler and rocker from x, towards z (rotate_y turns z towards x).
  void positions() override {
    const Frame A = bearing_A.cut(Frame());
    const Frame B = pin_B.cut(A * rotate_y(-a) * translate(AB, 0, 0));
    const Frame D = translate(AD, 0, 0);
    const auto [coupler_angle, rocker_angle] = closing_.solve([&](const auto& p) {
      const Frame C = B * rotate_y(a - p[0]) * translate(BC, 0, 0),
                  C_too = D * rotate_y(-p[1]) * translate(CD, 0, 0);
      const ExprVector gap = C.express_point({0, 0, 0}) - C_too.express_point({0, 0, 0});
      return std::array{gap.x(), gap.z()};
    });
    crank = A * rotate_y(-a) * translate(AB / 2, 0, 0);
    coupler = B * rotate_y(a - coupler_angle) * translate(BC / 2, 0, 0);
    rocker = D * rotate_y(-rocker_angle) * translate(CD / 2, 0, 0);
  }

  // 3. Forces.
  void forces() override { gravity(g); }
};

int main() try {
  FourBar system;
  // 4. The rocker's ends of swing, where crank and coupler lie in one line: law of cosines.
  double least = 1e9, largest = -1e9;
  State at = system.initial_state();
  for (double angle = 0; angle < 360; angle += 0.25) {
    at.q[0] = angle * deg;
    system.evaluate(at);  // the state keeps the loop's solution: the next place is solved from this one
    least = std::min(least, system.rocker_angle());
    largest = std::max(largest, system.rocker_angle());
  }
  const auto end = [](double AC) { return pi - std::acos((AD * AD + CD * CD - AC * AC) / (2 * AD * CD)); };
  fmt::print("rocker swings {:.3f} to {:.3f} deg, law of cosines {:.3f} to {:.3f} deg\n", least / deg,
             largest / deg, end(BC + AB) / deg, end(BC - AB) / deg);

  // 5. Integration: two seconds with the energy of the start; bearing forces on the way.
  Newmark newmark(system, {.step = 0.5 * ms});
  Recorder recorder(system, 5 * ms);
  std::vector<double> times, forces;
  double misfit = 0;
  const auto watch = [&](const State& state) {
    recorder(state);
    system.compute_reactions(state);
    const Eigen::Vector3d F_A = system.bearing_A.force();                                // ground on crank
    const Eigen::Vector3d F_B = system.crank.frame().rotation() * system.pin_B.force();  // crank on coupler
    const Eigen::Vector3d weight(0, 0, -g * mass_AB);
    misfit = std::max(misfit, (F_A - F_B + weight - mass_AB * system.crank.acceleration()).norm());
    times.push_back(state.t);
    forces.push_back(F_A.norm());
  };
  watch(newmark.state());
  newmark.advance(2, watch);
  const Eigen::VectorXd time = Eigen::VectorXd::Map(times.data(), Eigen::Index(times.size()));
  const Eigen::VectorXd force = Eigen::VectorXd::Map(forces.data(), time.size());
  fmt::print("largest force in bearing A {:.2f} N, weight of all bars {:.2f} N\n", force.maxCoeff(),
             g * (mass_AB + mass_BC + mass_CD));
  fmt::print("Newton's law of the crank holds within 1e-9 N: {}\n",
             misfit < 1e-9 ? "yes" : fmt::format("no, {:.1e}", misfit));
  const Eigen::VectorXd energy = recorder.total_energy();
  fmt::print("energy error {:.1e} J\n", (energy.array() - energy[0]).abs().maxCoeff());

  // 6. Report, with the curve of the coupler's middle.
  using enum visu::Shape;
  visu::Scene scene = recorder.scene();
  const Eigen::Vector3d pin(0.008, 0.07, 1), ground_pin(0.008, 0.05, 1);
  scene.items = {{"crank", "crank", box, {AB, 0.02, width}, "#4477aa"},
                 {"coupler", "coupler", box, {BC, 0.02, width}, "#bb5566", {{0, 0.025, 0}}},
                 {"rocker", "rocker", box, {CD, 0.02, width}, "#ccbb44"},
                 {"base", "", box, {AD + 0.1, 0.02, 0.02}, "#999999", {{AD / 2, -0.025, 0}}},
                 {"A", "crank", cylinder, ground_pin, "#333333", {{-AB / 2, -0.01, 0}}},
                 {"B", "crank", cylinder, pin, "#333333", {{AB / 2, 0.01, 0}}},
                 {"C", "rocker", cylinder, pin, "#333333", {{CD / 2, 0.01, 0}}},
                 {"D", "rocker", cylinder, ground_pin, "#333333", {{-CD / 2, -0.01, 0}}}};
  for (double angle = 0; angle < 360; angle += 4) {
    at.q[0] = angle * deg;
    system.evaluate(at);
    scene.items.push_back(
        {"curve", "", sphere, {0.0025, 1, 1}, "#bb5566", {system.coupler.point({0, 0.0125, 0})}});
  }
  scene.camera = {.target = {0.17, 0, 0.085}, .width = 1.15, .azimuth = -75, .elevation = 10};
  const visu::Chart bearing{"Bearing A", {"time", "s"}, {"force", "N"}, {{"force", time, force}}};
  visu::write_animation_page(
      "four_bar.html", "Four-bar", scene, {bearing, recorder.energy_chart()},
      "A crank-rocker under its own weight; the dots are the curve of the middle of the coupler.");
  fmt::print("wrote four_bar.html\n");
} catch (const std::exception& e) {
  std::cerr << "four_bar: " << e.what() << "\n";
  return 1;
}

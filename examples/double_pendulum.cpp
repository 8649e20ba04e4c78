// Double pendulum: relative and absolute angles give the same motion, and the energy stays where it was.
//
//   ===o===          o  axis of the first rod, y
//      |\            x  axis of the second rod, y
//        \ rod 1     a  angle of rod 1 from the vertical
//         x          b  angle of rod 2: from rod 1 (relative) or from the vertical (absolute)
//         |  rod 2
//
// Shows: a system is a class that declares coordinates and bodies and says where the bodies are; which
// coordinates is the user's choice. Newmark's method is of second order: half the step, a quarter of the
// energy error. The motion is chaotic: a small difference grows until nothing can be predicted.
// Run: ./run double_pendulum
// Prints: step 1   ms: energy drift 9.3e-05 of weight times length
// Prints: step 0.5 ms: energy drift 2.2e-05 of weight times length
// Prints: relative and absolute angles: the same tip within 1e-9 m for 3 s: yes
// Prints: a start 1e-9 rad away: tip 7e-02 m away after 10 s
// Next: spinning_top.cpp (three rotations in space)
// Reference: T. Shinbrot et al., Chaos in a double pendulum, Am. J. Phys. 60, 1992, doi:10.1119/1.16860.

#include <fmt/format.h>

#include <functional>
#include <iostream>

#include "easydyn/easydyn.hpp"
#include "easydyn/visu/report.hpp"

using namespace easydyn;
using namespace easydyn::units;

// 1. Data: two homogeneous rods [m, kg].
constexpr double length_1 = 1.0, length_2 = 0.8, mass_1 = 3, mass_2 = 2;
constexpr double angle_1 = 120 * deg, angle_2 = 150 * deg;  // from the vertical, at the start

enum class Angles { relative, absolute };

class DoublePendulum : public System {
  const Angles angles_;

 public:
  explicit DoublePendulum(Angles angles) : System("Double pendulum"), angles_(angles) {}

  Coordinate a = coordinate("a", angle_1);
  Coordinate b = coordinate("b", angles_ == Angles::relative ? angle_2 - angle_1 : angle_2);
  Body& rod1 = body("rod 1", Inertia::box(mass_1, 0.06, 0.06, length_1));
  Body& rod2 = body("rod 2", Inertia::box(mass_2, 0.05, 0.05, length_2));
  Eigen::Vector3d tip() const { return rod2.point({0, 0, -length_2 / 2}); }

  // 2. Where the bodies are.
  void positions() override {
    const Frame arm = rotate_y(a);
    rod1 = arm * translate(0, 0, -length_1 / 2);
    const Frame forearm = angles_ == Angles::relative
                              ? arm * translate(0, 0, -length_1) * rotate_y(b)
                              : translate(-length_1 * sin(a), 0, -length_1 * cos(a)) * rotate_y(b);
    rod2 = forearm * translate(0, 0, -length_2 / 2);
  }

  // 3. Forces.
  void forces() override { gravity(); }
};

// 4. Integration: ten seconds from rest, rod 1 turned by `change` more; the path of the tip every 20 ms.
Eigen::Matrix3Xd simulate(DoublePendulum& system, double step, double change, Recorder& recorder) {
  State start = system.initial_state();
  start.q[0] += change;
  set_consistent_accelerations(system, start);
  Newmark newmark(system, start, {.step = step});
  recorder(start);
  Eigen::Matrix3Xd path(3, 501);
  path.col(0) = system.tip();
  for (int i = 1; i <= 500; ++i) {
    newmark.advance(i * 0.02, std::ref(recorder));
    path.col(i) = system.tip();
  }
  return path;
}

int main() try {
  DoublePendulum relative(Angles::relative), absolute(Angles::absolute);
  Recorder coarse(relative, 0.02), fine(relative, 0.02), other(absolute, 0.02), changed(relative, 0.02);
  simulate(relative, 1 * ms, 0, coarse);
  const Eigen::Matrix3Xd path = simulate(relative, 0.5 * ms, 0, fine);
  const double weight_times_length = (mass_1 + mass_2) * 9.81 * (length_1 + length_2);
  for (const Recorder* recorder : {&coarse, &fine}) {
    const Eigen::VectorXd energy = recorder->total_energy();
    fmt::print("step {} ms: energy drift {:.1e} of weight times length\n",
               recorder == &coarse ? "1  " : "0.5",
               (energy.array() - energy[0]).abs().maxCoeff() / weight_times_length);
  }

  // 5. The same motion in absolute angles, and a start that differs by 1e-9 rad.
  const Eigen::VectorXd rounding =
      (simulate(absolute, 0.5 * ms, 0, other) - path).colwise().norm().transpose();
  const Eigen::VectorXd growth =
      (simulate(relative, 0.5 * ms, 1e-9, changed) - path).colwise().norm().transpose();
  const double early = rounding.head(150).maxCoeff();
  fmt::print("relative and absolute angles: the same tip within 1e-9 m for 3 s: {}\n",
             early < 1e-9 ? "yes" : fmt::format("no, {:.1e} m", early));
  fmt::print("a start 1e-9 rad away: tip {:.0e} m away after 10 s\n", growth[500]);

  // 6. Report.
  using enum visu::Shape;
  visu::Scene scene = fine.scene();
  scene.items = {{"rod 1", "rod 1", box, {0.06, 0.06, length_1}, "#4477aa"},
                 {"rod 2", "rod 2", box, {0.05, 0.05, length_2}, "#bb5566"},
                 {"bearing", "", cylinder, {0.05, 0.16, 1}, "#333333"},
                 {"elbow", "rod 1", cylinder, {0.04, 0.12, 1}, "#333333", {{0, 0, -length_1 / 2}}}};
  for (int i = 0; i <= 500; ++i)
    scene.items.push_back({"path", "", sphere, {0.008, 1, 1}, "#bb5566", {path.col(i)}});
  scene.camera = {.target = {0, 0, -0.1}, .width = 8, .azimuth = -80, .elevation = 6};
  visu::Chart apart{
      "Two motions that should be one",
      {"time", "s"},
      {"distance of the tips", "m", visu::Scale::logarithmic},
      {{"start 1e-9 rad away", fine.time(), growth}, {"absolute angles: rounding", fine.time(), rounding}}};
  visu::write_animation_page("double_pendulum.html", "Double pendulum", scene,
                             {fine.coordinate_chart("rad"), fine.energy_chart(), apart},
                             "Two rods in a vertical plane, let go from rest; the dots are the path of the "
                             "tip. Small differences grow a "
                             "thousandfold every few seconds.");
  fmt::print("wrote double_pendulum.html\n");
} catch (const std::exception& e) {
  std::cerr << "double_pendulum: " << e.what() << "\n";
  return 1;
}

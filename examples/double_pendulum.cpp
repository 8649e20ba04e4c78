// Double pendulum in space: positions only, and the energy stays where it was.
//
//   ===o===          o  axis of the first rod: y
//      |\            x  axis of the second rod: across it
//        \ rod 1
//         x
//         |  rod 2
//
// Shows: a system is a class that declares coordinates and bodies and says where the bodies are. Velocities,
// accelerations and the equations of motion follow. Newmark's method is of second order: half the step, a quarter
// of the energy error.
// Run: ./run double_pendulum
// Prints: step 2 ms: energy drift 1.57e-06
// Prints: step 1 ms: energy drift 3.93e-07
// Next: tram.cpp (a vehicle on its track)

#include <fmt/format.h>

#include <functional>
#include <iostream>

#include "easydyn/easydyn.hpp"
#include "easydyn/visu/report.hpp"

using namespace easydyn;
using namespace easydyn::units;

// 1. Data: two homogeneous rods [m, kg].
constexpr double length_1 = 1.0, length_2 = 0.8, mass_1 = 3, mass_2 = 2;

// 2. The system: coordinates, bodies, where the bodies are, and the forces.
class DoublePendulum : public System {
 public:
  DoublePendulum() : System("double pendulum") {}

  Coordinate a = coordinate("a", 60 * deg), b = coordinate("b", 45 * deg);
  Body& rod1 = body("rod 1", Inertia::box(mass_1, 0.06, 0.06, length_1));
  Body& rod2 = body("rod 2", Inertia::box(mass_2, 0.05, 0.05, length_2));

  void positions() override {
    const Frame arm = rotate_y(a);
    rod1 = arm * translate(0, 0, -length_1 / 2);
    rod2 = arm * translate(0, 0, -length_1) * rotate_x(b) * translate(0, 0, -length_2 / 2);
  }
  void forces() override { gravity(); }
};

// 3. Integration: ten seconds from rest; the largest change of the energy, relative to the weight times
// length.
double simulate(double step, const std::filesystem::path& page) {
  DoublePendulum system;
  Newmark integrator(system, {.step = step});
  Recorder recorder(system, 0.02);
  recorder(integrator.state());
  integrator.advance(10, std::ref(recorder));

  // 4. Report: an animated page.
  visu::Scene scene = recorder.scene();
  scene.items = {{.name = "rod 1", .frame = "rod 1", .size = {0.06, 0.06, length_1}, .colour = "#4477aa"},
                 {.name = "rod 2", .frame = "rod 2", .size = {0.05, 0.05, length_2}, .colour = "#bb5566"}};
  scene.camera = {.target = {0, 0, -0.8}, .width = 4, .azimuth = -60, .elevation = 15, .follow = ""};
  visu::write_animation_page(
      page, "Double pendulum in space", scene, {recorder.coordinate_chart("rad"), recorder.energy_chart()},
      "Two rods that turn about axes across each other, from rest. The sum of kinetic and "
      "potential energy stays constant but for the error of the time step.");

  const Eigen::VectorXd energy = recorder.total_energy();
  const double scale = (mass_1 + mass_2) * 9.81 * (length_1 + length_2);
  return (energy.array() - energy[0]).abs().maxCoeff() / scale;
}

int main() {
  try {
    for (double step : {2 * ms, 1 * ms})
      fmt::print("step {:g} ms: energy drift {:.2e}\n", step / ms, simulate(step, "double_pendulum.html"));
    fmt::print("wrote double_pendulum.html\n");
  } catch (const std::exception& e) {
    std::cerr << "double_pendulum: " << e.what() << "\n";
    return 1;
  }
}

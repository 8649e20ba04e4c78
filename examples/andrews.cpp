// Andrews' squeezing mechanism: seven bodies in three loops, one coordinate, against the published angles.
//
//     B o            C  ground
//        \          /
//      3  \----D~~~~   spring
//          \          2      1
//   4   ___ E ---------- F --- O  motor
//      / __/                          O A B  hinges on the ground
//    G  H   6
//   5 \ | 7
//       A
//
// Shows: a loop in independent coordinates. The crank's angle is the coordinate; the six other angles are unknowns of a
// loop that Newton's method closes at each evaluation, and their rates and accelerations are exact.
// Run: ./run andrews
// Prints: at 0.03 s: beta 15.8107712, Theta -15.7563711 rad
// Prints: the motor has done 0.52379 J, the energy balance closes within 1e-05 J
// Next: flyball_governor.cpp (a stiff spring instead of a rod)
// Reference: F. Mazzia, C. Magherini, Test Set for IVP Solvers, release 2.4, Bari 2008, problem "andrews"; data of
// E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, Springer 1996, sect. VII.7 (IFToMM A03).

#include <fmt/format.h>

#include <functional>
#include <iostream>

#include "easydyn/easydyn.hpp"
#include "easydyn/visu/report.hpp"

using namespace easydyn;
using namespace easydyn::units;
using Eigen::Vector3d;

// 1. Data: lengths of the bars, places of centres of mass and of hinges on the ground [m].
constexpr double d = 28e-3, da = 115e-4, e = 2e-2, ea = 1421e-5, zf = 2e-2, fa = 1421e-5, rr = 7e-3,
                 ra = 92e-5, ss = 35e-3, sa = 1874e-5, sb = 1043e-5, sc = 18e-3, sd = 2e-2, zt = 4e-2,
                 ta = 2308e-5, tb = 916e-5, u = 4e-2, ua = 1228e-5, ub = 449e-5;
constexpr double xa = -0.06934, ya = -0.00227, xb = -0.03635, yb = 0.03273, xc = 0.014, yc = 0.072;

class Andrews : public System {
 public:
  Andrews() : System("Andrews' mechanism") {}

  // 2. One coordinate, six dependent angles with their guess.
  Coordinate beta = coordinate("beta", -0.0617138900142764);
  Loop<6> closing = loop<6>("Andrews", {0, 0.4553, 0.2227, 0.4874, -0.2227, 1.2305});
  Body &b1 = body("1", Inertia(0.04325, 2.194e-6)), &b2 = body("2", Inertia(0.00365, 4.410e-7)),
       &b3 = body("3", Inertia(0.02373, 5.255e-6)), &b4 = body("4", Inertia(0.00706, 5.667e-7)),
       &b5 = body("5", Inertia(0.07050, 1.169e-5)), &b6 = body("6", Inertia(0.00706, 5.667e-7)),
       &b7 = body("7", Inertia(0.05498, 1.912e-5));
  SpringDamper spring{"spring", 4530, 0, 0.07785};
  static constexpr double moment = 0.033;  // of the motor [N m]

  void positions() override {
    // 3. The bars 3, 5-4 and 7-6 start from B and A and meet the end E of bar 2.
    const auto [Theta, gamma, Phi, delta, Omega, epsilon] = closing.solve([&](const auto& p) {
      const Expr Ex = rr * cos(beta) - d * cos(beta + p[0]), Ey = rr * sin(beta) - d * sin(beta + p[0]);
      return std::array{Ex - xb - ss * sin(p[1]),
                        Ey - yb + ss * cos(p[1]),
                        Ex - xa - zt * cos(p[3]) - e * sin(p[2] + p[3]),
                        Ey - ya - zt * sin(p[3]) + e * cos(p[2] + p[3]),
                        Ex - xa - u * sin(p[5]) - zf * cos(p[4] + p[5]),
                        Ey - ya + u * cos(p[5]) - zf * sin(p[4] + p[5])};
    });
    const Frame A = translate(xa, ya, 0), B = translate(xb, yb, 0);
    b1 = rotate_z(beta) * translate(ra, 0, 0);
    b2 = rotate_z(beta) * translate(rr, 0, 0) * rotate_z(Theta) * translate(-da, 0, 0);
    b3 = B * rotate_z(gamma) * translate(sb, -sa, 0);
    b4 = A * rotate_z(delta) * translate(zt, 0, 0) * rotate_z(Phi) * translate(0, ea - e, 0);
    b5 = A * rotate_z(delta) * translate(ta, tb, 0);
    b6 = A * rotate_z(epsilon) * translate(0, -u, 0) * rotate_z(Omega) * translate(zf - fa, 0, 0);
    b7 = A * rotate_z(epsilon) * translate(-ub, -ua, 0);
  }
  void forces() override {
    spring.apply(Frame(), {xc, yc, 0}, b3, {sd - sb, sa - sc, 0});
    b1.add_moment({0, 0, moment});
    energy().supplied += moment * beta.rate();
  }
};

// 4. What the bodies look like: bars between their hinges, in the axes of each body, in layers one above the other.
void write_page(const Recorder& recorder) {
  using enum visu::Shape;
  visu::Scene scene = recorder.scene();
  const Vector3d C(xc, yc, 0), D(sd - sb, sa - sc, 0);
  const auto bar = [&](const char* body, int layer, const Vector3d& a, const Vector3d& b,
                       const char* colour) {
    const Vector3d size = (b - a).cwiseAbs() + Vector3d(3, 3, 1.8) * mm;
    const visu::Pose middle{(a + b) / 2 + layer * Vector3d(0, 0, 2 * mm)};
    scene.items.push_back({fmt::format("{}, layer {}", body, layer), body, box, size, colour, middle});
  };
  bar("1", 0, {-ra, 0, 0}, {rr - ra, 0, 0}, "#bb5566");
  bar("2", 1, {da - d, 0, 0}, {da, 0, 0}, "#ddaa33");
  bar("3", 0, {-sb, sa, 0}, {-sb, sa - ss, 0}, "#4477aa");
  bar("3", -1, {-sb, sa - sc, 0}, D, "#4477aa");
  bar("4", 2, {0, e - ea, 0}, {0, -ea, 0}, "#228833");
  bar("5", 1, {-ta, -tb, 0}, {zt - ta, -tb, 0}, "#66ccee");
  bar("6", 3, {fa - zf, 0, 0}, {fa, 0, 0}, "#aa3377");
  bar("7", 2, {ub, ua, 0}, {ub, ua - u, 0}, "#999933");
  const Eigen::Quaterniond upright(Eigen::AngleAxisd(pi / 2, Vector3d::UnitX()));  // cylinders lie along y
  const auto pin = [&](const char* name, const char* body, const Vector3d& place) {
    const visu::Pose pose{place + Vector3d(0, 0, 2 * mm), upright};
    scene.items.push_back({name, body, cylinder, {1 * mm, 12 * mm, 1}, "#333333", pose});
  };
  pin("O", "", {0, 0, 0}), pin("A", "", {xa, ya, 0}), pin("B", "", {xb, yb, 0}), pin("C", "", C);
  pin("D", "3", D), pin("E", "2", {da - d, 0, 0}), pin("F", "1", {rr - ra, 0, 0});
  pin("G", "4", {0, e - ea, 0}), pin("H", "6", {fa - zf, 0, 0});
  scene.links = {{"spring", {"", C}, {"3", D}, visu::LinkShape::spring, 2 * mm}};
  scene.camera = {.target = {-0.02, 0.024, 0}, .width = 0.23, .azimuth = -90, .elevation = 70};
  visu::write_animation_page(
      "andrews.html", "Andrews' mechanism", scene, {recorder.energy_chart()},
      "Seven bodies in three closed loops, driven by a constant moment on the red crank. One coordinate, six "
      "dependent angles.");
}

int main() try {
  Andrews andrews;
  RungeKutta integrator(andrews, {.relative_tolerance = 1e-11, .absolute_tolerance = 1e-11});
  Recorder recorder(andrews, 0.05 * ms);
  recorder(integrator.state());
  integrator.advance(0.03, std::ref(recorder));
  const double beta = integrator.state().q[0], work = Andrews::moment * (beta - andrews.initial_state().q[0]);
  const Eigen::VectorXd energy = recorder.total_energy();
  fmt::print("at 0.03 s: beta {:.7f}, Theta {:.7f} rad\n", beta, andrews.closing.value(0));
  fmt::print("the motor has done {:.5f} J, the energy balance closes within {:.0e} J\n", work,
             (energy.array() - energy[0]).abs().maxCoeff());
  write_page(recorder);
  fmt::print("wrote andrews.html\n");
} catch (const std::exception& error) {
  std::cerr << "andrews: " << error.what() << "\n";
  return 1;
}

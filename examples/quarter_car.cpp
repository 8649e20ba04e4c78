// Quarter car: modes, frequency response and a step, on a test rig.
//
//      [ body  ]      z_b
//       |    |
//     k >    = d      suspension
//       |    |
//      ( wheel )      z_w     both from the place at rest, upward
//          >   k_t    tyre
//     -----------     u       height of the post under the tyre, an input
//
// Shows: modes, and their animation; frequency response from an input; loaded springs given by their preload.
// At w^2 = k_t / m_w the body moves by m_w / m_b of the post, whatever the suspension is.
// Run: ./run quarter_car
// Prints: bounce    1.2484 Hz, closed form 1.2484 Hz; with the damper 1.226 Hz, damping ratio 0.258
// Prints: wheel hop 11.3155 Hz, closed form 11.3155 Hz; with the damper 10.691 Hz, damping ratio 0.279
// Prints: damper  600 N s/m: gain at 10.705 Hz 0.13125, m_w / m_b 0.13125
// Prints: damper 1600 N s/m: gain at 10.705 Hz 0.13125, m_w / m_b 0.13125
// Prints: damper 4000 N s/m: gain at 10.705 Hz 0.13125, m_w / m_b 0.13125
// Prints: energy error 1.1e-02 J
// Next: dc_motor.cpp (first-order states)
// Reference: M. Mitschke, H. Wallentowitz, Dynamik der Kraftfahrzeuge, 5th ed., Springer, 2014.

#include <fmt/format.h>

#include <functional>
#include <iostream>

#include "easydyn/easydyn.hpp"
#include "easydyn/visu/report.hpp"

using namespace easydyn;
using namespace easydyn::units;

// 1. Data [kg, N/m, m].
constexpr double m_b = 320, m_w = 42, k = 22 * kN, k_t = 190 * kN, z_wheel = 0.3, z_body = 0.75, g = 9.81;

class QuarterCar : public System {
 public:
  explicit QuarterCar(double damping)
      : System("Quarter car"), suspension_("suspension", k, damping, z_body - z_wheel, m_b * g) {}

  Coordinate zb = coordinate("body"), zw = coordinate("wheel");
  Input post_height = input("post height");
  Body &car_body = body("body", m_b), &wheel = body("wheel", m_w);

  // 2. Where the bodies and the post under the tyre are.
  void positions() override {
    car_body = translate(0, 0, z_body + zb);
    wheel = translate(0, 0, z_wheel + zw);
    post_ = translate(0, 0, post_height.value());
  }

  // 3. Forces; the springs carry the weight at rest.
  void forces() override {
    gravity(g);
    suspension_.apply(wheel, {0, 0, 0}, car_body, {0, 0, 0});
    tyre_.apply(post_, {0, 0, 0}, wheel, {0, 0, 0});
  }

 private:
  Frame post_;
  VerticalSpringDamper suspension_, tyre_{"tyre", k_t, 0, z_wheel, (m_b + m_w) * g};
};

// What the bodies look like, with the post at a height.
visu::Scene dressed(visu::Scene scene, double height) {
  const visu::Anchor axle{"wheel", {0, -0.15, 0}}, lower{"body", {0, -0.15, 0}},
      tube{"body", {0, -0.15, -0.2}};
  scene.items = {{"body", "body", visu::Shape::box, {0.7, 0.5, 0.2}, "#4477aa", {{0, 0, 0.1}}},
                 {"wheel", "wheel", visu::Shape::wheel, {z_wheel, 0.2, 1}, "#555555"},
                 {"post", "", visu::Shape::box, {0.4, 0.3, 0.1}, "#999999", {{0, 0, height - 0.05}}}};
  scene.links = {{"spring", axle, lower, visu::LinkShape::spring, 0.05, "#bb5566"},
                 {"rod", axle, lower, visu::LinkShape::line, 0.012, "#333333"},
                 {"tube", tube, lower, visu::LinkShape::line, 0.03, "#ccbb44"}};
  scene.camera = {.target = {0, 0, 0.5}, .width = 3, .azimuth = -80, .elevation = 8};
  return scene;
}

int main() try {
  // 4. Modes; without the damper, roots of w^4 - (k / m_b + (k + k_t) / m_w) w^2 + k k_t / (m_b m_w).
  QuarterCar car(1600);
  const State rest = solve_static_equilibrium(car);
  Linearization small = linearize(car, rest);
  const std::vector<Mode> damped = compute_modes(small);
  small.C.setZero();
  const std::vector<Mode> modes = compute_modes(small);
  const double half_sum = (k / m_b + (k + k_t) / m_w) / 2;
  const double root = std::sqrt(half_sum * half_sum - k * k_t / (m_b * m_w));
  for (std::size_t i = 0; i < 2; ++i)
    fmt::print("{} {:.4f} Hz, closed form {:.4f} Hz; with the damper {:.3f} Hz, damping ratio {:.3f}\n",
               i ? "wheel hop" : "bounce   ", modes[i].frequency,
               std::sqrt(half_sum + (i ? root : -root)) / (2 * pi), damped[i].pole.imag() / (2 * pi),
               damped[i].damping);

  // 5. Frequency response to the post, for three dampers.
  visu::Chart response{"Body over post",
                       {"frequency", "Hz", visu::Scale::logarithmic},
                       {"|z_b / u|", "", visu::Scale::logarithmic},
                       {}};
  const double fixed_point = std::sqrt(k_t / m_w) / (2 * pi);
  const Eigen::VectorXd frequency =
      Eigen::VectorXd::LinSpaced(400, std::log(0.2), std::log(30.)).array().exp();
  for (const double damping : {600., 1600., 4000.}) {
    QuarterCar variant(damping);
    const StateSpace space = linearize_state_space(variant, rest);
    const auto gain = [&](double f) {
      return std::abs(compute_frequency_response(space, Eigen::VectorXd::Constant(1, f))[0](0, 0));
    };
    response.series.push_back(
        {fmt::format("d = {:.0f} N s/m", damping), frequency, frequency.unaryExpr(gain)});
    fmt::print("damper {:4.0f} N s/m: gain at {:.3f} Hz {:.5f}, m_w / m_b {:.5f}\n", damping, fixed_point,
               gain(fixed_point), m_w / m_b);
  }

  response.series.push_back({"m_w / m_b at the fixed point", Eigen::VectorXd::Constant(1, fixed_point),
                             Eigen::VectorXd::Constant(1, m_w / m_b), visu::Stroke::points});

  // 6. Integration: the post jumps up by 50 mm.
  car.post_height.set(50 * mm);
  Newmark newmark(car, {.step = 0.2 * ms});
  Recorder recorder(car, 10 * ms);
  recorder(newmark.state());
  newmark.advance(2.5, std::ref(recorder));
  const Eigen::VectorXd energy = recorder.total_energy();
  fmt::print("energy error {:.1e} J\n", (energy.array() - energy[0]).abs().maxCoeff());

  // 7. Report.
  visu::Report report("Quarter car", "a step, frequency response and modes");
  report.add_section("Step of 50 mm")
      .add_animation(dressed(recorder.scene(), 50 * mm))
      .add_charts({recorder.coordinate_chart("m"), recorder.energy_chart()});
  report.add_section("Frequency response").add_chart(response).add_section("Modes");
  for (std::size_t i = 0; i < 2; ++i) {
    report.add_animation(
        dressed(mode_scene(car, rest, damped[i], {.amplitude = 0.06}), 0),
        fmt::format("{}, {:.2f} Hz, damping ratio {:.2f}; shown without its decay.",
                    i ? "Wheel hop" : "Bounce", damped[i].pole.imag() / (2 * pi), damped[i].damping));
  }
  report.write("quarter_car.html");
  fmt::print("wrote quarter_car.html\n");
} catch (const std::exception& e) {
  std::cerr << "quarter_car: " << e.what() << "\n";
  return 1;
}

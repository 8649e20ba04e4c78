// Quarter car: modes, frequency response and a ride over a bump.
//
//      [ body  ]          z_b
//       |    |
//     k >    = d          suspension
//       |    |
//      ( wheel )          z_w     both from the place at rest, upward
//          >   k_t        tyre
//     ~~~~~~~~~~~         road height u, an input, and a bump
//
// Shows: a motion given by a function with two derivatives; modes, and how to animate them; frequency response. At
// w^2 = k_t / m_w the body moves by m_w / m_b of the road, whatever the suspension is.
// Run: ./run quarter_car
// Prints: energy error ... J
// Next: dc_motor.cpp (first-order states)
// Reference: M. Mitschke, H. Wallentowitz, Dynamik der Kraftfahrzeuge, 5th ed., 2014, ch. 11.

#include <fmt/format.h>

#include <functional>
#include <iostream>

#include "easydyn/easydyn.hpp"
#include "easydyn/visu/report.hpp"

using namespace easydyn;
using namespace easydyn::units;

// 1. Data [kg, N/m, N s/m, m].
constexpr double m_b = 320, m_w = 42, k = 22 * kN, k_t = 190 * kN, z_wheel = 0.3, z_body = 0.75, g = 9.81;

// A bump of 60 mm from x = 4 to 6 m, (1 - cos) / 2, with its derivatives.
constexpr double bump_start = 4, bump_length = 2, bump_height = 60 * mm, wave = 2 * pi / bump_length;
bool on_bump(double x) {
  return x > bump_start && x < bump_start + bump_length;
}
Expr bump(const Expr& place) {
  const double x = place.value() - bump_start, half = on_bump(place.value()) ? bump_height / 2 : 0;
  return Expr::apply(place, half * (1 - std::cos(wave * x)), half * wave * std::sin(wave * x),
                     half * wave * wave * std::cos(wave * x));
}

class QuarterCar : public System {
 public:
  explicit QuarterCar(double damping, double speed = 8)
      : System("Quarter car"),
        suspension("suspension", k, damping, z_body - z_wheel, m_b * g),
        speed_(speed) {}

  Coordinate zb = coordinate("body"), zw = coordinate("wheel");
  Input height = input("road height");
  Body &body_mass = body("body", m_b), &wheel = body("wheel", m_w);

  // 2. Where the bodies and the patch of road under the tyre are.
  void positions() override {
    const Expr x = speed_ * time();
    body_mass = translate(x, 0, z_body + zb);
    wheel = translate(x, 0, z_wheel + zw);
    road = translate(x, 0, height.value() + bump(x));
  }

  // 3. Forces; the springs carry the weight at rest.
  void forces() override {
    gravity(g);
    suspension.apply(wheel, {0, 0, 0}, body_mass, {0, 0, 0});
    tyre.apply(road, {0, 0, 0}, wheel, {0, 0, 0});
  }

 private:
  Frame road;
  double speed_;
  VerticalSpringDamper suspension, tyre{"tyre", k_t, 0, z_wheel, (m_b + m_w) * g};
};

void add_look(visu::Scene& scene) {
  const visu::Anchor axle{"wheel", {0, -0.15, 0}}, lower{"body", {0, -0.15, 0}},
      tube{"body", {0, -0.15, -0.2}};
  scene.items = {{"body", "body", visu::Shape::box, {0.7, 0.5, 0.2}, "#4477aa", {{0, 0, 0.1}}},
                 {"wheel", "wheel", visu::Shape::cylinder, {z_wheel, 0.2, 1}, "#555555"}};
  scene.links = {{"spring", axle, lower, visu::LinkShape::spring, 0.05, "#bb5566"},
                 {"rod", axle, lower, visu::LinkShape::line, 0.012, "#333333"},
                 {"damper", tube, lower, visu::LinkShape::line, 0.03, "#ccbb44"}};
  scene.camera = {.target = {0, 0, 0.5}, .width = 4, .azimuth = -80, .elevation = 8, .follow = "body"};
}

int main() try {
  // 4. Modes without the damper: roots of w^4 - (k / m_b + (k + k_t) / m_w) w^2 + k k_t / (m_b m_w).
  QuarterCar car(1600);
  const State rest = solve_static_equilibrium(car);
  Linearization small = linearize(car, rest);
  const std::vector<Mode> damped = compute_modes(small);
  small.C.setZero();
  const std::vector<Mode> modes = compute_modes(small);
  const double half_sum = (k / m_b + (k + k_t) / m_w) / 2,
               root = std::sqrt(half_sum * half_sum - k * k_t / (m_b * m_w));
  const char* names[] = {"bounce   ", "wheel hop"};
  for (std::size_t i = 0; i < 2; ++i)
    fmt::print("{} {:.4f} Hz, closed form {:.4f} Hz; with the damper {:.3f} Hz, damping ratio {:.3f}\n",
               names[i], modes[i].frequency, std::sqrt(half_sum + (i ? root : -root)) / (2 * pi),
               damped[i].frequency, damped[i].damping);

  // 5. Frequency response, for three dampers.
  visu::Chart response{.title = "Body over road",
                       .x = {"frequency", "Hz", visu::Scale::logarithmic},
                       .y = {"|z_b / u|", "", visu::Scale::logarithmic},
                       .series = {}};
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

  // 6. Integration over the bump.
  Newmark newmark(car, {.step = 1 * ms});
  Recorder recorder(car, 10 * ms);
  recorder(newmark.state());
  newmark.advance(2.5, std::ref(recorder));
  const Eigen::VectorXd energy = recorder.total_energy();
  fmt::print("energy error {:.1e} J\n", (energy.array() - energy[0]).abs().maxCoeff());

  // 7. Report: the ride, the response, and each mode at a hand-made sequence of states.
  visu::Report report("Quarter car", "a ride over a bump, frequency response and modes");
  visu::Scene scene = recorder.scene();
  add_look(scene);
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(221, -2, 22);
  const Eigen::VectorXd profile = x.unaryExpr([](double place) { return bump(place).value(); });
  scene.lines = {{.name = "road",
                  .x = x,
                  .deflection = profile.transpose().replicate(scene.time.size(), 1),
                  .width = 0.02}};
  visu::Chart heights = recorder.coordinate_chart("m");
  heights.series.push_back(
      {"road", heights.series[0].x,
       (8 * heights.series[0].x).unaryExpr([](double place) { return bump(place).value(); })});
  report.add_section("Over a bump").add_animation(scene).add_charts({heights, recorder.energy_chart()});
  report.add_section("Frequency response").add_chart(response).add_section("Modes");
  QuarterCar standing(1600, 0);
  for (std::size_t i = 0; i < 2; ++i) {
    Recorder period(standing, 1e-9);
    for (int step = 0; step <= 60; ++step) {
      State at = rest;
      at.t = step / 60. / damped[i].frequency;
      at.q += 0.06 * (damped[i].shape * std::polar(1., 2 * pi * step / 60)).real();
      period(at);
    }
    visu::Scene mode = period.scene();
    add_look(mode);
    report.add_animation(mode,
                         fmt::format("{}, {:.2f} Hz, damping ratio {:.2f}; shown without its decay.",
                                     i ? "Wheel hop" : "Bounce", damped[i].frequency, damped[i].damping));
  }
  report.write("quarter_car.html");
  fmt::print("wrote quarter_car.html\n");
} catch (const std::exception& e) {
  std::cerr << "quarter_car: " << e.what() << "\n";
  return 1;
}

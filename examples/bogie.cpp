// Bogie: bounce and pitch over a wavy profile, and what the wheelbase filters.
//
//       [====== frame ======]       z, theta
//         >               >         primary suspension k, d
//        (o)             (o)        wheelsets follow the profile
//     ~~~~~~~~~~~~~~~~~~~~~~~~~     r(x) = h cos(2 pi x / L)
//         |<---- 2 a ---->|   --> v
//
// Shows: imposed motion as an expression of time; steady vibration beside the closed form.
// L = 4 a: pitch alone; L = 2 a: bounce alone.
// Run: ./run bogie
// Prints: bounce 4.3586 Hz, closed form 4.3586 Hz
// Prints: pitch  5.6270 Hz, closed form 5.6270 Hz
// Prints: wavelength 2.5 m: bounce 2.596 mm, pitch 0.000 mrad; closed form 2.596 mm, 0.000 mrad
// Prints: wavelength 5 m: bounce 0.000 mm, pitch 6.691 mrad; closed form 0.000 mm, 6.690 mrad
// Prints: largest difference from the closed form 9.3e-05 of the profile
// Prints: energy error 9.8e-02 J
// Next: segway.cpp (feedback)
// Reference: K. Knothe, S. Stichel, Rail Vehicle Dynamics, Springer, 2017, doi:10.1007/978-3-319-45376-7.

#include <fmt/format.h>

#include <complex>
#include <functional>
#include <iostream>

#include "easydyn/easydyn.hpp"
#include "easydyn/visu/report.hpp"

using namespace easydyn;
using namespace easydyn::units;

// 1. Data, per bogie and per wheelset [kg, kg m^2, N/m, N s/m, m, m/s].
constexpr double mass = 3200, J = 3000, wheelset_mass = 1400, k = 1.2e6, d = 20e3, a = 1.25, v = 20;
constexpr double wheel_radius = 0.43, z_frame = 0.65, height = 5 * mm, g = 9.81;

class Bogie : public System {
  const double wavenumber_;

 public:
  explicit Bogie(double wavelength) : System("Bogie"), wavenumber_(2 * pi / wavelength) {}

  Coordinate z = coordinate("bounce"), theta = coordinate("pitch");
  Body& frame = body("frame", Inertia(mass, J));
  Body& front = body("front wheelset", wheelset_mass);
  Body& rear = body("rear wheelset", wheelset_mass);

  // 2. Where the bodies are.
  void positions() override {
    const Expr x = v * time();
    const auto wheelset = [&](const Expr& place) {
      return translate(place, 0, wheel_radius + height * cos(wavenumber_ * place));
    };
    frame = translate(x, 0, z_frame + z) * rotate_y(theta);
    front = wheelset(x + a);
    rear = wheelset(x - a);
  }

  // 3. Forces; the springs carry the frame at rest.
  void forces() override {
    gravity(g);
    front_spring_.apply(front, {0, 0, 0}, frame, {a, 0, 0});
    rear_spring_.apply(rear, {0, 0, 0}, frame, {-a, 0, 0});
  }

 private:
  VerticalSpringDamper front_spring_{"front primary", k, d, z_frame - wheel_radius, mass* g / 2};
  VerticalSpringDamper rear_spring_{"rear primary", k, d, z_frame - wheel_radius, mass* g / 2};
};

// 4. Closed form: the mean of the two wheels drives the bounce, their difference the pitch; each is one mass
// on the springs, moved at its foot at w = 2 pi v / L. Amplitudes of bounce [m] and pitch [rad].
Eigen::Vector2d exact(double wavelength) {
  const double w = 2 * pi * v / wavelength, phase = 2 * pi * a / wavelength;
  const std::complex<double> foot(2 * k, 2 * d * w);
  return {height * std::abs(std::cos(phase) * foot / (foot - mass * w * w)),
          height / a * std::abs(std::sin(phase) * foot / (foot - J / (a * a) * w * w))};
}

// 5. Integration: four seconds let the start die away, the fifth is measured.
Eigen::Vector2d simulate(Bogie& bogie, Recorder& recorder) {
  Newmark newmark(bogie, {.step = 0.5 * ms});
  Eigen::Vector2d high(-1, -1), low(1, 1);
  newmark.advance(4);
  recorder(newmark.state());
  newmark.advance(5, [&](const State& state) {
    recorder(state);
    high = high.cwiseMax(state.q);
    low = low.cwiseMin(state.q);
  });
  return (high - low) / 2;
}

// 6. The look: heights ten times too large.
visu::Scene draw(const Recorder& recorder, double wavelength) {
  using enum visu::Shape;
  visu::Scene scene = recorder.scene();
  scene.exaggeration = 10;
  const double rest_height[] = {z_frame, wheel_radius, wheel_radius};
  for (std::size_t b = 0; b < 3; ++b) scene.frames[b].rest = visu::Pose{{0, 0, rest_height[b]}};
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(601, 4 * v - 6, 5 * v + 6);
  const Eigen::VectorXd profile = height * (2 * pi / wavelength * x).array().cos();
  const Eigen::MatrixXd rail = profile.transpose().replicate(scene.time.size(), 1);
  scene.items = {{"transom", "frame", box, {0.4, 2, 0.16}, "#4477aa", {{0, 0, 0.12}}}};
  for (const double side : {-1., 1.}) {
    scene.lines.push_back({"rail", x, rail, 0.75 * side, 0, 0.05});
    scene.items.push_back({"beam", "frame", box, {3.2, 0.12, 0.18}, "#4477aa", {{0, side, 0.12}}});
    for (const std::string name : {"front wheelset", "rear wheelset"}) {
      const visu::Anchor box_end{name, {0, side, 0}}, seat{"frame", {name[0] == 'f' ? a : -a, side, 0.05}};
      scene.items.push_back(
          {"wheel", name, cylinder, {wheel_radius, 0.12, 1}, "#555555", {{0, 0.75 * side, 0}}});
      scene.items.push_back({"axle", name, cylinder, {0.08, 1.05, 1}, "#777777", {{0, 0.525 * side, 0}}});
      scene.links.push_back({"primary", box_end, seat, visu::LinkShape::spring, 0.07, "#bb5566"});
    }
  }
  scene.camera = {.target = {0, 0, 0.5}, .width = 7, .azimuth = -70, .elevation = 12, .follow = "frame"};
  return scene;
}

int main() try {
  // 7. Modes.
  Bogie bogie(4 * a);
  const std::vector<Mode> modes = compute_modes(linearize(bogie, bogie.initial_state()));
  fmt::print("bounce {:.4f} Hz, closed form {:.4f} Hz\n", modes[0].frequency,
             std::sqrt(2 * k / mass) / (2 * pi));
  fmt::print("pitch  {:.4f} Hz, closed form {:.4f} Hz\n", modes[1].frequency,
             std::sqrt(2 * k * a * a / J) / (2 * pi));

  // 8. Steady vibration over many wavelengths; amplitudes over that of the profile, the pitch times a.
  const Eigen::Array2d unit(height, height / a);
  visu::Report report("Bogie", "bounce and pitch over a wavy profile at 20 m/s");
  const Eigen::VectorXd lengths = Eigen::VectorXd::LinSpaced(37, 2, 11),
                        fine = Eigen::VectorXd::LinSpaced(451, 2, 11);
  Eigen::Matrix2Xd points(2, lengths.size()), curve(2, fine.size());
  double worst = 0, energy_error = 0;
  for (Eigen::Index i = 0; i < lengths.size(); ++i) {
    Bogie one(lengths[i]);
    Recorder recorder(one, 5 * ms);
    const Eigen::Vector2d found = simulate(one, recorder), e = exact(lengths[i]);
    const Eigen::VectorXd energy = recorder.total_energy();
    points.col(i) = found.array() / unit;
    worst = std::max(worst, ((found - e).array() / unit).abs().maxCoeff());
    energy_error = std::max(energy_error, (energy.array() - energy[0]).abs().maxCoeff());
    if (std::abs(lengths[i] - 2 * a) < 1e-9 || std::abs(lengths[i] - 4 * a) < 1e-9)
      fmt::print("wavelength {} m: bounce {:.3f} mm, pitch {:.3f} mrad; closed form {:.3f} mm, {:.3f} mrad\n",
                 lengths[i], found[0] / mm, found[1] / 1e-3, e[0] / mm, e[1] / 1e-3);
    if (std::abs(lengths[i] - 4 * a) < 1e-9)
      report.add_animation(draw(recorder, lengths[i]), "Wavelength 5 m, twice the wheelbase: pitch alone.");
  }
  fmt::print("largest difference from the closed form {:.1e} of the profile\n", worst);
  fmt::print("energy error {:.1e} J\n", energy_error);

  // 9. Report.
  for (Eigen::Index i = 0; i < fine.size(); ++i) curve.col(i) = exact(fine[i]).array() / unit;
  report.add_chart({"Steady amplitude over amplitude of the profile",
                    {"wavelength", "m"},
                    {"amplitude", ""},
                    {{"bounce", lengths, points.row(0), visu::Stroke::points, "#4477aa"},
                     {"pitch, times a", lengths, points.row(1), visu::Stroke::points, "#bb5566"},
                     {"bounce, closed form", fine, curve.row(0), visu::Stroke::line, "#4477aa"},
                     {"pitch, closed form", fine, curve.row(1), visu::Stroke::line, "#bb5566"}}});
  report.write("bogie.html");
  fmt::print("wrote bogie.html\n");
} catch (const std::exception& e) {
  std::cerr << "bogie: " << e.what() << "\n";
  return 1;
}

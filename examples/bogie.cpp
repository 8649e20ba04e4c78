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
constexpr double mass = 3200, J = 3000, wheelset = 1400, k = 1.2e6, d = 20e3, a = 1.25, v = 20;
constexpr double radius = 0.43, z_frame = 0.65, height = 5 * mm, g = 9.81;

class Bogie : public System {
  const double wavenumber_;
  VerticalSpringDamper primary_{"primary", k, d, z_frame - radius, mass* g / 2};

 public:
  explicit Bogie(double wavelength) : System("Bogie"), wavenumber_(2 * pi / wavelength) {}

  Coordinate z = coordinate("bounce"), theta = coordinate("pitch");
  Body &frame = body("frame", {mass, J}), &front = body("front", wheelset), &rear = body("rear", wheelset);

  // 2. Where the bodies are.
  void positions() override {
    const Expr x = v * time(), x_front = x + a, x_rear = x - a;
    frame = translate(x, 0, z_frame + z) * rotate_y(theta);
    front = translate(x_front, 0, radius + height * cos(wavenumber_ * x_front));
    rear = translate(x_rear, 0, radius + height * cos(wavenumber_ * x_rear));
  }

  // 3. Forces; the springs carry the frame at rest.
  void forces() override {
    gravity(g);
    primary_.apply(front, {0, 0, 0}, frame, {a, 0, 0});
    primary_.apply(rear, {0, 0, 0}, frame, {-a, 0, 0});
  }
};

// 4. Closed form: the mean of the two wheels drives the bounce, their difference the pitch; each is one mass
// on the springs, moved at its foot at w = 2 pi v / L. Amplitudes over that of the profile, the pitch times a.
Eigen::Array2d exact(double wavelength) {
  const double w = 2 * pi * v / wavelength, phase = 2 * pi * a / wavelength;
  const std::complex<double> foot(2 * k, 2 * d * w);
  return {std::abs(std::cos(phase) * foot / (foot - mass * w * w)),
          std::abs(std::sin(phase) * foot / (foot - J / (a * a) * w * w))};
}

// 5. The look: heights ten times too large.
visu::Scene draw(const Recorder& recorder, double wavelength) {
  using enum visu::Shape;
  visu::Scene scene = recorder.scene();
  scene.exaggeration = 10;
  for (auto& f : scene.frames) f.rest = visu::Pose{{0, 0, f.name == "frame" ? z_frame : radius}};
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(601, 4 * v - 6, 5 * v + 6);
  const Eigen::RowVectorXd profile = height * (2 * pi / wavelength * x).array().cos().transpose();
  scene.items = {{"transom", "frame", box, {0.4, 2, 0.16}, "#4477aa", {{0, 0, 0.12}}}};
  for (const double side : {-1., 1.}) {
    scene.lines.push_back({"rail", x, profile.replicate(scene.time.size(), 1), 0.75 * side, 0, 0.05});
    scene.items.push_back({"beam", "frame", box, {3.2, 0.12, 0.18}, "#4477aa", {{0, side, 0.12}}});
    for (const std::string name : {"front", "rear"}) {
      const visu::Anchor box_end{name, {0, side, 0}}, seat{"frame", {name[0] == 'f' ? a : -a, side, 0.05}};
      scene.items.push_back({"wheel", name, cylinder, {radius, 0.12, 1}, "#555555", {{0, 0.75 * side, 0}}});
      scene.items.push_back({"axle", name, cylinder, {0.08, 1.05, 1}, "#777777", {{0, 0.525 * side, 0}}});
      scene.links.push_back({"primary", box_end, seat, visu::LinkShape::spring, 0.07, "#bb5566"});
    }
  }
  scene.camera = {.target = {0, 0, 0.5}, .width = 7, .azimuth = -70, .elevation = 12, .follow = "frame"};
  return scene;
}

int main() try {
  // 6. Modes.
  Bogie bogie(4 * a);
  const std::vector<Mode> modes = compute_modes(linearize(bogie, bogie.initial_state()));
  const double bounce = std::sqrt(2 * k / mass) / (2 * pi), pitch = std::sqrt(2 * k * a * a / J) / (2 * pi);
  fmt::print("bounce {:.4f} Hz, closed form {:.4f} Hz\n", modes[0].frequency, bounce);
  fmt::print("pitch  {:.4f} Hz, closed form {:.4f} Hz\n", modes[1].frequency, pitch);

  // 7. Steady vibration over many wavelengths: four seconds let the start die away, the fifth is measured.
  const Eigen::VectorXd lengths = Eigen::VectorXd::LinSpaced(37, 2, 11);
  Eigen::Matrix2Xd points(2, 37), curve(2, 451);
  double worst = 0, energy_error = 0;
  visu::Scene scene;
  for (Eigen::Index i = 0; i < 37; ++i) {
    Bogie one(lengths[i]);
    Newmark newmark(one, {.step = 0.5 * ms});
    Recorder record(one, 0.4 * ms);  // every step
    newmark.advance(4);
    newmark.advance(5, std::ref(record));
    const Eigen::VectorXd E = record.total_energy(), q1 = record.coordinate(0), q2 = record.coordinate(1);
    const Eigen::Array2d high(q1.maxCoeff(), q2.maxCoeff()), low(q1.minCoeff(), q2.minCoeff());
    const Eigen::Array2d unit(height, height / a), found = (high - low) / 2, e = exact(lengths[i]) * unit;
    points.col(i) = found / unit;
    worst = std::max(worst, ((found - e) / unit).abs().maxCoeff());
    energy_error = std::max(energy_error, (E.array() - E[0]).abs().maxCoeff());
    if (lengths[i] != 2 * a && lengths[i] != 4 * a) continue;
    fmt::print("wavelength {} m: bounce {:.3f} mm, pitch {:.3f} mrad; closed form {:.3f} mm, {:.3f} mrad\n",
               lengths[i], found[0] / mm, found[1] * 1e3, e[0] / mm, e[1] * 1e3);
    scene = draw(record, lengths[i]);  // at last the longer wave
  }
  fmt::print("largest difference from the closed form {:.1e} of the profile\n", worst);
  fmt::print("energy error {:.1e} J\n", energy_error);

  // 8. Report.
  const Eigen::VectorXd fine = Eigen::VectorXd::LinSpaced(451, 2, 11);
  for (Eigen::Index i = 0; i < 451; ++i) curve.col(i) = exact(fine[i]);
  const std::vector<visu::Series> series = {
      {"bounce", lengths, points.row(0), visu::Stroke::points, "#4477aa"},
      {"pitch, times a", lengths, points.row(1), visu::Stroke::points, "#bb5566"},
      {"bounce, closed form", fine, curve.row(0), visu::Stroke::line, "#4477aa"},
      {"pitch, closed form", fine, curve.row(1), visu::Stroke::line, "#bb5566"}};
  const visu::Chart chart{"Steady amplitude", {"wavelength", "m"}, {"over the profile's", ""}, series};
  visu::write_animation_page("bogie.html", "Bogie", scene, {chart}, "At a wavelength of 5 m: pitch alone.");
  fmt::print("wrote bogie.html\n");
} catch (const std::exception& e) {
  std::cerr << "bogie: " << e.what() << "\n";
  return 1;
}

#include "tests/browser/synthetic_results.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "easydyn/results/result_file.hpp"
#include "easydyn/visu/json.hpp"
#include "easydyn/visu/parameter_json.hpp"
#include "easydyn/visu/scene.hpp"
#include "easydyn/visu/table_json.hpp"

namespace easydyn::testing {

namespace {

namespace json = visu::json;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double speed = 30 / 3.6, defect = 36, duration = 7.5, step = 0.004;
const Eigen::Matrix<double, 6, 1> wheels{8.71,  7.01,  0.85,
                                         -0.85, -7.01, -8.71};  // from the middle of the tram
const Eigen::Matrix<double, 6, 1> loads{67e3, 34e3, 78e3, 78e3, 34e3, 67e3};

double middle_of_tram(double t) {
  return 6 + speed * t;
}

/// Dynamic part of the force of wheel `w`: a decaying 45 Hz oscillation from the defect on.
double shock(Index w, double t) {
  const double since = t - (defect - 6 - wheels(w)) / speed;
  if (since < 0) return 0.01 * std::sin(2 * std::numbers::pi * 1.7 * t + double(w));
  return 0.45 * std::exp(-since / 0.09) * std::sin(2 * std::numbers::pi * 45 * since) +
         0.06 * std::exp(-since / 0.6) * std::sin(2 * std::numbers::pi * 7 * since);
}

/// Deflection under a unit load at distance d of a beam on a Winkler foundation with the length L.
double winkler(double d, double L) {
  const double s = std::abs(d) / L;
  return std::exp(-s) * (std::cos(s) + std::sin(s));
}

struct Passage {
  VectorXd time = VectorXd::LinSpaced(Index(duration / step) + 1, 0, duration);
  VectorXd sleepers = VectorXd::LinSpaced(121, 0, 120 * 0.6);
  MatrixXd force{time.size(), 6}, position{time.size(), 6};
  MatrixXd rail{time.size(), 121}, sleeper{time.size(), 121}, foundation{time.size(), 121},
      reaction{time.size(), 121};

  Passage() {
    for (Index i = 0; i < time.size(); ++i) {
      for (Index w = 0; w < 6; ++w) {
        position(i, w) = middle_of_tram(time(i)) + wheels(w);
        force(i, w) = loads(w) * (1 + shock(w, time(i)));
      }
      for (Index s = 0; s < sleepers.size(); ++s) {
        double u[4] = {0, 0, 0, 0};
        for (Index w = 0; w < 6; ++w) {
          const double d = sleepers(s) - position(i, w);
          u[0] += force(i, w) * winkler(d, 0.9) / 62e6;
          u[1] += force(i, w) * winkler(d, 1.05) / 88e6;
          u[2] += force(i, w) * winkler(d, 1.25) / 130e6;
          u[3] += force(i, w) * winkler(d, 1.0) * 0.31;
        }
        rail(i, s) = u[0], sleeper(i, s) = u[1], foundation(i, s) = u[2], reaction(i, s) = u[3];
      }
    }
  }
};

visu::Scene scene_of(const Passage& p) {
  visu::Scene scene;
  scene.name = "Tram over a rail joint";
  scene.time = p.time;
  scene.exaggeration = 200;
  scene.ground = -0.6;
  const auto frame = [&](const std::string& name, double x, double z, double radius, double weight) {
    visu::MovingFrame f{name, {}, visu::Pose{{0, 0, z}}};
    for (Index i = 0; i < p.time.size(); ++i) {
      double drop = 0, slope = 0;
      for (Index w = 0; w < 6; ++w) {
        const double d = x - wheels(w);
        const double g = weight * std::exp(-d * d / (radius > 0 ? 0.01 : 12));
        drop += g * p.force(i, w) / 62e6;
        slope += g * 1e-4 * shock(w, p.time(i)) * (d < 0 ? -1 : 1);
      }
      const double angle = radius > 0 ? 0 : slope;
      f.poses.push_back({{middle_of_tram(p.time(i)) + x, 0, z - drop},
                         Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()))});
    }
    scene.frames.push_back(f);
  };
  for (Index w = 0; w < 6; ++w) {
    const bool driven = w != 1 && w != 4;
    const double radius = driven ? 0.32 : 0.1875;
    const std::string name = fmt::format("wheelset {}", w + 1);
    frame(name, wheels(w), 0.16 + radius, radius, 1);
    for (const double y : {-0.75, 0.75})
      scene.items.push_back({.name = name,
                             .frame = name,
                             .shape = visu::Shape::wheel,
                             .size = {radius, 0.12, 0},
                             .colour = "#444444",
                             .offset = {{0, y, 0}}});
    scene.items.push_back({.name = "axle",
                           .frame = name,
                           .shape = visu::Shape::cylinder,
                           .size = {0.06, 1.5, 0},
                           .colour = "#666666"});
  }
  for (const int g : {-1, 0, 1}) {
    const std::string name = fmt::format("running gear {}", g + 2);
    frame(name, g * 7.86, 0.62, 0, 0.8);
    scene.items.push_back({.name = name, .frame = name, .size = {2.3, 1.2, 0.16}, .colour = "#cc8833"});
    for (const double x : {-0.5, 0.5})
      scene.links.push_back(
          {"secondary suspension",
           {name, {x, 0.5, 0.08}},
           {fmt::format("body {}", g + 2), {g * (7.86 - 6.9 * std::abs(g)) + x, 0.5, -0.95}},
           visu::LinkShape::spring,
           0.09});
  }
  frame("body 1", -6.9, 1.95, 0, 0.4);
  frame("body 2", 0, 1.95, 0, 0.4);
  frame("body 3", 6.9, 1.95, 0, 0.4);
  for (const auto& [name, length] : {std::pair("body 1", 8.8), {"body 2", 4.6}, {"body 3", 8.8}})
    scene.items.push_back(
        {.name = name, .frame = name, .size = {length, 2.3, 1.9}, .colour = "#7fa8cf", .opacity = 0.55});
  for (const double y : {-0.75, 0.75})
    scene.lines.push_back(
        {.name = "rail", .x = p.sleepers, .deflection = -p.rail, .y = y, .height = 0.08, .width = 0.14});
  scene.lines.push_back({.name = "sleepers",
                         .x = p.sleepers,
                         .deflection = -p.sleeper,
                         .height = -0.1,
                         .block = Eigen::Vector3d(0.25, 2.5, 0.2),
                         .colour = "#9a8f80"});
  scene.camera = {.target = {0, 0, 0.6}, .width = 30, .azimuth = -68, .elevation = 14, .follow = "body 2"};
  return scene;
}

void write_track(const std::filesystem::path& path, const Passage& p) {
  results::ResultFile file(path,
                           {.program = "synthetic tram",
                            .command = "synthetic --speed 30 --out <folder>",
                            .convention = "x forward, y left, z up; track displacements downward; SI units"});
  file.write_vector("/time", p.time, {"s", "time", "-"});
  file.write_matrix("/contact/force", p.force, {"N", "contact force", "compression positive"});
  file.write_matrix("/contact/position", p.position, {"m", "position", "x forward"});
  file.write_names("/contact/names",
                   {"front gear, driven", "front gear, trailing", "middle gear, front", "middle gear, rear",
                    "rear gear, trailing", "rear gear, driven"},
                   "wheelsets");
  const VectorXd losses{{0, 0, 2, 0, 0, 0}};
  file.write_vector("/contact/static", loads, {"N", "static load", "compression positive"});
  file.write_vector("/contact/loss_count", losses, {"1", "losses", "count"});
  file.write_vector("/contact/loss_time", VectorXd(0.011 * losses), {"s", "in total", "sum"});
  file.write_vector("/contact/longest_loss", VectorXd(0.0085 * losses), {"s", "longest", "duration"});
  file.write_text(
      "/vehicle/drawing",
      "<svg viewBox=\"0 0 100 20\"><title>Made-up tram</title><rect width=\"90\" height=\"9\"/></svg>",
      "drawing");
  file.write_text(
      "/vehicle/tables",
      visu::to_json(std::vector<visu::Table>{{{"part", "mass [t]"}, {{"bodies", "26"}}, "Made-up masses"}}),
      "tables");
  const VectorXd profile_x = VectorXd::LinSpaced(721, 0, 72);
  file.write_vector("/profile/x", profile_x, {"m", "places", "x forward"});
  file.write_vector("/profile/height", VectorXd(1e-3 * profile_x.array().sin()),
                    {"m", "made-up heights", "upward"});
  file.write_vector("/sleeper/x", p.sleepers, {"m", "sleepers", "x forward"});
  file.write_matrix("/rail/deflection", p.rail, {"m", "rail", "downward"});
  file.write_matrix("/sleeper/displacement", p.sleeper, {"m", "sleeper", "downward"});
  file.write_matrix("/foundation/displacement", p.foundation, {"m", "u_f", "downward"});
  file.write_matrix("/ballast/reaction", p.reaction, {"N", "ballast reaction", "compression positive"});
  MatrixXd acceleration(p.time.size(), 3);
  for (Index i = 0; i < p.time.size(); ++i)
    for (Index b = 0; b < 3; ++b) acceleration(i, b) = 1.5 * shock(4 - 2 * b, p.time(i));
  file.write_matrix("/vehicle/acceleration", acceleration, {"m/s2", "acceleration", "z up"});
  file.write_names("/vehicle/bodies", {"rear body", "centre body", "front body"}, "bodies");

  const VectorXd dissipated = 900 * p.time.array();
  const VectorXd potential = 300 * (3 * p.time.array()).sin();
  file.write_vector("/energy/kinetic", VectorXd(1.27e6 - potential.array() - 0.3 * dissipated.array()),
                    {"J", "-", "-"});
  file.write_vector("/energy/potential", potential, {"J", "-", "-"});
  file.write_vector("/energy/dissipated", dissipated, {"J", "-", "-"});
  file.write_vector("/energy/supplied", VectorXd(0.7 * dissipated.array() + 2 * p.time.array().sin()),
                    {"J", "-", "-"});

  file.write_text("/parameters",
                  visu::to_json({{"Vehicle", "body mass", 9000, "kg", "D: made up for this test"},
                                 {"Vehicle", "secondary stiffness", 0.96e6, "N/m", "M-l: made up"},
                                 {"Track", "sleeper spacing", 0.6, "m", "F: made up <&>"},
                                 {"Track", "ballast stiffness", 32e6, "N/m", "M-m: made up"}}),
                  "parameters");
  file.write_text(
      "/summary",
      json::Value(json::Value::Array{
                      json::object({{"name", "Train speed"}, {"value", speed * 3.6}, {"unit", "km/h"}}),
                      json::object({{"name", "Largest contact force"}, {"value", 113.1}, {"unit", "kN"}}),
                      json::object({{"name", "Largest rail deflection"}, {"value", 1.26}, {"unit", "mm"}})})
          .text(),
      "summary");
  file.write_text("/scene", visu::to_json(scene_of(p)), "scene");
  file.commit();
}

void write_ground(const std::filesystem::path& path, const Passage& p, bool has_semi_analytical) {
  const std::vector<double> distances = {2, 4, 8, 12, 16, 24, 32};
  const Index nr = Index(distances.size());
  const VectorXd time = VectorXd::LinSpaced(2001, 0, 8);
  MatrixXd x = MatrixXd::Zero(2001, nr), y = x, z = x, position(nr, 3), ppv(nr, 4);
  std::vector<std::string> names;
  VectorXd kb(nr), vdb(nr), centre(21);
  MatrixXd rms(nr, 21);
  for (Index f = 0; f < 21; ++f) centre(f) = 1000 * std::pow(10, double(f - 30) / 10);
  for (Index r = 0; r < nr; ++r) {
    const double d = distances[size_t(r)];
    names.push_back(fmt::format("{} m from the axis", d));
    position.row(r) << defect, d, 0;
    for (Index i = 0; i < time.size(); ++i)
      for (Index w = 0; w < 6; ++w) {
        const double since = time(i) - (defect - 6 - wheels(w)) / speed - d / 140;
        const double gain = 1.4e-3 * loads(w) / 70e3 / d * std::exp(-0.02 * d);
        if (since > 0) {
          z(i, r) += gain * std::exp(-since / 0.12) * std::sin(2 * std::numbers::pi * (28 - 0.3 * d) * since);
          x(i, r) += 0.6 * gain * std::exp(-since / 0.15) * std::sin(2 * std::numbers::pi * 19 * since);
          y(i, r) += 0.7 * gain * std::exp(-since / 0.14) * std::cos(2 * std::numbers::pi * 22 * since) *
                     since / 0.03 * std::exp(-since / 0.05);
        }
        const double s = speed * since / d;
        z(i, r) += 0.1 * gain * s * std::exp(-s * s);
      }
    ppv.row(r) << x.col(r).cwiseAbs().maxCoeff(), y.col(r).cwiseAbs().maxCoeff(),
        z.col(r).cwiseAbs().maxCoeff(),
        (x.col(r).array().square() + y.col(r).array().square() + z.col(r).array().square()).sqrt().maxCoeff();
    kb(r) = 1e3 * ppv(r, 2) / 2.6;
    vdb(r) = 20 * std::log10(ppv(r, 2) / 4 / 2.54e-8);
    for (Index f = 0; f < 21; ++f) {
      const double octaves = std::log2(centre(f) / (26 - 0.3 * d));
      rms(r, f) = centre(f) > 55
                      ? std::numeric_limits<double>::quiet_NaN()
                      : ppv(r, 2) / 5 * (std::exp(-octaves * octaves) + 0.02 / (1 + 0.05 * centre(f)));
    }
  }
  MatrixXd soil(time.size(), p.sleepers.size() - 20), semi_analytical = soil;
  for (Index i = 0; i < soil.rows(); ++i) {
    const Index row = std::min<Index>(p.time.size() - 1, Index(std::lround(time(i) / step)));
    semi_analytical.row(i) = p.foundation.row(row).middleCols(10, soil.cols());
    soil.row(i) = 0.92 * semi_analytical.row(i);
    if (i > 0) soil.row(i) = 0.85 * soil.row(i) + 0.15 * soil.row(i - 1);
  }
  VectorXd taper = VectorXd::Ones(soil.cols());
  for (Index j = 0; j < 13; ++j) taper(j) = taper(soil.cols() - 1 - j) = double(j) / 13;

  results::ResultFile file(path, {.program = "synthetic soil",
                                  .command = "synthetic-soil predict site.toml",
                                  .convention = "x along the track, y left, z up; SI units"});
  file.write_attribute("highest_frequency", 50.0);
  file.write_vector("/time", time, {"s", "time", "-"});
  file.write_matrix("/receivers/position", position, {"m", "receivers", "x y z"});
  file.write_names("/receivers/names", names, "receivers");
  file.write_matrix("/velocity/x", x, {"m/s", "velocity", "x"});
  file.write_matrix("/velocity/y", y, {"m/s", "velocity", "y"});
  file.write_matrix("/velocity/z", z, {"m/s", "velocity", "z up"});
  file.write_vector("/third_octave/centre", centre, {"Hz", "centres", "-"});
  file.write_matrix("/third_octave/rms", rms, {"m/s", "rms of v_z", "z"}, true);
  file.write_matrix("/indicators/ppv", ppv, {"m/s", "PPV", "x y z resultant"});
  file.write_vector("/indicators/kb_f_max", kb, {"1", "KB_Fmax", "z"});
  file.write_vector("/indicators/vdb", vdb, {"dB", "VdB", "z"});
  file.write_vector("/footprint/x", p.sleepers.segment(10, soil.cols()), {"m", "footprints", "x"});
  file.write_matrix("/footprint/displacement", soil, {"m", "mean displacement", "downward"});
  file.write_vector("/footprint/taper", taper, {"1", "taper", "-"});
  if (has_semi_analytical) {
    file.write_vector("/semi_analytical/time", time, {"s", "time", "-"});
    for (const auto& [axis, v] : {std::pair("x", &x), {"y", &y}, {"z", &z}})
      file.write_matrix(fmt::format("/semi_analytical/velocity/{}", axis), *v, {"m/s", "velocity", axis});
    file.write_matrix("/semi_analytical/footprint_displacement", semi_analytical,
                      {"m", "mean displacement", "downward"});
  }
  file.write_text("/parameters",
                  visu::to_json({{"Layer 1", "shear wave speed", 150, "m/s", "made up"},
                                 {"Layer 1", "density", 1800, "kg/m3", "made up"},
                                 {"Mesh", "time step", 1.3e-4, "s", "stability"}}),
                  "parameters");
  file.write_text("/site", "name = \"made up\"\n\n[[layer]]\ncs = 150  # <m/s>\n", "site file");
  file.commit();
}

}  // namespace

void write_synthetic_results(const std::filesystem::path& folder, bool has_semi_analytical) {
  const Passage passage;
  write_track(folder / "results.h5", passage);
  write_ground(folder / "vibrations.h5", passage, has_semi_analytical);
}

}  // namespace easydyn::testing

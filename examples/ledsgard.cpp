// Ledsgard: the X2000 on soft clay, its embankment as a beam on springs, beside what was measured.
//
//      Q1 Q2      Q3 Q4        ...            Q19 Q20      20 axle loads, 2740 kN over 108 m
//       v  v       v  v                        v   v       --> v
//   ===================================================    embankment and track: beam, EI = 200 MN m2, 10 800 kg/m
//    >  >  >  >  >  >  >  >  >  >  >  >  >  >  >  >  >     bedding k per length, from the soft organic clay
//   ///////////////////////////////////////////////////
//
// Shows: moving loads; a track made of a beam and a bedding alone; where such a foundation ends. At 70 km/h the ground
// gives way almost as under a load at rest, and a bedding tuned to the clay is enough. At 185 km/h the train outruns the
// waves of the clay; springs side by side have no waves, and the large upward swing that was measured is missing.
// Run: ./run ledsgard
// Prints: organic clay, shear modulus 2.12 MPa: bedding 7.79 MN/m2, critical speed of the beam 308 km/h
// Prints: width 3.0 m: -8.23 mm at 70 km/h
// Prints: 70 km/h: minimum -6.41 mm, measured -6.37 mm; inside the band of tuned soils, -8 to -5 mm
// Prints: 185 km/h: minimum -6.85 mm, measured -10.86 mm; maximum 1.11 mm, measured 6.50 mm
// Prints: 185 km/h on 4.8 MN/m2: minimum -10.83 mm, maximum 2.44 mm
// Prints: wrote ledsgard.html
// Reference: C. Madshus, A. M. Kaynia, High-speed railway lines on soft ground: dynamic behaviour at critical train
// speed, J. Sound Vib. 231(3), 2000, doi:10.1006/jsvi.1999.2647.

#include <fmt/format.h>

#include <iostream>

#include "easydyn/easydyn.hpp"
#include "easydyn/visu/report.hpp"
#include "track/critical_speed.hpp"
#include "track/moving_load.hpp"
#include "track/passage.hpp"
#include "vehicles/moving_loads.hpp"

using namespace easydyn;
using namespace easydyn::units;

// 1. Data, with marks as in easydyn/parameter.hpp.
constexpr double EI = 200 * MN * m * m, mass = 10800 * kg / m;  // M-m: Kaynia et al. 2000
constexpr double clay_density = 1260 * kg / (m * m * m),
                 clay_cs = 41 * m / s;                         // M-m: the same, organic clay at 70 km/h
constexpr double tuned_width = 6.7 * m, damping_ratio = 0.05;  // assumed; the width is what is tuned
constexpr double softened = 4.8 * MN / (m * m);                // fitted to the measured minimum at 185 km/h
constexpr double spacing = 0.5 * m;  // of the springs, 1/6 of the beam's length 1/lambda
constexpr double measured_70 = -6.37, measured_185 = -10.86,
                 measured_185_up = 6.50;         // F: FreqTrack repository [mm]
constexpr double band_low = -8, band_high = -5;  // M-l: predictions with tuned soil at 70 km/h, recalled [mm]

const std::vector<std::string> assumptions = {
    "The train is its 20 axle loads: no mass, no suspension, a perfect rail.",
    "Embankment and track are one beam; its data are recalled from Kaynia et al. 2000 (M-m).",
    "The ground is independent springs of Vesic's bedding for a beam on a half-space, here of the softest "
    "layer alone, the organic clay of Kaynia et al. 2000 (M-m): 1260 kg/m3, 41 m/s, saturated, Poisson's "
    "ratio 1/2. The crust and the stiffer clay below are left out.",
    "The width that rests on the clay, 6.7 m, is tuned: the minimum at 70 km/h is a fit, not a prediction. "
    "The table shows other widths.",
    "Damping is 5 % of the beam's critical damping (assumed).",
    "The band of predictions with tuned soil at 70 km/h, -8 to -5 mm, is recalled (M-l), not read: it says "
    "no more than that such predictions come within about a quarter of the measurement."};

/// Bedding of a beam on an elastic half-space: k = 0.65 (E B^4 / EI)^(1/12) E / (1 - nu^2) [N/m2] (Vesic 1961, M-h).
double vesic_bedding(double E, double nu, double B) {
  return 0.65 * std::pow(E * std::pow(B, 4) / EI, 1.0 / 12) * E / (1 - nu * nu);
}

/// Beam and bedding alone: pads and ballast are next to rigid, sleepers next to massless.
track::TrackData embankment(double k) {
  track::TrackData data;
  data.name = "Ledsgard embankment";
  data.rail = {.name = "embankment",
               .inertia = 1,  // E I = E times 1 m4
               .mass_per_length = mass,
               .youngs_modulus = EI,
               .source = "M-m: Kaynia et al. 2000"};
  data.rails = 1;
  data.sleeper_spacing = spacing;
  data.pad_stiffness = data.ballast_stiffness = 1e4 * k * spacing;
  data.sleeper_mass = 1e-3;
  data.foundation = track::Winkler{k * spacing, 2 * damping_ratio * std::sqrt(k * mass) * spacing};
  data.footprint_length = spacing;
  data.footprint_width = tuned_width;
  data.elements_per_bay = 1;
  data.ends.bays = 0;  // no wave comes so far
  return data;
}

class Train : public System {
 public:
  Train(double k, double v)
      : System("X2000 at Ledsgard"), beam(*this, track::TrackModel(embankment(k), 640, -160)), speed(v) {
    for (const auto& axle : axles) loads.emplace_back(axle.name, axle.load);
  }
  std::vector<vehicles::MovingLoad> axles = vehicles::x2000_ledsgard().loads;
  track::FlexibleTrack beam;
  double speed, way = 160 * m;  // from 26 m before the place of measurement to 26 m behind it
  std::deque<track::MovingLoad> loads;

  double x(double time) const { return -way / 2 + speed * time; }  // of the train's middle
  void positions() override {}
  void forces() override {
    for (std::size_t i = 0; i < loads.size(); ++i)
      loads[i].apply(x(time().value()) + axles[i].x, speed, beam, energy());
  }
};

// 2. A passage; 120 m of the beam with the place of measurement in the middle.
track::Passage pass(Train& train) {
  std::vector<const track::TrackContact*> contacts;
  for (const track::MovingLoad& load : train.loads) contacts.push_back(&load);
  return track::compute_passage(train, train.beam, contacts,
                                {.duration = train.way / train.speed,
                                 .step = 0.02 * m / train.speed,
                                 .output_step = 0.2 * m / train.speed,
                                 .first_sleeper_x = -60,
                                 .last_sleeper_x = 60});
}
Eigen::VectorXd upward(const track::Passage& p) {
  return -p.rail_deflection.col(p.sleeper_x.size() / 2) / mm;
}

// 3. Pictures: history with what was measured, and the beam under the loads.
visu::Chart chart(const std::string& title, const track::Passage& p, const std::vector<double>& measured) {
  visu::Chart c{
      title, {"time", "s"}, {"displacement, upward", "mm"}, {{"beam on springs", p.time, upward(p)}}};
  for (const double u : measured)
    c.series.push_back({fmt::format("measured {}", u < 0 ? "minimum" : "maximum"), p.time,
                        Eigen::VectorXd::Constant(p.time.size(), u), visu::Stroke::dashed});
  return c;
}
visu::Scene draw(const Train& train, const track::Passage& p) {
  visu::Scene scene;
  scene.name = "X2000 at Ledsgard";
  scene.time = p.time;
  scene.exaggeration = 300;
  scene.lines.push_back(
      {.name = "embankment", .x = p.sleeper_x, .deflection = -p.rail_deflection, .width = 0.6});
  for (const auto& axle : train.axles) {
    visu::MovingFrame frame{axle.name, {}};
    for (const double time : p.time) frame.poses.push_back({{train.x(time) + axle.x, 0, 3}});
    scene.frames.push_back(frame);
    scene.items.push_back({axle.name, axle.name, visu::Shape::box, {0.6, 2, axle.load / (60 * kN)}});
  }
  scene.camera = {.target = {0, 0, 1}, .width = 130, .azimuth = -90, .elevation = 8};
  return scene;
}

int main() try {
  const double G = clay_density * clay_cs * clay_cs, E = 3 * G;
  const double k = vesic_bedding(E, 0.5, tuned_width);
  fmt::print(
      "organic clay, shear modulus {:.2f} MPa: bedding {:.2f} MN/m2, critical speed of the beam {:.0f} "
      "km/h\n",
      G / MPa, k / MN, track::compute_critical_speed(embankment(k)).speed / (km / h));

  // 4. Both speeds; at 70 km/h other widths as well.
  visu::Table widths{{"width [m]", "bedding [MN/m2]", "minimum at 70 km/h [mm]"}, {}};
  for (const double B : {3.0, 5.0, tuned_width, 8.0}) {
    Train train(vesic_bedding(E, 0.5, B), 70 * km / h);
    const double least = upward(pass(train)).minCoeff();
    fmt::print("width {:.1f} m: {:.2f} mm at 70 km/h\n", B, least);
    widths.rows.push_back({fmt::format("{:.1f}", B), fmt::format("{:.2f}", vesic_bedding(E, 0.5, B) / MN),
                           fmt::format("{:.2f}", least)});
  }
  Train slow(k, 70 * km / h), fast(k, 185 * km / h);
  const track::Passage at_70 = pass(slow), at_185 = pass(fast);
  const double low_70 = upward(at_70).minCoeff(), low_185 = upward(at_185).minCoeff(),
               high_185 = upward(at_185).maxCoeff();
  const char* const place = band_low <= low_70 && low_70 <= band_high ? "inside" : "outside";
  fmt::print(" 70 km/h: minimum {:.2f} mm, measured {:.2f} mm; {} the band of tuned soils, {:g} to {:g} mm\n",
             low_70, measured_70, place, band_low, band_high);
  Train soft(softened, 185 * km / h);
  const Eigen::VectorXd u_soft = upward(pass(soft));
  fmt::print("185 km/h: minimum {:.2f} mm, measured {:.2f} mm; maximum {:.2f} mm, measured {:.2f} mm\n",
             low_185, measured_185, high_185, measured_185_up);

  fmt::print("185 km/h on {:g} MN/m2: minimum {:.2f} mm, maximum {:.2f} mm\n", softened / MN,
             u_soft.minCoeff(), u_soft.maxCoeff());

  // 5. Report.
  visu::Report report("Ledsgard", "the X2000 on soft clay: a beam on springs beside what was measured");
  report
      .add_key_figures({{"minimum at 70 km/h", fmt::format("{:.2f}", low_70), "mm",
                         fmt::format("measured {:.2f} mm; {} the band {:g} to {:g} mm", measured_70, place,
                                     band_low, band_high)},
                        {"minimum at 185 km/h", fmt::format("{:.2f}", low_185), "mm",
                         fmt::format("measured {:.2f} mm", measured_185)},
                        {"maximum at 185 km/h", fmt::format("{:.2f}", high_185), "mm",
                         fmt::format("measured {:.2f} mm", measured_185_up)}})
      .add_charts({chart("70 km/h", at_70, {measured_70}),
                   chart("185 km/h", at_185, {measured_185, measured_185_up})})
      .add_animation(draw(slow, at_70), "70 km/h; the height of a block is its axle load")
      .add_note(fmt::format("185 km/h is beyond this foundation. A Rayleigh wave in the organic clay runs at "
                            "about {:.0f} km/h: the "
                            "train outruns it, and the literature has the waves that it drags along lift the "
                            "embankment (recalled, "
                            "M-h; they are not computed here). Springs side by side do not know of each "
                            "other and carry no wave; the "
                            "beam on them would meet its own critical speed at {:.0f} km/h only. Softened to "
                            "{:g} MN/m2, so that the "
                            "minimum agrees, the bedding "
                            "lifts the beam by {:.1f} mm.",
                            0.955 * clay_cs / (km / h),
                            track::compute_critical_speed(embankment(k)).speed / (km / h), softened / MN,
                            u_soft.maxCoeff()));
  report.add_section("Assumptions").add_list(assumptions);
  report.add_subsection("Width on the clay").add_table(widths);
  report.add_subsection("Axle loads").add_parameters(parameters(vehicles::x2000_ledsgard()));
  report.write("ledsgard.html");
  fmt::print("wrote ledsgard.html\n");
} catch (const std::exception& e) {
  std::cerr << "ledsgard: " << e.what() << "\n";
  return 1;
}

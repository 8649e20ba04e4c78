// A tram over a rail joint: contact forces, track motion and the load on the ground (step 1 of a prediction).
//
//      rear body         centre body        front body
//   [===========]o[====================]o[===========]     --> v
//     O  o              O    O              o  O
//   ========================================|~~~~~~~~~~     rail, step of 1 mm at x = 0
//    |pad |    |    |    |    |    |    |    |    |         pads, sleepers, ballast
//   (m_f)~(m_f)~(m_f)~(m_f)~ ...                            coupled lumped mass (CLM) foundation
//
// Shows: a vehicle from its data sheet, built into a multibody system with a flexible track; nonlinear
// contact; a smooth start in the quasi-static motion; the ballast reactions handed to the program `soil`.
// `./run tram` goes on with the ground and the report.
// Run: ./run tram
// Prints: vehicle weight                                            358.1 kN
// Prints: static sum of the ballast reactions / weight                  1
// Prints: largest ballast reaction                                  53.58 kN
// Reference: G. Kouroussis, O. Verlinden, Prediction of railway ground vibrations: accuracy of a coupled
// lumped mass model for representing the track/soil interaction, Soil Dyn. Earthq. Eng. 69, 2015.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <iostream>

#include "easydyn/easydyn.hpp"
#include "easydyn/results/progress.hpp"
#include "easydyn/visu/scene.hpp"
#include "soil/surface_loads.hpp"
#include "track/passage.hpp"
#include "track/passage_files.hpp"
#include "track/track_scene.hpp"
#include "track/wheel_rail_contact.hpp"
#include "vehicles/planar_vehicle.hpp"
#include "vehicles/t2000_like.hpp"
#include "vehicles/vehicle_drawing.hpp"
#include "vehicles/vehicle_modes.hpp"
#include "vehicles/vehicle_scene.hpp"
#include "vehicles/vehicle_tables.hpp"

using namespace easydyn;
using namespace easydyn::units;

namespace {

struct Options {
  double speed = 30;        // [km/h]
  double step_height = 1;   // [mm]
  double time_step = 1e-4;  // [s]
  std::string foundation = "clm";
  std::filesystem::path output = "results/tram";
};

// The multibody system: the tram, the track and a contact under every wheel pair.
class TramOnTrack : public System {
 public:
  TramOnTrack(const track::TrackModel& track_model, double x0, double speed,
              const std::shared_ptr<const track::Profile>& profile)
      : System("tram on track"), track(*this, track_model), x0_(x0), speed_(speed) {
    for (const vehicles::PlanarVehicle::Wheel& w : tram.wheels())
      contacts.emplace_back(w.name, track::HertzContact(1e11, w.contacts), w.radius, w.static_load, profile);
  }

  vehicles::PlanarVehicle tram{*this, vehicles::t2000_like()};
  track::FlexibleTrack track;
  std::vector<track::WheelRailContact> contacts;

 protected:
  void positions() override { tram.place(x0_ + speed_ * time()); }
  void forces() override {
    gravity(vehicles::gravity);
    tram.apply_suspensions();
    for (std::size_t w = 0; w < contacts.size(); ++w) contacts[w].apply(*tram.wheels()[w].body, track);
  }

 private:
  double x0_, speed_;
};

// The foundation asked for; the simpler ones keep the constants of the CLM and drop what they do not have.
track::Foundation choose_foundation(const std::string& name, const track::Foundation& bundled) {
  if (name == "rigid") return track::RigidGround{};
  if (name == "clm") return bundled;
  track::Clm c = track::as_clm(bundled);
  for (Sourced* constant : {&c.m_f, &c.k_f, &c.d_f})
    constant->source = "as in the fitted CLM, its coupling dropped: not a fit of its own";
  if (name == "winkler") return track::Winkler{c.k_f, c.d_f};
  return track::WinklerMass{c.m_f, c.k_f, c.d_f};
}

// Tram and track as an animated scene, at about 25 pictures per second of a slow-motion replay.
visu::Scene make_scene(const track::Passage& passage, const TramOnTrack& system, double x0, double v) {
  std::vector<Eigen::Index> rows;
  const Eigen::Index every = std::max<Eigen::Index>(1, passage.time.size() / 500);
  for (Eigen::Index i = 0; i < passage.time.size(); i += every) rows.push_back(i);

  vehicles::VehicleMotion motion;
  motion.bodies = passage.body_names;
  motion.time = passage.time(rows);
  motion.origin_x = x0 + v * motion.time.array();
  motion.height = passage.body_height(rows, Eigen::all);
  motion.pitch = passage.body_pitch(rows, Eigen::all);

  visu::Scene scene;
  scene.name = "Tram on the deflecting track";
  scene.exaggeration = 100;
  vehicles::add_vehicle(scene, system.tram.data(), motion);
  track::add_track(scene, passage, system.track.model().data(), rows);
  scene.ground = -0.35;
  scene.camera = {.target = {0, 0, 1}, .width = 26, .azimuth = -70, .elevation = 12, .follow = "centre body"};
  return scene;
}

int run(const Options& options, const std::string& command) {
  // 1. Data: tram, track, foundation, and where everything is.
  const double v = options.speed * km / h;
  track::TrackData data = track::t2000_like_track();
  data.foundation = choose_foundation(options.foundation, data.foundation);
  const double loaded = 14 * m;     // the ground is loaded from -14 m to 14 m about the joint
  const double approach = 1.8 * m;  // of the first wheel to the loaded part, and of the last one away from it
  const double margin = 10 * m;     // of track beyond the wheels, before its absorbing ends

  // The sleepers are centred between the bays about the joint, so that x = 0 is mid-span.
  const vehicles::RailVehicle vehicle = vehicles::t2000_like();
  double reach = 0;           // farthest wheel from the origin of the tram
  double largest_radius = 0;  // of the wheel that smooths the profile most
  for (const auto& gear : vehicle.gears)
    for (const auto& pair : gear.wheel_pairs) {
      reach = std::max(reach, std::abs(pair.x));
      largest_radius = std::max(largest_radius, pair.radius.value);
    }
  const double spacing = data.sleeper_spacing;
  const double x0 = -(loaded + approach + reach);
  const int half_bays = static_cast<int>(std::ceil((-x0 + reach + margin) / spacing)) + data.ends.bays;
  const track::TrackModel track_model(data, 2 * half_bays + 1, -(half_bays + 0.5) * spacing);
  const auto profile = std::make_shared<track::StepProfile>(0, options.step_height * mm);

  // 2. The system, 3. its passage.
  TramOnTrack system(track_model, x0, v, profile);
  std::vector<const track::TrackContact*> contacts;
  for (const auto& c : system.contacts) contacts.push_back(&c);
  track::PassageOptions passage_options;
  passage_options.duration = -2 * x0 / v;
  passage_options.step = options.time_step;
  passage_options.output_step = std::max(1.0, std::round(5e-4 / options.time_step)) * options.time_step;
  passage_options.first_sleeper_x = x0 - reach;  // recorded wherever a wheel stands
  passage_options.last_sleeper_x = -passage_options.first_sleeper_x;
  const std::string description =
      fmt::format("{} at {:g} km/h over a rail step of {:g} mm on {}, foundation {}", vehicle.label(),
                  options.speed, options.step_height, data.label(), track::kind_of(data.foundation));
  fmt::print("tram: {}\n", description);
  if (options.output.empty()) throw InputError("--output is empty, must name a folder");
  std::filesystem::create_directories(options.output);  // before the work, in case it cannot be
  for (const std::string& unusual : vehicles::unusual_values(vehicle))
    fmt::print("tram: warning: {}\n", unusual);
  fmt::print("tram: {} bays of track, {} coordinates, {:.2f} s in steps of {} s\n", track_model.bays(),
             system.size(), passage_options.duration, options.time_step);
  results::Progress progress("passage");
  const track::Passage passage = track::compute_passage(system, system.track, contacts, passage_options,
                                                        [&](double fraction) { progress.update(fraction); });
  progress.finish();

  // 4. What came out.
  const double weight = system.tram.weight();
  double peak_ratio = 0;
  for (std::size_t w = 0; w < system.contacts.size(); ++w)
    peak_ratio = std::max(peak_ratio, passage.largest_contact_force[static_cast<Eigen::Index>(w)] /
                                          system.contacts[w].static_load());
  const Eigen::VectorXd energy =
      passage.kinetic_energy + passage.potential_energy + passage.dissipated_energy - passage.supplied_energy;
  const double energy_imbalance =
      (energy.array() - energy[0]).abs().maxCoeff() / passage.supplied_energy.cwiseAbs().maxCoeff();
  const std::vector<track::SummaryFigure> summary = {
      {"vehicle weight", weight / kN, "kN"},
      {"static sum of the ballast reactions / weight", passage.static_ballast_reaction / weight, ""},
      {"largest contact force", passage.largest_contact_force.maxCoeff() / kN, "kN"},
      {"largest dynamic load factor of a wheel pair", peak_ratio, ""},
      {"largest rail deflection", passage.rail_deflection.maxCoeff() / mm, "mm"},
      {"largest ballast reaction", passage.ballast_reaction.maxCoeff() / kN, "kN"},
      {"smallest ballast reaction", passage.ballast_reaction.minCoeff() / kN, "kN"},
      {"losses of contact", double(passage.contact_losses.sum()), ""},
      {"longest loss of contact of a wheel pair", passage.longest_contact_loss.maxCoeff() / ms, "ms"},
      {"energy imbalance / work supplied", energy_imbalance, ""},
  };
  for (const auto& figure : summary)
    fmt::print("  {:<52} {:10.4g} {}\n", figure.name, figure.value, figure.unit);

  for (const std::string& warning : passage.warnings) fmt::print("tram: warning: {}\n", warning);

  // 5. Files.
  std::vector<Parameter> parameters = vehicles::parameters(vehicle);
  for (const Parameter& p : track::parameters(data)) parameters.push_back(p);
  for (const Parameter& p : std::vector<Parameter>{
           {"run", "speed", v, "m/s", "option --speed"},
           {"run", "height of the rail step", options.step_height * mm, "m", "option --step-height"},
           {"run", "time step", options.time_step, "s", "option --time-step"},
           {"run", "Hertz constant of one wheel", 1e11, "N/m^1.5", "F: railFE"},
           {"run", "acceleration of gravity", vehicles::gravity, "m/s2", "conventional"}})
    parameters.push_back(p);

  const results::Provenance provenance{
      .program = "tram",
      .command = command,
      .convention =
          "x along the track, y left, z up; track displacements and ground loads positive downward"};
  track::write_passage(options.output / "results.h5", passage,
                       {.description = description,
                        .parameters = parameters,
                        .summary = summary,
                        .scene = make_scene(passage, system, x0, v),
                        .drawing = vehicles::draw_vehicle(vehicle),
                        .tables = {vehicles::axle_load_table(vehicle, vehicles::compute_axle_loads(vehicle)),
                                   vehicles::mass_balance_table(vehicle),
                                   vehicles::mode_table(vehicles::compute_vehicle_modes(vehicle))},
                        .profile = track::sample_profile(*profile, largest_radius, -1, 1, 1e-3)},
                       provenance);
  track::write_passage_channels(options.output / "channels.csv", passage, 0);

  soil::SurfaceLoads loads;
  loads.time = passage.time;
  std::vector<Eigen::Index> handed_over;
  for (Eigen::Index j = 0; j < passage.sleeper_x.size(); ++j) {
    if (std::abs(passage.sleeper_x[j]) > loaded) continue;
    handed_over.push_back(j);
    loads.footprints.push_back(
        {.x = passage.sleeper_x[j], .y = 0, .length = data.footprint_length, .width = data.footprint_width});
  }
  loads.force = passage.ballast_reaction(Eigen::all, handed_over);
  soil::write_surface_loads(options.output / "surface_loads.h5", loads, provenance);
  fmt::print("tram: wrote results.h5, surface_loads.h5 and channels.csv to {}\n", options.output.string());
  return 0;
}

// Refuses what is not a number from `least` to `most`; NaN is none.
CLI::Validator in_range(double least, double most) {
  return CLI::Validator(
      [=](std::string& text) {
        double value = 0;
        const char* const last = text.data() + text.size();
        const auto [end, error] = std::from_chars(text.data(), last, value);
        if (error == std::errc() && end == last && value >= least && value <= most) return std::string();
        return fmt::format("{}, must be a number from {:g} to {:g}", text, least, most);
      },
      "");
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{"A tram over a rail joint: contact forces, track motion and the load on the ground."};
  app.add_option("--speed", options.speed, "speed, 1 to 120 [km/h]")
      ->capture_default_str()
      ->check(in_range(1, 120));
  app.add_option("--step-height", options.step_height,
                 "height of the rail step, up > 0, down < 0, -20 to 20 [mm]")
      ->capture_default_str()
      ->check(in_range(-20, 20));
  app.add_option("--foundation", options.foundation, "what the ballast rests on")
      ->capture_default_str()
      ->check(CLI::IsMember({"rigid", "winkler", "winkler-mass", "clm"}));
  app.add_option("--time-step", options.time_step, "of Newmark's method, 1e-6 to 1e-3 [s]")
      ->capture_default_str()
      ->check(in_range(1e-6, 1e-3));
  app.add_option("--output", options.output, "folder of the results")->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  try {
    return run(options, results::join_command_line(argc, argv));
  } catch (const std::exception& e) {
    std::cerr << "tram: " << e.what() << "\n";
    return 1;
  }
}

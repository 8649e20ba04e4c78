// One passage of a program: what it prints and writes.

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "easydyn/results/progress.hpp"
#include "easydyn/visu/scene.hpp"
#include "examples/passage_program/passage_run.hpp"
#include "soil/surface_loads.hpp"
#include "track/irregularity.hpp"
#include "track/track_scene.hpp"
#include "vehicles/axle_loads.hpp"
#include "vehicles/vehicle_drawing.hpp"
#include "vehicles/vehicle_modes.hpp"
#include "vehicles/vehicle_tables.hpp"

namespace easydyn::examples {

namespace {

using namespace easydyn::units;
namespace fs = std::filesystem;

/// Train and track as an animated scene, at about 25 pictures per second of a slow-motion replay.
visu::Scene make_scene(const PassageProgram& program, const PassageRun& run) {
  const track::Passage& passage = run.passage;
  std::vector<Eigen::Index> rows;
  const Eigen::Index every = std::max<Eigen::Index>(1, passage.time.size() / 400);
  for (Eigen::Index i = 0; i < passage.time.size(); i += every) rows.push_back(i);

  vehicles::VehicleMotion motion;
  motion.bodies = passage.body_names;
  motion.time = passage.time(rows);
  motion.origin_x = run.course.start + run.speed * motion.time.array();
  motion.height = passage.body_height(rows, Eigen::all);
  motion.pitch = passage.body_pitch(rows, Eigen::all);

  visu::Scene scene;
  scene.name = program.title;
  scene.exaggeration = 100;
  vehicles::add_vehicle(scene, program.vehicle, motion, program.heights);
  track::add_track(scene, passage, run.data, rows);
  scene.ground = -0.35;
  scene.camera = {.target = {0, 0, 1},
                  .width = program.picture_width,
                  .azimuth = -70,
                  .elevation = 12,
                  .follow = program.followed};
  return scene;
}

std::vector<Parameter> list_parameters(const PassageProgram& program, const PassageProgramOptions& options,
                                       const PassageRun& run, const std::optional<SiteOfRun>& site) {
  std::vector<Parameter> parameters = vehicles::parameters(program.vehicle);
  for (const Parameter& p : track::parameters(run.data)) parameters.push_back(p);
  for (const Parameter& p : std::vector<Parameter>{
           {"run", "speed", run.speed, "m/s", "option --speed"},
           {"run", "height of the rail step", options.step_height * mm, "m", "option --step-height"},
           {"run", "time step", options.time_step, "s", "option --time-step"},
           {"run", "length of the window", run.passage_options.window, "m", "wheels and margins"},
           {"run", "Hertz constant of one wheel", TrainOnTrack::hertz_constant, "N/m^1.5", "F: railFE"},
           {"run", "acceleration of gravity", vehicles::gravity, "m/s2", "conventional"}})
    parameters.push_back(p);
  if (options.irregularity != "none")
    parameters.push_back({"run", "seed of the irregularity " + options.irregularity, double(options.seed),
                          "1", track::irregularity_spectrum(options.irregularity).source()});
  parameters.push_back({"run", "way driven before the recording", run.course.run_in, "m", "choice"});
  parameters.push_back({"run", "half length of the loaded ground", options.loaded, "m", "option --loaded"});
  if (site)
    for (const Parameter& p : parameters_of(*site)) parameters.push_back(p);
  if (options.wheel_flat > 0)
    parameters.push_back({"run", "length of the flat on every wheel pair", options.wheel_flat * mm, "m",
                          "option --wheel-flat, rounded"});
  return parameters;
}

std::string describe(const PassageProgram& program, const PassageProgramOptions& options,
                     const PassageRun& run) {
  std::string excitation;
  const auto add = [&](const std::string& text) { excitation += (excitation.empty() ? "" : ", ") + text; };
  if (options.step_height != 0) add(fmt::format("a rail step of {:g} mm", options.step_height));
  if (options.irregularity != "none")
    add(fmt::format("irregularity {}, seed {}", options.irregularity, options.seed));
  if (!options.profile.empty()) add("the profile " + options.profile.filename().string());
  if (options.wheel_flat > 0) add(fmt::format("flats of {:g} mm", options.wheel_flat));
  const std::string detail = options.detail == "full" ? "" : ", in the detail \"" + options.detail + "\"";
  return fmt::format("{}{} at {:g} km/h over {} on {}, foundation {}", program.vehicle.label(), detail,
                     run.speed / (km / h), excitation.empty() ? "a perfect rail" : excitation,
                     run.data.label(), track::kind_of(run.data.foundation));
}

std::vector<visu::Table> tabulate(const vehicles::RailVehicle& vehicle) {
  return {vehicles::axle_load_table(vehicle, vehicles::compute_axle_loads(vehicle)),
          vehicles::mass_balance_table(vehicle),
          vehicles::mode_table(vehicles::compute_vehicle_modes(vehicle))};
}

/// The rail under the train while it is recorded; near the joint alone where the rest is smooth.
std::optional<track::ProfileSamples> sample_profile(const PassageProgram& program, const PassageRun& run,
                                                    const PassageProgramOptions& options) {
  double radius = 0;  // of the wheel that smooths most
  for (const auto& gear : program.vehicle.gears)
    for (const auto& pair : gear.wheel_pairs) radius = std::max(radius, pair.radius.value);
  if (run.is_rough) {
    const double end = run.course.stop + run.course.reach;
    return track::sample_profile(*run.profile, radius, -end, end, 2 * cm);
  }
  if (options.step_height == 0) return std::nullopt;
  return track::sample_profile(*run.profile, radius, -1 * m, 1 * m, 1 * mm);
}

}  // namespace

int run_passage(const PassageProgram& program, const PassageProgramOptions& options,
                const std::optional<SiteOfRun>& site, const std::string& command) {
  PassageRun run(program, options, options.speeds.front() * km / h);
  const std::string description = describe(program, options, run);
  fmt::print("{}: {}\n", program.name, description);
  fs::create_directories(options.output);  // before the work, in case it cannot be
  if (site) fmt::print("{}: {}\n", program.name, describe(*site));
  std::vector<std::string> warnings = vehicles::unusual_values(program.vehicle);
  if (site)
    for (const std::string& warning : warn_of(*site)) warnings.push_back(warning);
  for (const std::string& warning : run.warn()) warnings.push_back(warning);
  for (const std::string& warning : warnings) fmt::print("{}: warning: {}\n", program.name, warning);
  fmt::print(
      "{}: {} bays of track, {:.0f} m of them at a time, {} coordinates of bodies, {:.2f} s in steps of {} "
      "s\n",
      program.name, run.system->track.model().bays(), run.passage_options.window, run.system->body_size(),
      run.passage_options.run_in + run.passage_options.duration, options.time_step);
  results::Progress progress("passage");
  run.compute([&](double fraction) { progress.update(fraction); });
  progress.finish();

  std::vector<track::SummaryFigure> summary = run.summarise();
  if (run.critical_speed > 0)
    summary.push_back({"critical speed of the track on this ground", run.critical_speed / (km / h), "km/h"});
  for (const auto& figure : summary)
    fmt::print("  {:<52} {:10.4g} {}\n", figure.name, figure.value, figure.unit);
  for (const std::string& warning : run.passage.warnings)
    fmt::print("{}: warning: {}\n", program.name, warning);
  for (const std::string& warning : warnings) run.passage.warnings.push_back(warning);

  // Files.
  const results::Provenance provenance{
      .program = program.name,
      .command = command,
      .convention =
          "x along the track, y left, z up; track displacements and ground loads positive downward"};
  track::PassageReport report{.description = description,
                              .parameters = list_parameters(program, options, run, site),
                              .summary = summary,
                              .drawing = vehicles::draw_vehicle(program.vehicle),
                              .tables = tabulate(program.vehicle),
                              .static_loads = run.static_loads(),
                              .profile = sample_profile(program, run, options)};
  report.free_wave = track::compute_free_track_wave(run.data);
  if (site) {
    if (options.foundation == "clm") report.foundation_fit = site->foundation->clm.fit;
    report.load_speed = site->response.speed;
    report.load_deflection = site->response.deflection;
    report.critical_speed = run.critical_speed;
  }
  if (options.detail == "full") report.scene = make_scene(program, run);
  track::write_passage(options.output / "results.h5", run.passage, report, provenance);
  track::write_passage_channels(options.output / "channels.csv", run.passage, 0);

  soil::SurfaceLoads loads;
  loads.time = run.passage.time;
  std::vector<Eigen::Index> handed_over;
  for (Eigen::Index j = 0; j < run.passage.sleeper_x.size(); ++j) {
    if (std::abs(run.passage.sleeper_x[j]) > options.loaded) continue;
    handed_over.push_back(j);
    loads.footprints.push_back({.x = run.passage.sleeper_x[j],
                                .y = 0,
                                .length = run.data.footprint_length,
                                .width = run.data.footprint_width});
  }
  loads.force = run.passage.ballast_reaction(Eigen::all, handed_over);
  soil::write_surface_loads(options.output / "surface_loads.h5", loads, provenance);
  fmt::print("{}: wrote results.h5, surface_loads.h5 and channels.csv to {}\n", program.name,
             options.output.string());
  return 0;
}

}  // namespace easydyn::examples

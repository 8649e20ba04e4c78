#include "examples/passage_program/passage_program.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <charconv>
#include <cmath>
#include <iostream>
#include <mutex>
#include <optional>
#include <thread>

#include "easydyn/results/progress.hpp"
#include "easydyn/visu/report.hpp"
#include "easydyn/visu/scene.hpp"
#include "examples/passage_program/train_on_track.hpp"
#include "soil/surface_loads.hpp"
#include "track/critical_speed.hpp"
#include "track/irregularity.hpp"
#include "track/passage_files.hpp"
#include "track/profile_file.hpp"
#include "track/track_scene.hpp"
#include "vehicles/axle_loads.hpp"
#include "vehicles/vehicle_drawing.hpp"
#include "vehicles/vehicle_modes.hpp"
#include "vehicles/vehicle_tables.hpp"

namespace easydyn::examples {

namespace {

using namespace easydyn::units;
namespace fs = std::filesystem;

struct Options {
  std::vector<double> speeds;  // [km/h]
  double step_height = 0;      // [mm]
  std::string irregularity;
  unsigned seed = 1;
  fs::path profile;
  double wheel_flat = 0;  // length [mm]
  std::string detail = "full", foundation = "clm";
  double time_step = 1e-4;  // [s]
  fs::path output;
};

/// The foundation asked for; the simpler ones keep the constants of the CLM and drop what they do not have.
track::Foundation choose_foundation(const std::string& name, const track::Foundation& bundled) {
  if (name == "rigid") return track::RigidGround{};
  if (name == "clm") return bundled;
  track::Clm c = track::as_clm(bundled);
  for (Sourced* constant : {&c.m_f, &c.k_f, &c.d_f})
    constant->source = "as in the fitted CLM, its coupling dropped: not a fit of its own";
  if (name == "winkler") return track::Winkler{c.k_f, c.d_f};
  return track::WinklerMass{c.m_f, c.k_f, c.d_f};
}

/// Where the train runs: from before the loaded part, all wheels on the rough rail when the first one gets there, until the
/// last one has left it.
struct Course {
  double reach;        ///< farthest wheel from the train's origin [m]
  double start, stop;  ///< of the origin, where the recording begins and ends [m]
  double run_in;       ///< of the way before that [m]
  double rough_begin;  ///< of the unevenness [m]
};

Course plan(const PassageProgram& program, bool is_rough) {
  Course course{};
  for (const auto& gear : program.vehicle.gears)
    for (const auto& pair : gear.wheel_pairs) course.reach = std::max(course.reach, std::abs(pair.x));
  course.stop = program.loaded + program.approach + course.reach;
  course.start = -course.stop;
  course.run_in = is_rough ? 2 * course.reach + 25 * m : 25 * m;
  course.rough_begin = course.start - course.run_in + course.reach + 2 * m;
  return course;
}

/// One passage with all that it needs.
struct Run {
  Run(const PassageProgram& program, const Options& options, double speed_)
      : is_rough(options.irregularity != "none" || !options.profile.empty()),
        speed(speed_),
        course(plan(program, is_rough || options.wheel_flat > 0)),
        data(program.track) {
    data.foundation = choose_foundation(options.foundation, data.foundation);

    // The sleepers are centred between the bays about x = 0, so that x = 0 is mid-span.
    const double spacing = data.sleeper_spacing;
    // What comes back from the ends of the window, 32 m away, matters more where wheels lift off.
    const double margin = program.margin + (options.step_height != 0 || options.wheel_flat > 0 ? 14 * m : 0);
    const double beyond = course.reach + margin + 3 * spacing;
    const int bays_behind = static_cast<int>(std::ceil((course.stop + course.run_in + beyond) / spacing)),
              bays_ahead = static_cast<int>(std::ceil((course.stop + beyond) / spacing));
    const track::TrackModel model(data, bays_behind + bays_ahead + 1, -(bays_behind + 0.5) * spacing);

    // Excitation: the joint at x = 0, and what is rough all the way.
    std::vector<std::shared_ptr<const track::Profile>> parts;
    parts.push_back(std::make_shared<track::StepProfile>(0, options.step_height * mm));
    if (options.irregularity != "none")
      parts.push_back(std::make_shared<track::Irregularity>(
          track::irregularity_spectrum(options.irregularity),
          track::IrregularityOptions{.begin = course.rough_begin,
                                     .end = course.stop + course.reach + 30 * m,
                                     .seed = options.seed}));
    if (!options.profile.empty())
      parts.push_back(std::make_shared<track::SplineProfile>(
          track::read_profile(options.profile)));  // its ends are held beyond it
    profile = std::make_shared<track::ProfileSum>(parts);
    const std::shared_ptr<const track::WheelShape> flat =
        options.wheel_flat > 0
            ? std::make_shared<track::WheelFlat>(track::WheelFlat::rounded(options.wheel_flat * mm))
            : nullptr;
    system = std::make_unique<TrainOnTrack>(program.vehicle, model, course.start, speed, profile,
                                            options.detail, flat, course.rough_begin);

    passage_options.duration = (course.stop - course.start) / speed;
    passage_options.run_in = course.run_in / speed;
    passage_options.step = options.time_step;
    const double output_step = passage_options.duration > 6 * s ? 1e-3 : 5e-4;  // 0.5 kHz at least
    passage_options.output_step =
        std::max(1.0, std::round(output_step / options.time_step)) * options.time_step;
    passage_options.start_difference = std::min(2e-3, 0.05 * spacing / speed);
    passage_options.window = 2 * (course.reach + margin);
    passage_options.first_sleeper_x = -program.loaded - program.approach;
    passage_options.last_sleeper_x = program.loaded + program.approach;
  }

  void compute(const std::function<void(double)>& progress = {}) {
    passage = track::compute_passage(*system, system->track, system->contacts(), passage_options, progress);
  }

  double static_load(const track::TrackContact& contact) const {
    const auto* const wheel = dynamic_cast<const track::WheelRailContact*>(&contact);
    return wheel ? wheel->static_load() : contact.force();
  }
  Eigen::VectorXd static_loads() const {
    const std::vector<const track::TrackContact*> contacts = system->contacts();
    Eigen::VectorXd loads(static_cast<Eigen::Index>(contacts.size()));
    for (std::size_t w = 0; w < contacts.size(); ++w)
      loads[static_cast<Eigen::Index>(w)] = static_load(*contacts[w]);
    return loads;
  }
  double largest_load_factor() const {
    double largest = 0;
    const std::vector<const track::TrackContact*> contacts = system->contacts();
    for (std::size_t w = 0; w < contacts.size(); ++w)
      largest = std::max(
          largest, passage.largest_contact_force[static_cast<Eigen::Index>(w)] / static_load(*contacts[w]));
    return largest;
  }
  double energy_imbalance() const {
    const Eigen::VectorXd energy = passage.kinetic_energy + passage.potential_energy +
                                   passage.dissipated_energy - passage.supplied_energy;
    return (energy.array() - energy[0]).abs().maxCoeff() / passage.supplied_energy.cwiseAbs().maxCoeff();
  }

  bool is_rough;
  double speed;  ///< [m/s]
  Course course;
  track::TrackData data;
  std::shared_ptr<const track::Profile> profile;
  std::unique_ptr<TrainOnTrack> system;
  track::PassageOptions passage_options;
  track::Passage passage;
};

/// Train and track as an animated scene, at about 25 pictures per second of a slow-motion replay.
visu::Scene make_scene(const PassageProgram& program, const Run& run) {
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

std::vector<track::SummaryFigure> summarise(const Run& run) {
  const track::Passage& passage = run.passage;
  double weight = 0;
  for (const track::TrackContact* contact : run.system->contacts()) weight += run.static_load(*contact);
  return {
      {"vehicle weight", weight / kN, "kN"},
      {"static sum of the ballast reactions / weight", passage.static_ballast_reaction / weight, ""},
      {"largest contact force", passage.largest_contact_force.maxCoeff() / kN, "kN"},
      {"largest dynamic load factor of a wheel pair", run.largest_load_factor(), ""},
      {"largest rail deflection", passage.rail_deflection.maxCoeff() / mm, "mm"},
      {"largest ballast reaction", passage.ballast_reaction.maxCoeff() / kN, "kN"},
      {"smallest ballast reaction", passage.ballast_reaction.minCoeff() / kN, "kN"},
      {"losses of contact", double(passage.contact_losses.sum()), ""},
      {"longest loss of contact of a wheel pair", passage.longest_contact_loss.maxCoeff() / ms, "ms"},
      {"energy imbalance / work supplied", run.energy_imbalance(), ""},
  };
}

std::vector<Parameter> list_parameters(const PassageProgram& program, const Options& options,
                                       const Run& run) {
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
  parameters.push_back({"run", "half length of the loaded ground", program.loaded, "m", "choice"});
  if (options.wheel_flat > 0)
    parameters.push_back({"run", "length of the flat on every wheel pair", options.wheel_flat * mm, "m",
                          "option --wheel-flat, rounded"});
  return parameters;
}

std::string describe(const PassageProgram& program, const Options& options, const Run& run) {
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

/// Speeds near those at which waves in the track or in the ground keep up with the train.
std::vector<std::string> warn_of_speed(const PassageProgram& program, const Run& run) {
  std::vector<std::string> warnings;
  if (const auto warning = track::warn_of_critical_speed(run.data, run.speed)) warnings.push_back(*warning);
  if (program.rayleigh_speed > 0 && run.speed > 0.7 * program.rayleigh_speed)
    warnings.push_back(fmt::format(
        "speed {:.1f} m/s is {:.2f} of the Rayleigh speed {:.1f} m/s of the upper layer of the ground: {}; "
        "the "
        "foundation of the track, fitted at rest, does not know that",
        run.speed, run.speed / program.rayleigh_speed, program.rayleigh_speed,
        run.speed < program.rayleigh_speed ? "its waves gather around the train"
                                           : "the train outruns its waves, which trail it as a wake"));
  return warnings;
}

std::vector<visu::Table> tabulate(const vehicles::RailVehicle& vehicle) {
  return {vehicles::axle_load_table(vehicle, vehicles::compute_axle_loads(vehicle)),
          vehicles::mass_balance_table(vehicle),
          vehicles::mode_table(vehicles::compute_vehicle_modes(vehicle))};
}

/// The rail under the train while it is recorded; near the joint alone where the rest is smooth.
std::optional<track::ProfileSamples> sample_profile(const PassageProgram& program, const Run& run,
                                                    const Options& options) {
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

int run_one(const PassageProgram& program, const Options& options, const std::string& command) {
  Run run(program, options, options.speeds.front() * km / h);
  const std::string description = describe(program, options, run);
  fmt::print("{}: {}\n", program.name, description);
  fs::create_directories(options.output);  // before the work, in case it cannot be
  std::vector<std::string> warnings = vehicles::unusual_values(program.vehicle);
  for (const std::string& warning : warn_of_speed(program, run)) warnings.push_back(warning);
  for (const std::string& warning : warnings) fmt::print("{}: warning: {}\n", program.name, warning);
  fmt::print(
      "{}: {} bays of track, {:.0f} m of them at a time, {} coordinates of bodies, {:.2f} s in steps of {} "
      "s\n",
      program.name, run.system->track.model().bays(), run.passage_options.window, run.system->body_size(),
      run.passage_options.run_in + run.passage_options.duration, options.time_step);
  results::Progress progress("passage");
  run.compute([&](double fraction) { progress.update(fraction); });
  progress.finish();

  const std::vector<track::SummaryFigure> summary = summarise(run);
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
                              .parameters = list_parameters(program, options, run),
                              .summary = summary,
                              .drawing = vehicles::draw_vehicle(program.vehicle),
                              .tables = tabulate(program.vehicle),
                              .static_loads = run.static_loads(),
                              .profile = sample_profile(program, run, options)};
  if (options.detail == "full") report.scene = make_scene(program, run);
  track::write_passage(options.output / "results.h5", run.passage, report, provenance);
  track::write_passage_channels(options.output / "channels.csv", run.passage, 0);

  soil::SurfaceLoads loads;
  loads.time = run.passage.time;
  std::vector<Eigen::Index> handed_over;
  for (Eigen::Index j = 0; j < run.passage.sleeper_x.size(); ++j) {
    if (std::abs(run.passage.sleeper_x[j]) > program.loaded) continue;
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

/// Every speed as a passage of its own, as many at a time as there are cores.
int run_sweep(const PassageProgram& program, const Options& options) {
  fs::create_directories(options.output);
  const std::size_t n = options.speeds.size();
  std::vector<std::vector<track::SummaryFigure>> summaries(n);
  std::vector<std::string> failures(n);
  std::vector<std::vector<std::string>> warnings(n);
  std::atomic<std::size_t> next = 0;
  std::mutex printing;
  const auto work = [&] {
    for (std::size_t i = next++; i < n; i = next++) {
      try {
        Run run(program, options, options.speeds[i] * km / h);
        run.compute();
        summaries[i] = summarise(run);
        warnings[i] = warn_of_speed(program, run);
        for (const std::string& warning : run.passage.warnings) warnings[i].push_back(warning);
      } catch (const std::exception& e) {
        failures[i] = e.what();
        warnings[i].push_back(std::string("failed: ") + e.what());
      }
      const std::scoped_lock lock(printing);
      fmt::print("{}: {:g} km/h {}\n", program.name, options.speeds[i],
                 failures[i].empty() ? "done" : "failed: " + failures[i]);
    }
  };
  std::vector<std::thread> threads;
  for (unsigned i = 0; i < std::clamp(std::thread::hardware_concurrency(), 1u, unsigned(n)); ++i)
    threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  const auto first = std::ranges::find_if(summaries, [](const auto& list) { return !list.empty(); });
  if (first == summaries.end()) throw SolverError("sweep: " + failures[0]);

  // Table, chart, warnings.
  const std::vector<std::size_t> shown = {2, 3, 4, 5, 6, 7, 8};  // of the summary: not the weights
  visu::Table table{{"speed [km/h]"}, {}, "Speeds"};
  for (const std::size_t k : shown) {
    const track::SummaryFigure& f = (*first)[k];
    table.header.push_back(f.unit.empty() ? f.name : fmt::format("{} [{}]", f.name, f.unit));
  }
  Eigen::VectorXd speeds = Eigen::VectorXd::Map(options.speeds.data(), static_cast<Eigen::Index>(n));
  std::vector<visu::Chart> charts;
  for (const std::size_t k : shown) {
    Eigen::VectorXd values(speeds.size());
    for (std::size_t i = 0; i < n; ++i)
      values[static_cast<Eigen::Index>(i)] = summaries[i].empty() ? std::nan("") : summaries[i][k].value;
    const track::SummaryFigure& f = (*first)[k];
    if (values.isZero(0)) continue;  // no contact is lost
    const std::string quantity = f.unit == "kN"   ? "force"
                                 : f.unit == "mm" ? "deflection"
                                 : f.unit == "ms" ? "time"
                                                  : "number";
    charts.push_back({.title = f.name,
                      .x = {"speed", "km/h"},
                      .y = {quantity, f.unit.empty() ? "1" : f.unit},
                      .series = {{f.name, speeds, values, visu::Stroke::line_and_points}}});
  }
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<std::string> row = {fmt::format("{:g}", options.speeds[i])};
    for (const std::size_t k : shown)
      row.push_back(summaries[i].empty() ? "failed" : fmt::format("{:.4g}", summaries[i][k].value));
    table.rows.push_back(row);
  }
  visu::Report report(program.title, fmt::format("{} speeds, step 1 of a prediction: train and track", n));
  report.add_paragraph(fmt::format("{} on {}, foundation {}. The ground is computed for one speed at a time.",
                                   program.vehicle.label(), program.track.label(), options.foundation));
  for (std::size_t i = 0; i < n; ++i)
    for (const std::string& warning : warnings[i])
      report.add_note(fmt::format("{:g} km/h: {}", options.speeds[i], warning));
  report.add_section("Results").add_table(table).add_charts(charts);
  report.write(options.output / "sweep.html");

  for (const std::string& name : table.header)
    fmt::print("{}{}", name, &name == &table.header.back() ? "\n" : "; ");
  for (const auto& row : table.rows)
    for (std::size_t c = 0; c < row.size(); ++c)
      fmt::print("{:>8}{}", row[c], c + 1 == row.size() ? "\n" : " ");
  for (std::size_t i = 0; i < n; ++i)
    for (const std::string& warning : warnings[i])
      fmt::print("{}: warning: {:g} km/h: {}\n", program.name, options.speeds[i], warning);
  fmt::print("{}: wrote {}\n", program.name, (options.output / "sweep.html").string());
  return std::ranges::all_of(failures, &std::string::empty) ? 0 : 1;
}

/// Refuses what is not a number from `least` to `most`; NaN is none.
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

int run_passage_program(const PassageProgram& program, int argc, char** argv) {
  Options options;
  options.speeds = {program.speed};
  options.step_height = program.step_height;
  options.irregularity = program.irregularity;
  options.time_step = program.time_step;
  options.output = "results/" + program.name;
  std::vector<std::string> spectra = track::irregularity_spectrum_names();
  spectra.insert(spectra.begin(), "none");

  CLI::App app{program.title};
  app.add_option("--speed", options.speeds,
                 fmt::format("speed, {:g} to {:g} [km/h]; several, parted by commas: a sweep of step 1 with "
                             "a table and charts",
                             program.least_speed, program.top_speed))
      ->delimiter(',')
      ->capture_default_str()
      ->check(in_range(program.least_speed, program.top_speed));
  app.add_option("--step-height", options.step_height,
                 "height of a rail step at x = 0, up > 0, down < 0, -20 to 20 [mm]")
      ->capture_default_str()
      ->check(in_range(-20, 20));
  CLI::Option* const irregularity =
      app.add_option("--irregularity", options.irregularity,
                     "spectrum of the rail's unevenness; none by default with --profile");
  irregularity->capture_default_str()->check(CLI::IsMember(spectra));
  app.add_option("--seed", options.seed, "of the irregularity: equal seeds, equal rails")
      ->capture_default_str();
  app.add_option("--profile", options.profile, "file of a measured profile: x [m], r [mm]")
      ->check(CLI::ExistingFile);
  app.add_option("--wheel-flat", options.wheel_flat,
                 "length of a rounded flat on every wheel pair, 0 to 200 [mm]")
      ->capture_default_str()
      ->check(in_range(0, 200));
  app.add_option("--detail", options.detail, "what is known of the train")
      ->capture_default_str()
      ->check(CLI::IsMember({"full", "three-masses", "quarter", "wheel-pair"}));
  app.add_option("--foundation", options.foundation, "what the ballast rests on")
      ->capture_default_str()
      ->check(CLI::IsMember({"rigid", "winkler", "winkler-mass", "clm"}));
  app.add_option("--time-step", options.time_step, "of Newmark's method, 1e-6 to 5e-4 [s]")
      ->capture_default_str()
      ->check(in_range(1e-6, 1e-3));
  app.add_option("--output", options.output, "folder of the results")->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  if (!options.profile.empty() && irregularity->count() == 0) options.irregularity = "none";
  try {
    if (options.output.empty()) throw InputError("--output is empty, must name a folder");
    std::ranges::sort(options.speeds);
    if (options.speeds.size() > 1) return run_sweep(program, options);
    return run_one(program, options, results::join_command_line(argc, argv));
  } catch (const std::exception& e) {
    std::cerr << program.name << ": " << e.what() << "\n";
    return 1;
  }
}

}  // namespace easydyn::examples

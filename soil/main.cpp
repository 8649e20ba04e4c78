// The program `soil`: from load histories on the ground surface to vibrations at the receivers.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "easydyn/error.hpp"
#include "easydyn/nearest_name.hpp"
#include "soil/agreement.hpp"
#include "soil/commands.hpp"
#include "soil/layered/layered_prediction.hpp"
#include "soil/parallel_run.hpp"
#include "soil/prediction.hpp"
#include "soil/report/comparison_report.hpp"
#include "soil/report/prediction_report.hpp"
#include "soil/site_file.hpp"
#include "soil/toml_table.hpp"

namespace easydyn::soil {
namespace {

namespace fs = std::filesystem;

const char* const run_footer = R"(
Example:
  soil run examples/sites/tram.toml results/tram/surface_loads.h5 --output results/tram

Files (docs/formats.md describes them):
  SITE.toml         layers of the ground from the surface downward (the last one is a half-space), receivers,
                    highest frequency
  SURFACE_LOADS.h5  time, force, position and size of rectangular footprints; written by the train/track
                    programs of examples/, or by any other program
  vibrations.h5     ground velocity at the receivers, PPV, one-third octave spectrum, KB_Fmax, VdB, displacement
                    of the footprints. It appears when the run is complete. One from an earlier run is first
                    renamed to vibrations.previous.h5, so that a run that fails leaves none that looks new.

  snapshots/        pictures of planes of the ground, if the site file asks for them: open the .pvd in ParaView
  checkpoint.bin    the state of a run that is not complete. Ctrl-C, SIGTERM and a crash of the machine lose little:
                    the same command with --restart goes on and gives the same bits. Removed at the end.

Several processes (docs/parallel.md): mpirun -n 4 soil run ... shares the ground out among 4 ranks; each then has its
part of the checkpoint and of the snapshots.

Nothing is claimed above the highest frequency of the site file: the loads are passed unchanged up to it and
fade out to nothing at 1.25 times it, and so does the motion in vibrations.h5.
Exit status: 0 done, 1 an error in the files or the computation, 2 wrong options, 130 or 143 stopped by SIGINT
(Ctrl-C) or SIGTERM.)";

const char* const report_footer = R"(
Examples:
  soil report results/tram
  soil report results/plain results/trench --output trench.html

One folder: reads results.h5 (the train and the track, if there is one) and vibrations.h5 (the ground) and writes
report.html beside them. Several: compares their vibrations.h5 at the receivers that they have in common, with the first
one as the reference, and writes comparison.html into the current folder. Each is one page that opens without a network.)";

struct RunArguments {
  fs::path site, output;
  std::vector<fs::path> loads;
  std::string damping = "constant";
  bool dry_run = false;
  bool full_model = false;
  bool verify = false;
  double checkpoint_every = 10;  // [min]
  bool restart = false;
  double snapshot_step = 0;  // [s]
  SolverOptions options;
};

void add_run_command(CLI::App& app, RunArguments& run) {
  CLI::App& command =
      *app.add_subcommand("run", "Waves in the ground under given loads, by 3D spectral elements");
  command.footer(run_footer);
  command.add_option("SITE", run.site, "Site file (TOML)")->required()->type_name("");
  command.add_option("SURFACE_LOADS", run.loads, "Load histories (HDF5); of several files all act together")
      ->required()
      ->type_name("");
  command.add_option("-o,--output", run.output, "Folder of vibrations.h5, made if needed")
      ->required()
      ->type_name("DIR");
  command.add_flag("-n,--dry-run", run.dry_run, "Print mesh, memory, steps and expected time, and stop");
  add_element_options(command, run.options);
  command.add_flag("--correct-time", run.options.corrects_time_error,
                   "Take the error of the time steps away, from loads and records (not from snapshots)");
  command
      .add_option("--damping", run.damping,
                  "constant: the ratio of the site file at all frequencies; stiffness: in proportion to "
                  "frequency; none: elastic ground")
      ->check(CLI::IsMember({"constant", "stiffness", "none"}).description(""))
      ->capture_default_str()
      ->type_name("MODEL");
  command.add_flag("--quarter-model", run.options.quarter_model,
                   "Only x >= 0 and y >= 0 (one load, at the origin)");
  command.add_flag("--full-model", run.full_model,
                   "Both sides of the track (loads that are not symmetric about y = 0)");
  command
      .add_option("--checkpoint-every", run.checkpoint_every,
                  "Minutes between two checkpoints; 0: only when the run is stopped")
      ->check(CLI::Range(0.0, 1e6).description(""))
      ->capture_default_str()
      ->type_name("MINUTES");
  command.add_flag("--restart", run.restart, "Go on from the checkpoint in the output folder");
  command
      .add_option(
          "--snapshot-step", run.snapshot_step,
          "Pictures of the surface and of the section x = 0 at every so many seconds, beside those that "
          "the site file asks for; 0: none")
      ->check(CLI::Range(0.0, 1e3).description(""))
      ->capture_default_str()
      ->type_name("SECONDS");
  command.add_flag("--verify", run.verify,
                   "Add the semi-analytical solution of the layered half-space to result and report");
}

// Of a run, and of its part below a crossover frequency.
std::vector<fs::path> checkpoints_of(const fs::path& folder) {
  const fs::path checkpoint = folder / "checkpoint.bin";
  return {checkpoint, low_checkpoint_of(checkpoint)};
}

// The surface and a section across the track, unless the site file asks for pictures of these names.
void add_snapshots(Site& site, double step) {
  if (step == 0) return;
  for (const auto& [name, axis] : {std::pair("surface", 2), std::pair("section", 0)}) {
    const bool is_there = std::any_of(site.snapshots.begin(), site.snapshots.end(),
                                      [&](const Snapshot& snapshot) { return snapshot.name == name; });
    if (!is_there) site.snapshots.push_back({.name = name, .axis = axis, .step = step});
  }
}

RunControl make_run_control(const RunArguments& arguments) {
  RunControl control = make_control(arguments.output / "checkpoint.bin");
  control.checkpoint_interval = 60 * arguments.checkpoint_every;
  control.restart = arguments.restart;
  control.snapshots = arguments.output / "snapshots";
  return control;
}

// Names of an earlier run's files change before this one starts.
void set_earlier_run_aside(const RunArguments& arguments) {
  prepare_result(arguments.output);
  if (!arguments.restart) {
    bool had_checkpoint = false;
    for (const fs::path& checkpoint : checkpoints_of(arguments.output)) {
      if (!set_aside(checkpoint)) continue;
      had_checkpoint = true;
      fs::path previous = checkpoint;
      previous.replace_filename(checkpoint.stem().string() + ".previous" + checkpoint.extension().string());
      set_rank_checkpoints_aside(checkpoint, previous);
    }
    if (had_checkpoint) {
      fmt::print(
          stderr,
          "soil: warning: {}: this run starts anew, without --restart; the checkpoint of the earlier one "
          "is now checkpoint.previous.bin\n",
          (arguments.output / "checkpoint.bin").string());
    }
  }
}

void run(RunArguments& arguments, const std::string& command_line, Ranks* ranks) {
  if (!arguments.dry_run) act_on_first(ranks, [&] { set_earlier_run_aside(arguments); });
  Site site = read_site(arguments.site);
  add_snapshots(site, arguments.snapshot_step);
  warn_of_unusual_values(arguments.site, site);
  const SurfaceLoads loads = read_surface_loads(arguments.loads);
  arguments.options.damping = find_damping_model(arguments.damping);
  arguments.options.half_model = !arguments.full_model;
  WaveSolver solver = [&] {
    try {
      return make_solver(site, loads, arguments.options, ranks);
    } catch (const ModelError& error) {  // site and loads do not fit: say which files
      throw ModelError(
          fmt::format("{}, {}: {}", arguments.site.string(), join_names(arguments.loads), error.what()));
    }
  }();
  const RunControl control = make_run_control(arguments);
  print_run_summary(stdout, site, loads, solver);
  print_file_summary(stdout, solver, control);
  if (arguments.dry_run) {
    return;
  }
  std::optional<SemiAnalyticalMotion> semi_analytical;
  if (arguments.verify) {  // first: what does not fit is refused in seconds
    act_on_first(ranks, [&] {
      semi_analytical = compute_semi_analytical_motion(site, loads, find_ground_damping(arguments.damping),
                                                       arguments.options.threads);
    });
  }
  act_on_first(ranks, [&] {
    if (!arguments.restart) set_aside(control.snapshots);
    if (!site.snapshots.empty()) make_folder(control.snapshots);
  });
  Vibrations vibrations = predict_vibrations(site, loads, solver, stdout, control);
  vibrations.semi_analytical = std::move(semi_analytical);
  const fs::path result = arguments.output / "vibrations.h5";
  act_on_first(ranks, [&] {
    write_vibrations(result, vibrations,
                     {.program = "soil", .command = command_line, .convention = result_convention});
    std::error_code ignored;
    for (const fs::path& checkpoint : checkpoints_of(arguments.output)) {
      fs::remove(checkpoint, ignored);
      remove_rank_checkpoints(checkpoint, 0);
    }
  });
  print_indicators(stdout, vibrations);
  if (vibrations.semi_analytical) print_comparison(vibrations);
  fmt::print("\n{}\n", result.string());
}

struct ReportArguments {
  std::vector<fs::path> folders;
  fs::path output;
};

void add_report_command(CLI::App& app, ReportArguments& report) {
  CLI::App& command =
      *app.add_subcommand("report", "One page on the results in a folder, or a comparison of several");
  command.footer(report_footer);
  command.add_option("DIR", report.folders, "Folders of the results")->required()->type_name("");
  command
      .add_option("-o,--output", report.output,
                  "The page; else report.html in the folder, or comparison.html here for several")
      ->type_name("FILE");
}

void write_report(const ReportArguments& report) {
  const bool is_one = report.folders.size() == 1;
  const fs::path page = !report.output.empty() ? report.output
                        : is_one               ? report.folders.front() / "report.html"
                                               : "comparison.html";
  if (is_one) {
    write_prediction_report(report.folders.front(), page);
  } else {
    write_comparison_report(report.folders, page);
  }
  fmt::print("{}\n", page.string());
}

// Empty if the first word may be a command.
std::string find_fault_of_command(const std::string& word) {
  const std::vector<std::string> commands = {"run", "mobility", "predict", "report"};
  if (word.starts_with('-') || std::find(commands.begin(), commands.end(), word) != commands.end()) return {};
  const std::string nearest = find_nearest(word, commands);
  return fmt::format("no command \"{}\"{}; known: run, mobility, predict, report", word,
                     nearest.empty() ? "" : ", did you mean \"" + nearest + "\"?");
}

int run_program(int argc, char** argv, ParallelRun& parallel) {
  if (argc > 1) {
    if (const std::string fault = find_fault_of_command(argv[1]); !fault.empty()) {
      fmt::print(stderr, "soil: {}\n", fault);
      return 2;
    }
  }
  CLI::App app("Vibrations in the ground from loads on its surface.", "soil");
  app.set_version_flag("--version", "soil " + results::library_version());
  app.require_subcommand(1);
  app.failure_message([](const CLI::App*, const CLI::Error& error) {
    return fmt::format("soil: {}\nsoil --help and soil COMMAND --help explain the options.\n", error.what());
  });
  app.footer(
      "\nExample:\n  soil run examples/sites/tram.toml results/tram/surface_loads.h5 --output "
      "results/tram\n\n"
      "`soil run --help` says what the files hold.");
  RunArguments arguments;
  ReportArguments report;
  add_run_command(app, arguments);
  const Action mobility = add_mobility_command(app), predict = add_predict_command(app);
  add_report_command(app, report);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  const std::string command_line = results::join_command_line(argc, argv);
  try {
    if (app.got_subcommand("run")) {
      return run_stoppable([&] { run(arguments, command_line, parallel.ranks()); },
                           command_line + (arguments.restart ? "" : " --restart"), parallel.ranks());
    }
    if (parallel.ranks())
      throw InputError("only soil run shares its work among ranks: start this command without mpirun");
    if (app.got_subcommand("mobility")) return mobility(command_line);
    if (app.got_subcommand("predict")) return predict(command_line);
    write_report(report);
    return 0;
  } catch (const std::exception& error) {
    parallel.fail(fmt::format("soil: {}\n", error.what()));
    return 1;
  }
}

int run_on_ranks(int argc, char** argv) {
  try {
    ParallelRun parallel;
    return run_program(argc, argv, parallel);
  } catch (const std::exception& error) {  // no ranks
    fmt::print(stderr, "soil: {}\n", error.what());
    return 1;
  }
}

}  // namespace
}  // namespace easydyn::soil

int main(int argc, char** argv) {
  return easydyn::soil::run_on_ranks(argc, argv);
}

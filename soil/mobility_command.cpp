#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <initializer_list>
#include <memory>
#include <vector>

#include "easydyn/error.hpp"
#include "easydyn/results/progress.hpp"
#include "soil/commands.hpp"
#include "soil/element_mobility.hpp"
#include "soil/layered/layered_prediction.hpp"
#include "soil/mobility_identity.hpp"
#include "soil/prediction.hpp"
#include "soil/site_file.hpp"

namespace easydyn::soil {
namespace {

namespace fs = std::filesystem;

const char* const footer = R"(
Examples:
  soil mobility examples/sites/tram.toml --loads results/tram/surface_loads.h5 --method elements
  soil predict examples/sites/tram.mobility.h5 results/tram/surface_loads.h5 --output results/tram

Where the ground does not vary along the track, the response to any footprint is that to one footprint, shifted. The
file (docs/formats.md) holds the response to one at all distances that loads and receivers need, and lies beside the
site file unless --output says otherwise. Every train on footprints of the same size and spacing can then be predicted in
seconds.

Methods:
  layered           the semi-analytical layered half-space: seconds; layers only
  elements          one run of a quarter model by finite elements: minutes to hours (--dry-run says how long); also with
                    blocks that run along the whole track, the same on both sides

A file that is there and still holds is left as it is; it may cover more distances than needed. --force computes it
anew. A run that was stopped goes on when the same command is given again.
Exit status: as that of soil run.)";

struct Arguments {
  fs::path site, output;
  std::vector<fs::path> loads;
  std::string method = "layered", damping = "constant";
  std::vector<double> footprint;  // length, width
  double spacing = 0.6, window = 0;
  int count = 1;
  bool dry_run = false, force = false;
  SolverOptions options;

  bool has_elements() const { return method == "elements"; }
};

// Footprints of a track around x = 0.
std::vector<Footprint> make_footprints(const Arguments& arguments) {
  if (!arguments.loads.empty()) return read_surface_loads(arguments.loads).footprints;
  if (arguments.footprint.empty()) {
    throw InputError("no footprint: give --loads, or --footprint with --spacing and --count");
  }
  std::vector<Footprint> footprints;
  for (int i = 0; i < arguments.count; ++i) {
    footprints.push_back({.x = arguments.spacing * (i - 0.5 * (arguments.count - 1)),
                          .y = 0,
                          .length = arguments.footprint[0],
                          .width = arguments.footprint[1]});
  }
  return footprints;
}

// Why the file must be computed; empty if it holds.
std::string find_reason(const fs::path& file, const std::vector<std::string>& identity,
                        const Mobility& needed, double window) {
  StoredMobility stored;
  try {
    stored = read_mobility(file);
  } catch (const InputError& error) {
    return error.what();
  }
  if (stored.identity.empty()) return "it is of an earlier version of the program";
  if (const std::string difference = find_difference(stored.identity, identity); !difference.empty())
    return difference;
  // A distance that is missing says more than the longer window that it needs.
  if (const std::string missing = find_missing(stored.mobility, needed); !missing.empty()) return missing;
  return find_shortage(stored, window);
}

// A checkpoint of the same run is gone on with.
StoredMobility compute_by_elements(ElementMobility& mobility, RunControl control,
                                   const fs::path& checkpoint) {
  std::unique_ptr<results::Progress> progress;
  control.progress = [&, first = true](double fraction) mutable {
    if (!progress) progress = std::make_unique<results::Progress>("waves");
    if (!first || fraction == 0) progress->update(fraction);
    first = false;
  };
  control.restart = fs::exists(checkpoint);
  StoredMobility stored = [&] {
    try {
      return mobility.compute(control);
    } catch (const InputError& error) {
      if (!control.restart) throw;
      fmt::print(stderr, "soil: warning: {}; this run starts anew\n", error.what());
      control.restart = false;
      return mobility.compute(control);
    }
  }();
  progress->finish();
  return stored;
}

void print_mobility(const StoredMobility& stored) {
  const Mobility& m = stored.mobility;
  fmt::print("method     {}\nfootprint  {} m x {} m\n", stored.method, m.length, m.width);
  const auto layered = std::ranges::count(stored.shift_methods, layered_method);
  fmt::print("responses  {:.2f} s at {} distances of receivers, {} of footprints{}\n", stored.window,
             m.places.size(), m.shifts.size(),
             layered > 0 ? fmt::format(" ({} of them by the {})", layered, layered_method) : "");
}

// The exit status.
int run(const Arguments& arguments, const std::string& command_line) {
  const auto start = std::chrono::steady_clock::now();
  const Site site = read_site(arguments.site);
  warn_of_unusual_values(arguments.site, site);
  const std::vector<Footprint> footprints = make_footprints(arguments);
  fs::path output = arguments.output;
  if (output.empty()) output = fs::path(arguments.site).replace_extension(".mobility.h5");
  ElementMobilityOptions options{.solver = arguments.options, .window = arguments.window};
  if (arguments.has_elements()) options.solver.damping = find_damping_model(arguments.damping);
  const GroundDamping damping = find_ground_damping(arguments.damping);

  if (fs::exists(output) && !arguments.force) {
    const Mobility needed = list_distances(footprints, site.receivers);
    const double window = arguments.window > 0 ? arguments.window
                          : arguments.has_elements()
                              ? estimate_element_window(site, needed)
                              : estimate_window(LayeredGround(site, damping).slowest_cs(), needed);
    const std::string reason = find_reason(
        output, describe_responses(site, damping, arguments.has_elements() ? &options.solver : nullptr),
        needed, window);
    if (reason.empty()) {
      fmt::print("{}: up to date\n", output.string());
      return 0;
    }
    fmt::print("{}: does not hold any more: {}\n", output.string(), reason);
  }

  StoredMobility stored;
  fs::path checkpoint;
  if (arguments.has_elements()) {
    ElementMobility mobility(site, footprints, options);
    checkpoint = fs::absolute(output).replace_extension(".checkpoint.bin");
    const RunControl control = make_control(checkpoint);
    print_run_summary(stdout, mobility.model(), mobility.pulse(), mobility.solver());
    print_file_summary(stdout, mobility.solver(), control);
    if (arguments.dry_run) return 0;
    const int status =
        run_stoppable([&] { stored = compute_by_elements(mobility, control, checkpoint); }, command_line);
    if (status != 0) return status;
  } else {
    if (arguments.dry_run) return 0;
    stored = compute_mobility(site, footprints, damping, arguments.window, arguments.options.threads);
  }
  warn_of_rest(stored.rest);
  set_aside(output);
  write_mobility(output, stored,
                 {.program = "soil", .command = command_line, .convention = result_convention});
  std::error_code ignored;
  for (const fs::path& file : {checkpoint, low_checkpoint_of(checkpoint)}) fs::remove(file, ignored);
  print_mobility(stored);
  fmt::print("needed     {}\n\n{}\n",
             results::format_duration(
                 std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()),
             output.string());
  return 0;
}

int run_naming_the_files(const Arguments& arguments, const std::string& command_line) {
  try {
    return run(arguments, command_line);
  } catch (const ModelError& error) {  // site and footprints do not fit: say which files
    std::string files = arguments.site.string();
    if (!arguments.loads.empty()) files += ", " + join_names(arguments.loads);
    throw ModelError(fmt::format("{}: {}", files, error.what()));
  }
}

// Options that would do nothing.
void refuse_idle_options(const Arguments& arguments, const CLI::App& command) {
  const auto refuse = [&](std::initializer_list<const char*> names, const char* reason) {
    for (const char* const name : names)
      if (command.count(name) > 0) throw InputError(fmt::format("{}: {}", name, reason));
  };
  if (!arguments.has_elements())
    refuse({"--degree", "--double", "--boundary", "--crossover"},
           "is for --method elements, the method is layered");
  if (!arguments.loads.empty())
    refuse({"--footprint", "--spacing", "--count"}, "the footprints are those of --loads, give one of both");
}

}  // namespace

Action add_mobility_command(CLI::App& app) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App& command =
      *app.add_subcommand("mobility", "Impulse responses of the ground to one footprint, for `soil predict`");
  command.footer(footer);
  command.add_option("SITE", arguments->site, "Site file (TOML)")->required()->type_name("");
  command.add_option("--loads", arguments->loads, "Load histories whose footprints are meant (HDF5)")
      ->type_name("SURFACE_LOADS.h5 ...");
  command
      .add_option("--footprint", arguments->footprint, "Without --loads: length along x, width along y [m]")
      ->expected(2)
      ->check(CLI::PositiveNumber.description(""))
      ->type_name("LENGTH WIDTH");
  command.add_option("--spacing", arguments->spacing, "With --footprint: distance between footprints [m]")
      ->check(CLI::PositiveNumber.description(""))
      ->capture_default_str();
  command.add_option("--count", arguments->count, "With --footprint: how many, around x = 0")
      ->check(CLI::Range(1, 10000).description(""))
      ->capture_default_str();
  command.add_option("-o,--output", arguments->output, "File to write; default: SITE.mobility.h5")
      ->type_name("FILE");
  command.add_option("--method", arguments->method, "layered or elements, see below")
      ->check(CLI::IsMember({"layered", "elements"}).description(""))
      ->capture_default_str()
      ->type_name("METHOD");
  command
      .add_option("--damping", arguments->damping,
                  "constant: the ratio of the site file, nearly at all frequencies; constant-q: exactly "
                  "(layered only); "
                  "stiffness: in proportion to frequency; none: elastic ground")
      ->check(CLI::IsMember({"constant", "constant-q", "stiffness", "none"}).description(""))
      ->capture_default_str()
      ->type_name("MODEL");
  command
      .add_option("--window", arguments->window, "Length of the responses [s]; 0: chosen by the distances")
      ->check(CLI::NonNegativeNumber.description(""))
      ->capture_default_str();
  add_element_options(command, arguments->options);
  command.add_flag(
      "-n,--dry-run", arguments->dry_run,
      "Say whether the file holds; if not, print mesh, memory, steps and expected time, and stop");
  command.add_flag("--force", arguments->force, "Compute even if the file holds");
  return [arguments, &command](const std::string& command_line) {
    refuse_idle_options(*arguments, command);
    return run_naming_the_files(*arguments, command_line);
  };
}

}  // namespace easydyn::soil

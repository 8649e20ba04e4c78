#include <fmt/format.h>

#include <memory>

#include "easydyn/error.hpp"
#include "soil/commands.hpp"
#include "soil/layered/layered_prediction.hpp"
#include "soil/mobility_identity.hpp"
#include "soil/mobility_prediction.hpp"
#include "soil/prediction.hpp"
#include "soil/site_file.hpp"

namespace easydyn::soil {
namespace {

namespace fs = std::filesystem;

const char* const footer = R"(
Examples:
  soil predict examples/sites/tram.mobility.h5 results/tram/surface_loads.h5 --output results/tram
  soil predict examples/sites/tram.toml results/tram/surface_loads.h5 --output results/tram

GROUND is a file of `soil mobility`, or a site file (.toml): its layered half-space is then solved first, which takes
some seconds. Receivers and taper are those of the site file at the time of `soil mobility`, or with --site those of the
file as it is now: its ground must still be the same, and the distances of its receivers be in GROUND. The result,
vibrations.h5, is that of `soil run`.)";

struct Arguments {
  fs::path ground, output, site;
  std::vector<fs::path> loads;
  bool verify = false;
  int threads = 0;
};

// Receivers and settings of the site file as it is now.
void take_site(const fs::path& path, StoredMobility& stored) {
  Site site = read_site(path);
  warn_of_unusual_values(path, site);
  const std::string difference = find_difference(describe_ground(stored.site), describe_ground(site));
  if (!difference.empty()) {
    throw ModelError(fmt::format("the responses are of another ground than {}: {} (run soil mobility again)",
                                 path.string(), difference));
  }
  stored.site = std::move(site);
}

void refuse_to_verify() {
  throw InputError("--verify: the responses are semi-analytical themselves, must be by finite elements");
}

StoredMobility obtain_mobility(const Arguments& arguments, const SurfaceLoads& loads) {
  if (arguments.ground.extension() != ".toml") {
    StoredMobility stored = read_mobility(arguments.ground);
    if (!arguments.site.empty()) take_site(arguments.site, stored);
    if (arguments.verify && stored.method == layered_method) refuse_to_verify();
    return stored;
  }
  if (!arguments.site.empty())
    throw InputError("--site is for a file of soil mobility, the ground is a site");
  if (arguments.verify) refuse_to_verify();
  const Site site = read_site(arguments.ground);
  warn_of_unusual_values(arguments.ground, site);
  StoredMobility stored =
      compute_mobility(site, loads.footprints, GroundDamping::maxwell_body, 0, arguments.threads);
  warn_of_rest(stored.rest);
  return stored;
}

void run(const Arguments& arguments, const std::string& command_line) {
  const fs::path result = prepare_result(arguments.output);
  const SurfaceLoads loads = read_surface_loads(arguments.loads);
  const Vibrations vibrations = [&] {
    try {
      const StoredMobility stored = obtain_mobility(arguments, loads);
      Vibrations predicted = predict_vibrations(stored, loads, arguments.threads);
      if (arguments.verify) {
        predicted.semi_analytical =
            compute_semi_analytical_motion(stored.site, loads, stored.damping, arguments.threads);
      }
      return predicted;
    } catch (const ModelError& error) {  // ground and loads do not fit: say which files
      throw ModelError(
          fmt::format("{}, {}: {}", arguments.ground.string(), join_names(arguments.loads), error.what()));
    }
  }();
  write_vibrations(result, vibrations,
                   {.program = "soil", .command = command_line, .convention = result_convention});
  print_indicators(stdout, vibrations);
  if (arguments.verify) print_comparison(vibrations);
  fmt::print("\n{}\n", result.string());
}

}  // namespace

Action add_predict_command(CLI::App& app) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App& command = *app.add_subcommand(
      "predict", "Vibrations under given loads by superposition of the responses to one footprint");
  command.footer(footer);
  command.add_option("GROUND", arguments->ground, "Impulse responses (HDF5) or site file (TOML)")
      ->required()
      ->type_name("");
  command
      .add_option("SURFACE_LOADS", arguments->loads,
                  "Load histories (HDF5); of several files all act together")
      ->required()
      ->type_name("");
  command.add_option("-o,--output", arguments->output, "Folder of vibrations.h5, made if needed")
      ->required()
      ->type_name("DIR");
  command.add_option("-j,--threads", arguments->threads, "Threads; 0: one per core")
      ->check(CLI::Range(0, 1024).description(""))
      ->capture_default_str();
  command
      .add_option("--site", arguments->site, "Site file with the receivers (TOML); default: that in GROUND")
      ->type_name("SITE");
  command.add_flag("--verify", arguments->verify,
                   "Add the semi-analytical solution of the layered half-space to result and report");
  return [arguments](const std::string& command_line) {
    run(*arguments, command_line);
    return 0;
  };
}

}  // namespace easydyn::soil

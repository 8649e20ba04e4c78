#include <fmt/format.h>

#include <memory>

#include "easydyn/error.hpp"
#include "soil/commands.hpp"
#include "soil/layered/layered_prediction.hpp"
#include "soil/mobility_prediction.hpp"
#include "soil/prediction.hpp"
#include "soil/site_file.hpp"

namespace easydyn::soil {
namespace {

namespace fs = std::filesystem;

const char* const footer = R"(
Examples:
  soil predict results/tram/mobility.h5 results/tram/surface_loads.h5 --output results/tram
  soil predict examples/sites/tram.toml results/tram/surface_loads.h5 --output results/tram

GROUND is a file of `soil mobility`, or a site file (.toml): its layered half-space is then solved first, which takes
some seconds. The result, vibrations.h5, is that of `soil run`.)";

struct Arguments {
  fs::path ground, loads, output;
  int threads = 0;
};

StoredMobility obtain_mobility(const Arguments& arguments, const SurfaceLoads& loads) {
  if (arguments.ground.extension() != ".toml") return read_mobility(arguments.ground);
  const Site site = read_site(arguments.ground);
  warn_of_unusual_values(arguments.ground, site);
  return compute_mobility(site, loads.footprints, GroundDamping::maxwell_body, 0, arguments.threads);
}

void run(const Arguments& arguments, const std::string& command_line) {
  const fs::path result = prepare_result(arguments.output);
  const SurfaceLoads loads = read_surface_loads(arguments.loads);
  const Vibrations vibrations = [&] {
    try {
      const StoredMobility stored = obtain_mobility(arguments, loads);
      return predict_vibrations(stored, stored.site, loads, arguments.threads);
    } catch (const ModelError& error) {  // ground and loads do not fit: say which files
      throw ModelError(
          fmt::format("{}, {}: {}", arguments.ground.string(), arguments.loads.string(), error.what()));
    }
  }();
  write_vibrations(result, vibrations,
                   {.program = "soil", .command = command_line, .convention = result_convention});
  print_indicators(stdout, vibrations);
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
  command.add_option("SURFACE_LOADS", arguments->loads, "Load histories (HDF5)")->required()->type_name("");
  command.add_option("-o,--output", arguments->output, "Folder of vibrations.h5, made if needed")
      ->required()
      ->type_name("DIR");
  command.add_option("-j,--threads", arguments->threads, "Threads; 0: one per core")
      ->check(CLI::Range(0, 1024).description(""))
      ->capture_default_str();
  return [arguments](const std::string& command_line) { run(*arguments, command_line); };
}

}  // namespace easydyn::soil

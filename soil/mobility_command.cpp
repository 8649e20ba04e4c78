#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <vector>

#include "easydyn/error.hpp"
#include "easydyn/results/progress.hpp"
#include "soil/commands.hpp"
#include "soil/layered/layered_prediction.hpp"
#include "soil/site_file.hpp"

namespace easydyn::soil {
namespace {

namespace fs = std::filesystem;

const char* const footer = R"(
Example:
  soil mobility examples/sites/tram.toml --loads results/tram/surface_loads.h5 --output results/tram/mobility.h5
  soil predict results/tram/mobility.h5 results/tram/surface_loads.h5 --output results/tram

The layers of a site are the same everywhere along x and y: the response to any footprint is that to one footprint,
shifted. mobility.h5 (docs/formats.md) holds the response to one at all distances that the loads need, and lies beside
the site file unless --output says otherwise. Every train on footprints of the same size and spacing can then be
predicted in about a second.)";

struct Arguments {
  fs::path site, output;
  std::vector<fs::path> loads;
  std::string method = "layered", damping = "constant";
  std::vector<double> footprint;  // length, width
  double spacing = 0.6, window = 0;
  int count = 1, threads = 0;
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

void run(const Arguments& arguments, const std::string& command_line) {
  const auto start = std::chrono::steady_clock::now();
  const Site site = read_site(arguments.site);
  warn_of_unusual_values(arguments.site, site);
  const std::vector<Footprint> footprints = make_footprints(arguments);
  fs::path output = arguments.output;
  if (output.empty()) output = fs::path(arguments.site).replace_extension(".mobility.h5");
  const StoredMobility stored = compute_mobility(site, footprints, find_ground_damping(arguments.damping),
                                                 arguments.window, arguments.threads);
  write_mobility(output, stored,
                 {.program = "soil", .command = command_line, .convention = result_convention});
  const Mobility& m = stored.mobility;
  fmt::print("site       {}: {} layer{}, up to {} Hz\n", site.name, site.layers.size(),
             site.layers.size() == 1 ? "" : "s", site.highest_frequency);
  fmt::print("footprint  {} m x {} m\n", m.length, m.width);
  fmt::print("responses  {:.2f} s at {} distances of receivers, {} of footprints\n",
             m.step * static_cast<double>(m.hz.rows() - m.before), m.places.size(), m.shifts.size());
  fmt::print("needed     {}\n\n{}\n",
             results::format_duration(
                 std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()),
             output.string());
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
  command.add_option("--method", arguments->method, "layered: the semi-analytical layered half-space")
      ->check(CLI::IsMember({"layered"}).description(""))
      ->capture_default_str()
      ->type_name("METHOD");
  command
      .add_option(
          "--damping", arguments->damping,
          "constant: as the finite elements; constant-q: the same ratio at all frequencies; stiffness: in "
          "proportion to frequency; none: elastic ground")
      ->check(CLI::IsMember({"constant", "constant-q", "stiffness", "none"}).description(""))
      ->capture_default_str()
      ->type_name("MODEL");
  command
      .add_option("--window", arguments->window, "Length of the responses [s]; 0: chosen by the distances")
      ->check(CLI::NonNegativeNumber.description(""))
      ->capture_default_str();
  command.add_option("-j,--threads", arguments->threads, "Threads; 0: one per core")
      ->check(CLI::Range(0, 1024).description(""))
      ->capture_default_str();
  return [arguments](const std::string& command_line) { run(*arguments, command_line); };
}

}  // namespace easydyn::soil

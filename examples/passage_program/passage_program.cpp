#include "examples/passage_program/passage_program.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <iostream>
#include <optional>

#include "easydyn/error.hpp"
#include "easydyn/results/result_file.hpp"
#include "examples/passage_program/passage_run.hpp"
#include "track/irregularity_spectrum.hpp"

namespace easydyn::examples {

namespace {

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
  PassageProgramOptions options;
  options.speeds = {program.speed};
  options.step_height = program.step_height;
  options.irregularity = program.irregularity;
  options.time_step = program.time_step;
  options.loaded = program.loaded;
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
  app.add_option("--profile", options.profile, "measured profile: CSV with the header \"x [m], r [mm]\"")
      ->check(CLI::ExistingFile);
  app.add_option("--wheel-flat", options.wheel_flat,
                 "length of a rounded flat on every wheel pair, 0 to 200 [mm]")
      ->capture_default_str()
      ->check(in_range(0, 200));
  app.add_option("--detail", options.detail, "what is known of the train")
      ->capture_default_str()
      ->check(CLI::IsMember({"full", "three-masses", "quarter", "wheel-pair", "moving-loads"}));
  app.add_option("--foundation", options.foundation, "what the ballast rests on")
      ->capture_default_str()
      ->check(CLI::IsMember({"rigid", "winkler", "winkler-mass", "clm"}));
  app.add_option(
         "--site", options.site,
         "site file (TOML) that the foundation is fitted to, kept beside it as SITE.clm.toml; without "
         "it the constants of the bundled track")
      ->check(CLI::ExistingFile);
  app.add_option("--time-step", options.time_step, "of Newmark's method, 1e-6 to 1e-3 [s]")
      ->capture_default_str()
      ->check(in_range(1e-6, 1e-3));
  app.add_option("--loaded", options.loaded,
                 "the ground is loaded from -LOADED to LOADED about x = 0, 5 to 1000 [m]")
      ->capture_default_str()
      ->check(in_range(5, 1000));
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
    std::optional<SiteOfRun> site;
    PassageProgram on_site = program;
    if (!options.site.empty()) {
      site = read_site_of_run(options.site, program, options.foundation);
      on_site = place_on(*site, program);
    }
    if (options.speeds.size() > 1) return run_speed_sweep(on_site, options);
    return run_passage(on_site, options, site, results::join_command_line(argc, argv));
  } catch (const std::exception& e) {
    std::cerr << program.name << ": " << e.what() << "\n";
    return 1;
  }
}

}  // namespace easydyn::examples

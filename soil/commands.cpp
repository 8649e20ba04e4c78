#include "soil/commands.hpp"

#include <fmt/format.h>

#include <string>
#include <system_error>

#include "easydyn/error.hpp"
#include "soil/layered/layered_prediction.hpp"
#include "soil/ranks.hpp"
#include "soil/response_rest.hpp"
#include "soil/site.hpp"
#include "soil/stop_signal.hpp"

namespace easydyn::soil {

namespace fs = std::filesystem;

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder)) {
    throw InputError(fmt::format("{}: cannot be made a folder, {}", folder.string(), error.message()));
  }
}

bool set_aside(const fs::path& result) {
  fs::path previous = result;
  previous.replace_filename(result.stem().string() + ".previous" + result.extension().string());
  std::error_code error;
  if (!fs::exists(result, error)) return false;
  if (fs::is_directory(result, error)) fs::remove_all(previous, error);  // only files are replaced
  fs::rename(result, previous, error);
  if (error) {
    throw InputError(
        fmt::format("{}: cannot be renamed to {}, {}", result.string(), previous.string(), error.message()));
  }
  return true;
}

void add_element_options(CLI::App& command, SolverOptions& options) {
  command.add_option("-j,--threads", options.threads, "Threads; 0: one per core, fewer for a small model")
      ->check(CLI::Range(0, 1024).description(""))
      ->capture_default_str();
  command.add_option("--degree", options.degree, "Polynomial degree of the elements, 3 to 6")
      ->check(CLI::Range(3, 6).description(""))
      ->capture_default_str();
  command.add_flag("--double", options.double_precision, "Fields in double precision (slower, for checks)");
  command
      .add_option_function<std::string>(
          "--boundary",
          [&options](const std::string& name) {
            options.boundary = name == "pml" ? AbsorbingBoundary::matched_layer : AbsorbingBoundary::sponge;
          },
          "What absorbs waves at the edge of the model: sponge, or pml, a perfectly matched layer, which "
          "sends back far less below 10 Hz; pml not with --crossover and not on every site")
      ->check(CLI::IsMember({"sponge", "pml"}).description(""))
      ->default_str("sponge")
      ->type_name("EDGE");
  command
      .add_option("--crossover", options.crossover_frequency,
                  "Frequency [Hz] below which the motion is computed on a larger, coarser lattice, for less "
                  "reflection from the edge of the model; 0: none")
      ->check(CLI::Range(0.0, 1e3).description(""))
      ->capture_default_str();
}

DampingModel find_damping_model(const std::string& name) {
  if (name == "none") return DampingModel::none;
  if (name == "stiffness") return DampingModel::stiffness_proportional;
  if (name == "constant") return DampingModel::constant_ratio;
  throw InputError(
      fmt::format("damping = {}, must be constant, stiffness or none for finite elements", name));
}

RunControl make_control(const fs::path& checkpoint) {
  RunControl control;
  control.checkpoint = checkpoint;
  control.is_stop_wanted = [] { return StopSignal::number() != 0; };
  control.warn = [](const std::string& sentence) { fmt::print(stderr, "soil: warning: {}\n", sentence); };
  return control;
}

int run_stoppable(const std::function<void()>& run, const std::string& command_to_go_on, Ranks* ranks) {
  const StopSignal signal;
  try {
    run();
    return 0;
  } catch (const RunStopped& stopped) {
    double number = StopSignal::number();
    if (ranks) ranks->maximise(&number, 1);  // one of them has heard it
    fmt::print(stderr, "soil: {}: {}\nTo go on: {}{}\n", StopSignal::name_of(static_cast<int>(number)),
               stopped.what(), ranks ? fmt::format("mpirun -n {} ", ranks->size()) : "", command_to_go_on);
    return 128 + static_cast<int>(number);  // as a shell says it
  }
}

void print_comparison(const Vibrations& vibrations) {
  fmt::print("\n{:<20} {:>12} {:>12} {:>12}   (difference from the layered half-space, L2 of v_z)\n",
             "receiver", "PPV z", "whole", "above 2 Hz");
  fmt::print("{:<20} {:>12} {:>12} {:>12}\n", "", "[mm/s]", "[%]", "[%]");
  for (const MotionDifference& d : compare_with_semi_analytical(vibrations)) {
    fmt::print("{:<20} {:>12.4g} {:>12.3g} {:>12.3g}\n", d.receiver, 1e3 * d.ppv_z[1], 100 * d.l2[2],
               100 * d.dynamic_l2_z);
  }
}

fs::path prepare_result(const fs::path& folder) {
  const fs::path result = folder / "vibrations.h5";
  make_folder(folder);
  set_aside(result);
  return result;
}

std::string join_names(const std::vector<fs::path>& files) {
  std::string names;
  for (const fs::path& file : files) names += (names.empty() ? "" : ", ") + file.string();
  return names;
}

void warn_of_rest(const ResponseRest& rest) {
  if (rest.share <= ResponseRest::accepted) return;
  fmt::print(
      stderr,
      "soil: warning: {:.2g} % of the largest response of {} are left in the last tenth of its window of "
      "{:.3g} s: the motion is cut off, soil mobility --window gives a longer one\n",
      100 * rest.share, rest.where, rest.window);
}

void warn_of_unusual_values(const fs::path& path, const Site& site) {
  for (const std::string& unusual : unusual_values(site)) {
    fmt::print(stderr, "soil: warning: {}: {}\n", path.string(), unusual);
  }
}

}  // namespace easydyn::soil

#pragma once

// Private to soil: the commands of the program `soil`.

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "soil/run_control.hpp"
#include "soil/vibrations.hpp"
#include "soil/wave_solver.hpp"

namespace easydyn::soil {

/// A command: options on the command line, and what to do with them.
/// @returns the exit status
using Action = std::function<int(const std::string& command_line)>;

Action add_mobility_command(CLI::App& app);
Action add_predict_command(CLI::App& app);

/// @throws InputError if the folder cannot be made
void make_folder(const std::filesystem::path& folder);
/// Renames an earlier file or folder, so that it does not look like this run's: vibrations.h5 becomes vibrations.previous.h5.
/// @returns whether there was one  @throws InputError if that is not possible
bool set_aside(const std::filesystem::path& result);

/// Options that all runs of the finite elements have: threads, degree, precision, boundary, crossover.
void add_element_options(CLI::App& command, SolverOptions& options);
/// Of the option --damping: constant, stiffness or none. @throws InputError for another name
DampingModel find_damping_model(const std::string& name);
/// A run with this checkpoint that SIGINT and SIGTERM stop, and whose warnings go to standard error.
RunControl make_control(const std::filesystem::path& checkpoint);
/// What `run` does, with an end before the end on SIGINT and SIGTERM. @returns the exit status
int run_stoppable(const std::function<void()>& run, const std::string& command_to_go_on,
                  class Ranks* ranks = nullptr);
/// The semi-analytical motion beside a prediction as a table.
void print_comparison(const Vibrations& vibrations);

/// Makes the folder and renames the `vibrations.h5` of an earlier run, so that it does not look like this run's.
/// @returns path of the result to come  @throws InputError if that is not possible
std::filesystem::path prepare_result(const std::filesystem::path& folder);

/// The files in their order, for messages.
std::string join_names(const std::vector<std::filesystem::path>& files);

/// Warning on standard error of responses that have not died out within their window.
void warn_of_rest(const struct ResponseRest& rest);

/// Warnings on standard error about values of the site that look like a wrong unit.
void warn_of_unusual_values(const std::filesystem::path& path, const Site& site);

inline const char* const result_convention =
    "SI units; x along the track, y to the left, z up; footprints downward";

}  // namespace easydyn::soil

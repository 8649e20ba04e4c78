#pragma once

// Private to soil: the commands of the program `soil`.

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace easydyn::soil {

/// A command: options on the command line, and what to do with them.
using Action = std::function<void(const std::string& command_line)>;

Action add_mobility_command(CLI::App& app);
Action add_predict_command(CLI::App& app);

/// @throws InputError if the folder cannot be made
void make_folder(const std::filesystem::path& folder);
/// Renames an earlier file or folder, so that it does not look like this run's: vibrations.h5 becomes vibrations.previous.h5.
/// @returns whether there was one  @throws InputError if that is not possible
bool set_aside(const std::filesystem::path& result);

/// Makes the folder and renames the `vibrations.h5` of an earlier run, so that it does not look like this run's.
/// @returns path of the result to come  @throws InputError if that is not possible
std::filesystem::path prepare_result(const std::filesystem::path& folder);

/// The files in their order, for messages.
std::string join_names(const std::vector<std::filesystem::path>& files);

/// Warnings on standard error about values of the site that look like a wrong unit.
void warn_of_unusual_values(const std::filesystem::path& path, const struct Site& site);

inline const char* const result_convention =
    "SI units; x along the track, y to the left, z up; footprints downward";

}  // namespace easydyn::soil

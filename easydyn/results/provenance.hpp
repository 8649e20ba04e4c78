#pragma once

#include <string>

namespace easydyn::results {

/// Who made a result file, how and in which convention; stored as attributes of the HDF5 root.
struct Provenance {
  std::string program{};     ///< e.g. "tram"
  std::string command{};     ///< command line as given, see join_command_line()
  std::string convention{};  ///< axes and signs, one sentence
  std::string version{};     ///< empty: the version of the library
  std::string created{};     ///< ISO 8601 UTC; empty: now
};

/// Version of this library, e.g. "2.0.0".
std::string library_version();

/// The present time in ISO 8601, UTC, to the second: "2026-01-31T14:05:09Z".
std::string current_time_utc();

/// The arguments of main() as one line that a shell would split again in the same way.
std::string join_command_line(int argc, const char* const* argv);

}  // namespace easydyn::results

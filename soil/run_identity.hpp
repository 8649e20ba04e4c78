#pragma once

#include <string>
#include <vector>

#include "soil/site.hpp"
#include "soil/surface_loads.hpp"

namespace easydyn::soil {

struct SolverOptions;

/// One thing that two runs must have in common for one to go on where the other stopped, with the same bits.
struct RunTrait {
  std::string name;   ///< e.g. "site", "option degree"
  std::string value;  ///< a number, a word or a checksum
};
using RunIdentity = std::vector<RunTrait>;

/// Version of the program, width of the vector registers, site (text and values), loads and options.
RunIdentity describe_run(const Site& site, const SurfaceLoads& loads, const SolverOptions& options);

/// The first difference as a sentence, e.g. "option degree was 4, is 5"; empty if there is none.
std::string find_difference(const RunIdentity& before, const RunIdentity& now);

}  // namespace easydyn::soil

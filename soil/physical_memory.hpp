#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <string>

#include "easydyn/error.hpp"

namespace easydyn::soil {

/// Memory of this machine [byte].
inline double physical_memory() {
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
}

/// @param what    needs it, in the plural
/// @param remedy  what to do where there is not enough
/// @throws ModelError if `bytes` are more than 80 % of this machine's memory
inline void require_memory(double bytes, const std::string& what, const std::string& remedy) {
  const double limit = 0.8 * physical_memory();
  if (!(bytes <= limit)) {
    throw ModelError(fmt::format("{} need {:.3g} GB of memory, must be at most {:.3g} GB: {}", what,
                                 bytes * 1e-9, limit * 1e-9, remedy));
  }
}

}  // namespace easydyn::soil

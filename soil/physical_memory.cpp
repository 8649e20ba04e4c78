#include "soil/physical_memory.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "easydyn/error.hpp"
#include "soil/cgroup_memory.hpp"

namespace easydyn::soil {

double physical_memory() {
  std::ostringstream groups;
  groups << std::ifstream("/proc/self/cgroup").rdbuf();
  return std::min(static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE)),
                  find_cgroup_memory(groups.str()));
}

void require_memory(double bytes, const std::string& what, const std::string& remedy, double limit) {
  if (limit == 0) limit = 0.8 * physical_memory();
  if (!(bytes <= limit)) {
    throw ModelError(fmt::format("{} need {:.3g} GB of memory, must be at most {:.3g} GB: {}", what,
                                 bytes * 1e-9, limit * 1e-9, remedy));
  }
}

}  // namespace easydyn::soil

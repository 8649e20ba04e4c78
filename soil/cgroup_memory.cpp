#include "soil/cgroup_memory.hpp"

#include <algorithm>
#include <fstream>
#include <limits>
#include <sstream>

namespace easydyn::soil {
namespace {

namespace fs = std::filesystem;

// "max" and files that are not there set no limit.
double read_limit(const fs::path& file) {
  double limit = 0;
  return std::ifstream(file) >> limit ? limit : std::numeric_limits<double>::infinity();
}

// Of the group at `path` below `mount` and those above it.
double find_smallest_limit(const fs::path& mount, const fs::path& path, const char* file) {
  double smallest = read_limit(mount / file);
  fs::path group = mount;
  for (const fs::path& name : path.relative_path()) {
    group /= name;
    smallest = std::min(smallest, read_limit(group / file));
  }
  return smallest;
}

bool has_memory(const std::string& controllers) {
  std::istringstream names(controllers);
  for (std::string name; std::getline(names, name, ',');)
    if (name == "memory") return true;
  return false;
}

}  // namespace

double find_cgroup_memory(const std::string& groups, const fs::path& root) {
  double smallest = std::numeric_limits<double>::infinity();
  std::istringstream lines(groups);
  for (std::string number, controllers, path; std::getline(lines, number, ':') &&
                                              std::getline(lines, controllers, ':') &&
                                              std::getline(lines, path);) {
    if (controllers.empty()) smallest = std::min(smallest, find_smallest_limit(root, path, "memory.max"));
    if (has_memory(controllers))
      smallest = std::min(smallest, find_smallest_limit(root / "memory", path, "memory.limit_in_bytes"));
  }
  return smallest;
}

}  // namespace easydyn::soil

#pragma once

#include <filesystem>
#include <string>

namespace easydyn::soil {

/// Memory that the control groups of a process leave it [byte]; infinity where none of them sets a limit.
///
/// The smallest `memory.max` (version 2) or `memory.limit_in_bytes` (version 1) of its group and those above it. A
/// container may show the process the name that its group has outside: folders of that name that are not there are
/// passed over, and the group at `root` counts.
/// Linux documentation, Control Group v2, "Memory Interface Files", and Memory Resource Controller (v1).
/// @param groups  text of /proc/self/cgroup: lines "number:controllers:path"; no controllers: version 2
/// @param root    where control groups are mounted
double find_cgroup_memory(const std::string& groups, const std::filesystem::path& root = "/sys/fs/cgroup");

}  // namespace easydyn::soil

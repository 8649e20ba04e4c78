#pragma once

#include <filesystem>
#include <string>

namespace easydyn::soil {

/// Bytes as people read them: "12 MB", "3.4 GB".
std::string format_bytes(double bytes);

/// @param folder  where files are to be written; empty: the current one; where it does not exist yet, the folder above it
///                counts
/// @param what    what they are, e.g. "snapshots and checkpoint"
/// @throws InputError if the disk has less than `bytes` free
void require_disk_space(const std::filesystem::path& folder, double bytes, const std::string& what);

}  // namespace easydyn::soil

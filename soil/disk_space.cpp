#include "soil/disk_space.hpp"

#include <fmt/format.h>

#include "easydyn/error.hpp"

namespace easydyn::soil {

std::string format_bytes(double bytes) {
  if (bytes < 1e6) return fmt::format("{:.0f} kB", bytes / 1e3);
  return bytes < 1e9 ? fmt::format("{:.0f} MB", bytes / 1e6) : fmt::format("{:.1f} GB", bytes / 1e9);
}

void require_disk_space(const std::filesystem::path& folder, double bytes, const std::string& what) {
  std::error_code error;
  const std::filesystem::path named = folder.empty() ? "." : folder;  // of a file without folder
  std::filesystem::path existing = std::filesystem::absolute(named);
  while (!std::filesystem::exists(existing, error) && existing.has_relative_path())
    existing = existing.parent_path();
  const std::filesystem::space_info space = std::filesystem::space(existing, error);
  if (error)
    throw InputError(
        fmt::format("{}: the space on its disk is not known, {}", named.string(), error.message()));
  const auto available = static_cast<double>(space.available);
  if (!(bytes <= available))
    throw InputError(fmt::format("{}: {} need {}, must be at most {}, what is free on the disk",
                                 named.string(), what, format_bytes(bytes), format_bytes(available)));
}

}  // namespace easydyn::soil

#include "soil/commands.hpp"

#include <fmt/format.h>

#include <system_error>

#include "easydyn/error.hpp"
#include "soil/site.hpp"

namespace easydyn::soil {

namespace fs = std::filesystem;

fs::path prepare_result(const fs::path& folder) {
  const fs::path result = folder / "vibrations.h5";
  std::error_code error;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder)) {
    throw InputError(fmt::format("{}: cannot be made a folder, {}", folder.string(), error.message()));
  }
  const fs::path previous = folder / "vibrations.previous.h5";
  if (fs::exists(result, error)) {
    fs::rename(result, previous, error);
    if (error) {
      throw InputError(fmt::format("{}: cannot be renamed to {}, {}", result.string(), previous.string(),
                                   error.message()));
    }
  }
  return result;
}

void warn_of_unusual_values(const fs::path& path, const Site& site) {
  for (const std::string& unusual : unusual_values(site)) {
    fmt::print(stderr, "soil: warning: {}: {}\n", path.string(), unusual);
  }
}

}  // namespace easydyn::soil

#include "soil/commands.hpp"

#include <fmt/format.h>

#include <system_error>

#include "easydyn/error.hpp"
#include "soil/site.hpp"

namespace easydyn::soil {

namespace fs = std::filesystem;

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder)) {
    throw InputError(fmt::format("{}: cannot be made a folder, {}", folder.string(), error.message()));
  }
}

bool set_aside(const fs::path& result) {
  fs::path previous = result;
  previous.replace_filename(result.stem().string() + ".previous" + result.extension().string());
  std::error_code error;
  if (!fs::exists(result, error)) return false;
  if (fs::is_directory(result, error)) fs::remove_all(previous, error);  // only files are replaced
  fs::rename(result, previous, error);
  if (error) {
    throw InputError(
        fmt::format("{}: cannot be renamed to {}, {}", result.string(), previous.string(), error.message()));
  }
  return true;
}

fs::path prepare_result(const fs::path& folder) {
  const fs::path result = folder / "vibrations.h5";
  make_folder(folder);
  set_aside(result);
  return result;
}

std::string join_names(const std::vector<fs::path>& files) {
  std::string names;
  for (const fs::path& file : files) names += (names.empty() ? "" : ", ") + file.string();
  return names;
}

void warn_of_unusual_values(const fs::path& path, const Site& site) {
  for (const std::string& unusual : unusual_values(site)) {
    fmt::print(stderr, "soil: warning: {}: {}\n", path.string(), unusual);
  }
}

}  // namespace easydyn::soil

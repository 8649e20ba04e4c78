#include "soil/run_control.hpp"

#include <system_error>
#include <vector>

namespace easydyn::soil {

void remove_rank_checkpoints(const std::filesystem::path& checkpoint, int rank,
                             const std::filesystem::path& kept) {
  const std::string begin =
      checkpoint.stem().string() + ".rank" + (rank > 0 ? std::to_string(rank) + ".step" : std::string());
  std::vector<std::filesystem::path> found;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(
           checkpoint.has_parent_path() ? checkpoint.parent_path() : std::filesystem::path("."), ignored)) {
    const std::filesystem::path& file = entry.path();
    if (file.filename().string().starts_with(begin) && file.extension() == checkpoint.extension() &&
        file.filename() != kept.filename())
      found.push_back(file);
  }
  for (const std::filesystem::path& file : found) std::filesystem::remove(file, ignored);
}

}  // namespace easydyn::soil

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
    const std::string name = file.filename().string(), end = checkpoint.extension().string();
    if (name.starts_with(begin) && (name.ends_with(end) || name.ends_with(end + ".partial")) &&
        file.filename() != kept.filename())
      found.push_back(file);
  }
  for (const std::filesystem::path& file : found) std::filesystem::remove(file, ignored);
}

void set_rank_checkpoints_aside(const std::filesystem::path& checkpoint,
                                const std::filesystem::path& previous) {
  remove_rank_checkpoints(previous, 0);
  std::vector<std::filesystem::path> found;
  std::error_code ignored;
  const std::string begin = checkpoint.stem().string() + ".rank";
  for (const auto& entry : std::filesystem::directory_iterator(
           checkpoint.has_parent_path() ? checkpoint.parent_path() : std::filesystem::path("."), ignored))
    if (entry.path().filename().string().starts_with(begin)) found.push_back(entry.path());
  for (const std::filesystem::path& file : found) {
    const std::string rest = file.filename().string().substr(checkpoint.stem().string().size());
    std::filesystem::rename(file, file.parent_path() / (previous.stem().string() + rest), ignored);
  }
}

}  // namespace easydyn::soil

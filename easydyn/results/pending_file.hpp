#pragma once

#include <filesystem>

namespace easydyn::results {

/// A file that has no name yet: written as `path` + ".partial", it takes the name `path` in commit().
/// Destroyed before that, the partial file is removed; killed before that, the next run overwrites it.
/// A file that existed under `path` stays untouched until commit() replaces it in one step.
class PendingFile {
 public:
  /// @throws InputError if the folder of `path` does not exist, or `path` is a folder
  explicit PendingFile(std::filesystem::path path);
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  const std::filesystem::path& partial_path() const { return partial_path_; }  ///< write here

  /// Gives the closed partial file its name. @throws InputError if that is not possible
  void commit();

 private:
  std::filesystem::path path_, partial_path_;
  bool committed_ = false;
};

}  // namespace easydyn::results

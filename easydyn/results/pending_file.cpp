#include "easydyn/results/pending_file.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "easydyn/error.hpp"

namespace easydyn::results {

PendingFile::PendingFile(std::filesystem::path path) : path_(std::move(path)), partial_path_(path_) {
  partial_path_ += ".partial";
  const std::filesystem::path folder = path_.has_parent_path() ? path_.parent_path() : ".";
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored)) {
    throw InputError(fmt::format("{}: cannot be written, no folder \"{}\"", path_.string(), folder.string()));
  }
  if (path_.filename().empty() || std::filesystem::is_directory(path_, ignored)) {
    throw InputError(fmt::format("{}: cannot be written, it is a folder", path_.string()));
  }
}

PendingFile::~PendingFile() {
  if (!committed_) {
    std::error_code ignored;
    std::filesystem::remove(partial_path_, ignored);
  }
}

void PendingFile::commit() {
  std::error_code error;
  std::filesystem::rename(partial_path_, path_, error);
  if (error) {
    throw InputError(fmt::format("{}: cannot be written, {}", path_.string(), error.message()));
  }
  committed_ = true;
}

}  // namespace easydyn::results

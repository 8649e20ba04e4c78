#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <type_traits>

#include "easydyn/results/pending_file.hpp"
#include "soil/checksum.hpp"
#include "soil/run_identity.hpp"

namespace easydyn::soil {

/// A checkpoint in the making: the identity of the run, then whatever is written, then a checksum of all of it
/// (docs/formats.md). It is written under a temporary name, brought to the disk and only then renamed: under
/// `path` stands the earlier checkpoint or the new one, always whole.
/// @throws InputError if the file cannot be written
class CheckpointWriter {
 public:
  CheckpointWriter(const std::filesystem::path& path, const RunIdentity& identity);

  void write(const void* data, std::size_t bytes);
  template <class T>
  void write_value(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    write(&value, sizeof value);
  }
  void commit();

 private:
  [[noreturn]] void fail() const;

  results::PendingFile pending_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  Checksum checksum_;
};

/// A checkpoint to go on from; the parts come in the order in which they were written.
/// @throws InputError naming the file if it is missing, damaged or of another run (what differs, before and now)
class CheckpointReader {
 public:
  CheckpointReader(const std::filesystem::path& path, const RunIdentity& identity);

  void read(void* data, std::size_t bytes);
  template <class T>
  void read_value(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    read(&value, sizeof value);
  }
  void finish() const;  ///< @throws InputError if something is left

 private:
  [[noreturn]] void fail(const std::string& what) const;
  void check_whole();
  std::string read_text();

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  std::uint64_t left_ = 0;  // bytes before the checksum
};

}  // namespace easydyn::soil

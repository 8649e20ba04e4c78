#include "soil/checkpoint.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <vector>

#include "easydyn/error.hpp"

namespace easydyn::soil {
namespace {

// Also tells the order of the bytes in a number.
constexpr std::uint64_t file_mark = 0x3130504353594445;  // "EDYSCP01" on a little-endian machine
constexpr std::uint64_t longest_text = 1 << 20;

}  // namespace

CheckpointWriter::CheckpointWriter(const std::filesystem::path& path, const RunIdentity& identity)
    : pending_(path), file_(std::fopen(pending_.partial_path().c_str(), "wb"), &std::fclose) {
  if (!file_) fail();
  write_value(file_mark);
  write_value(std::uint64_t{identity.size()});
  for (const RunTrait& trait : identity)
    for (const std::string& text : {trait.name, trait.value}) {
      write_value(std::uint64_t{text.size()});
      write(text.data(), text.size());
    }
}

void CheckpointWriter::write(const void* data, std::size_t bytes) {
  checksum_.add(data, bytes);
  if (std::fwrite(data, 1, bytes, file_.get()) != bytes) fail();
}

void CheckpointWriter::commit() {
  const std::uint64_t checksum = checksum_.value();
  if (std::fwrite(&checksum, sizeof checksum, 1, file_.get()) != 1 || std::fflush(file_.get()) != 0 ||
      fsync(fileno(file_.get())) != 0 || std::fclose(file_.release()) != 0)
    fail();
  pending_.commit();
}

void CheckpointWriter::fail() const {
  throw InputError(fmt::format("{}: the checkpoint cannot be written, {}", pending_.path().string(),
                               std::strerror(errno)));
}

CheckpointReader::CheckpointReader(const std::filesystem::path& path, const RunIdentity& identity)
    : path_(path), file_(std::fopen(path.c_str(), "rb"), &std::fclose) {
  if (!file_)
    fail(fmt::format("cannot be read, {}: there is no checkpoint to go on from", std::strerror(errno)));
  check_whole();
  std::uint64_t mark = 0, count = 0;
  read_value(mark);
  if (mark != file_mark) fail("is no checkpoint of this program");
  read_value(count);
  RunIdentity before;
  for (std::uint64_t i = 0; i < count; ++i) {
    std::string name = read_text();
    before.push_back({std::move(name), read_text()});
  }
  if (const std::string difference = find_difference(before, identity); !difference.empty())
    fail("belongs to another run: " + difference);
}

// Nothing is used before all of it is known to be what was written.
void CheckpointReader::check_whole() {
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(path_, error);
  if (error) fail("cannot be read, " + error.message());
  if (size < 2 * sizeof(std::uint64_t)) fail(fmt::format("is damaged: {} bytes", size));
  left_ = size - sizeof(std::uint64_t);
  Checksum checksum;
  std::vector<char> buffer(1 << 20);
  const std::uint64_t content = left_;
  while (left_ > 0) {
    const std::size_t bytes = std::min<std::uint64_t>(buffer.size(), left_);
    read(buffer.data(), bytes);
    checksum.add(buffer.data(), bytes);
  }
  std::uint64_t stored = 0;
  left_ = sizeof stored;
  read_value(stored);
  if (stored != checksum.value())
    fail(fmt::format("is damaged: its checksum is {:016x}, must be {:016x}", checksum.value(), stored));
  std::rewind(file_.get());
  left_ = content;
}

void CheckpointReader::read(void* data, std::size_t bytes) {
  if (bytes > left_) fail("is damaged: it ends too early");
  if (std::fread(data, 1, bytes, file_.get()) != bytes) fail("cannot be read to its end");
  left_ -= bytes;
}

std::string CheckpointReader::read_text() {
  std::uint64_t size = 0;
  read_value(size);
  if (size > longest_text) fail("is damaged: a text that is too long");
  std::string text(size, '\0');
  read(text.data(), size);
  return text;
}

void CheckpointReader::finish() const {
  if (left_ != 0) fail(fmt::format("is damaged: {} bytes too many", left_));
}

void CheckpointReader::fail(const std::string& what) const {
  throw InputError(fmt::format("{}: {}", path_.string(), what));
}

}  // namespace easydyn::soil

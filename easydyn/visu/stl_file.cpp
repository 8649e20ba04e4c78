#include "easydyn/visu/stl_file.hpp"

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string_view>

#include "easydyn/error.hpp"

namespace easydyn::visu {

namespace {

constexpr std::size_t header_size = 84,
                      record_size = 50;  // 80 bytes and a count; normal, three corners, 2 bytes
static_assert(std::endian::native == std::endian::little, "STL files are little-endian");

template <class T>
T value_at(const std::string& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

// A text file may start as a binary one does: only the size tells.
bool is_binary(const std::string& bytes) {
  return bytes.size() >= header_size &&
         bytes.size() == header_size + record_size * std::size_t{value_at<std::uint32_t>(bytes, 80)};
}

std::vector<float> corners_of_binary(const std::string& bytes) {
  std::vector<float> corners;
  corners.reserve((bytes.size() - header_size) / record_size * 9);
  for (std::size_t at = header_size; at < bytes.size(); at += record_size)
    for (std::size_t i = 0; i < 9; ++i) corners.push_back(value_at<float>(bytes, at + 12 + 4 * i));
  return corners;
}

// The three numbers after every word "vertex".
std::vector<float> corners_of_text(std::string_view text, const std::string& file) {
  std::vector<float> corners;
  const auto next_word = [&] {
    const std::size_t from = std::min(text.find_first_not_of(" \t\r\n"), text.size());
    const std::size_t to = std::min(text.find_first_of(" \t\r\n", from), text.size());
    const std::string_view word = text.substr(from, to - from);
    text.remove_prefix(to);
    return word;
  };
  if (next_word() != "solid") throw InputError(fmt::format("{}: neither a binary nor a text STL file", file));
  for (std::string_view word = next_word(); !word.empty(); word = next_word()) {
    if (word != "vertex") continue;
    for (int i = 0; i < 3; ++i) {
      std::string_view number = next_word();
      if (!number.empty() && number.front() == '+') number.remove_prefix(1);
      float x = 0;
      const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), x);
      if (error != std::errc() || end != number.data() + number.size())
        throw InputError(
            fmt::format("{}: vertex {}: \"{}\" is no number", file, corners.size() / 3 + 1, number));
      corners.push_back(x);
    }
  }
  return corners;
}

}  // namespace

std::vector<float> read_stl(const std::filesystem::path& file, const Eigen::Vector3d& scale) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream content;
  if (!(stream && content << stream.rdbuf()))
    throw InputError(fmt::format("{}: empty or cannot be read", file.string()));
  const std::string bytes = content.str();
  std::vector<float> corners =
      is_binary(bytes) ? corners_of_binary(bytes) : corners_of_text(bytes, file.string());
  if (corners.empty() || corners.size() % 9 != 0)
    throw InputError(
        fmt::format("{}: {} corners of triangles, must be 3, 6, 9, ...", file.string(), corners.size() / 3));
  const bool is_mirrored = scale.prod() < 0;
  for (std::size_t i = 0; i < corners.size(); i += 9) {
    for (std::size_t k = 0; k < 9; ++k) {
      float& x = corners[i + k];
      x = static_cast<float>(x * scale[static_cast<Eigen::Index>(k % 3)]);
      if (!std::isfinite(x))
        throw InputError(fmt::format("{}: triangle {}: {} is not finite", file.string(), i / 9 + 1, x));
    }
    if (is_mirrored) std::swap_ranges(&corners[i], &corners[i + 3], &corners[i + 3]);
  }
  return corners;
}

}  // namespace easydyn::visu

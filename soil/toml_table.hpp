#pragma once

// Private to soil and track_on_soil: the only header that sees toml++.

#include <toml++/toml.h>

#include <array>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace easydyn::soil {

/// The numbers that a key accepts, finite ones only.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool includes_low = true;
  bool includes_high = true;

  bool contains(double value) const;
  std::string description() const;  ///< e.g. "> 0", ">= 0 and < 0.2", "finite"
};
inline constexpr Range any_number{};
inline constexpr Range positive{.low = 0, .includes_low = false};
inline constexpr Range not_negative{.low = 0};

/// One table of a TOML file, read key by key. Every fault becomes an InputError
/// `file:line:column: object: key = value, must be ...`.
class TomlTable {
 public:
  /// @param file    the file, as it appears in messages
  /// @param object  what the table describes, as it appears in messages, e.g. `layer "clay"`
  TomlTable(const std::filesystem::path& file, std::string object, const toml::table& table)
      : file_(file), object_(std::move(object)), table_(table) {}

  void set_object(std::string object) { object_ = std::move(object); }
  const std::string& object() const { return object_; }

  /// To be called first. @throws InputError at the first other key, with the nearest known one
  void refuse_other_keys(const std::vector<std::string>& known) const;

  bool has(std::string_view key) const;
  double number(std::string_view key, const char* unit,
                const Range& range) const;  ///< a key that must be there
  double number(std::string_view key, const char* unit, const Range& range, double otherwise) const;
  std::string text(std::string_view key) const;  ///< a key that must be there, not empty
  std::string text(std::string_view key, std::string otherwise) const;        ///< may be empty
  std::vector<double> numbers(std::string_view key, const char* unit) const;  ///< an array of finite numbers
  bool flag(std::string_view key, bool otherwise) const;
  /// An array of two ascending numbers, which may be infinite where `may_be_infinite`.
  std::array<double, 2> interval(std::string_view key, const char* unit, bool may_be_infinite) const;
  /// The table behind a key; an empty one if there is none.
  TomlTable table(std::string_view key) const;
  /// The tables of [[key]], in their order; each is called `key 1`, `key 2`, ... in messages.
  std::vector<TomlTable> tables(std::string_view key) const;

  [[noreturn]] void fail(const std::string& what) const;                        ///< at the table
  [[noreturn]] void fail(std::string_view key, const std::string& what) const;  ///< at the value of a key

 private:
  const toml::node* find(std::string_view key) const;
  const toml::node& get(std::string_view key) const;
  double check_number(std::string_view key, const toml::node& node, const char* unit,
                      const Range& range) const;
  std::string check_text(std::string_view key, const toml::node& node) const;
  [[noreturn]] void fail_at(const toml::source_region& where, const std::string& what) const;
  [[noreturn]] void fail_type(std::string_view key, const toml::node& node, const char* expected) const;

  std::filesystem::path file_;
  std::string object_;
  std::reference_wrapper<const toml::table> table_;
};

}  // namespace easydyn::soil

#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace easydyn::visu::json {

/// A JSON value. Objects keep the order of their members; numbers that are not finite are written as null.
///
///   json::object({{"name", "ballast"}, {"stiffness", 32.5e6}}).text()
///   {"name":"ballast","stiffness":32500000.0}
class Value {
 public:
  using Array = std::vector<Value>;
  using Object = std::vector<std::pair<std::string, Value>>;

  Value() = default;  ///< null
  Value(bool value) : data_(value) {}
  Value(double value) : data_(value) {}
  Value(int value) : data_(double(value)) {}
  Value(const char* value) : data_(std::string(value)) {}
  Value(std::string value) : data_(std::move(value)) {}
  Value(Array value) : data_(std::move(value)) {}
  Value(Object value) : data_(std::move(value)) {}

  bool is_null() const { return std::holds_alternative<std::monostate>(data_); }
  bool has(std::string_view member) const;  ///< false, too, if this is no object

  /// @throws InputError naming what was expected
  bool boolean() const;
  double number() const;
  const std::string& string() const;
  const Array& array() const;
  const Object& members() const;
  const Value& at(std::string_view member) const;  ///< names the member if it is missing

  std::string text() const;

 private:
  void append_to(std::string& out) const;
  std::variant<std::monostate, bool, double, std::string, Array, Object> data_;
};

inline Value object(Value::Object members) {
  return Value(std::move(members));
}

/// @throws InputError `source:line:column: message`
Value parse(std::string_view text, const std::string& source);

/// The text as a JSON string, with its quotes.
std::string quoted(std::string_view text);

/// Little-endian float32 numbers as base64; NaN is kept.
std::string base64(const std::vector<float>& numbers);
/// @throws InputError if the text is no base64 of float32 numbers
std::vector<float> floats_from_base64(std::string_view text);

}  // namespace easydyn::visu::json

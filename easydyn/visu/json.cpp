#include "easydyn/visu/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "easydyn/error.hpp"

namespace easydyn::visu::json {

namespace {

constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Recursive descent over one text; every error says where.
class Parser {
 public:
  Parser(std::string_view text, const std::string& source) : text_(text), source_(source) {}

  Value parse_document() {
    Value value = parse_value(0);
    skip_blanks();
    if (at_ != text_.size()) fail("expected the end of the text");
    return value;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    const std::string_view before = text_.substr(0, at_);
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const size_t line_start = before.rfind('\n') + 1;  // npos + 1 = 0
    throw InputError(fmt::format("{}:{}:{}: {}", source_, line, at_ - line_start + 1, message));
  }

  void skip_blanks() {
    while (at_ < text_.size() && std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos)
      ++at_;
  }

  bool take(std::string_view word) {
    if (text_.substr(at_, word.size()) != word) return false;
    at_ += word.size();
    return true;
  }

  Value parse_value(int depth) {
    if (depth > 100) fail("nested more than 100 levels deep");
    skip_blanks();
    if (at_ == text_.size()) fail("expected a value, found the end of the text");
    if (take("null")) return {};
    if (take("true")) return true;
    if (take("false")) return false;
    if (text_[at_] == '"') return parse_string();
    if (take("[")) return parse_array(depth);
    if (take("{")) return parse_object(depth);
    return parse_number();
  }

  Value parse_array(int depth) {
    Value::Array values;
    skip_blanks();
    if (take("]")) return values;
    while (true) {
      values.push_back(parse_value(depth + 1));
      skip_blanks();
      if (take("]")) return values;
      if (!take(",")) fail("expected ',' or ']'");
    }
  }

  Value parse_object(int depth) {
    Value::Object members;
    skip_blanks();
    if (take("}")) return members;
    while (true) {
      skip_blanks();
      if (text_.substr(at_, 1) != "\"") fail("expected the name of a member");
      std::string name = parse_string();
      skip_blanks();
      if (!take(":")) fail("expected ':'");
      members.emplace_back(std::move(name), parse_value(depth + 1));
      skip_blanks();
      if (take("}")) return members;
      if (!take(",")) fail("expected ',' or '}'");
    }
  }

  Value parse_number() {
    double number = 0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), number);
    if (error != std::errc() || !std::isfinite(number)) fail("expected a value");
    at_ = size_t(end - text_.data());
    return number;
  }

  std::string parse_string() {
    std::string out;
    ++at_;  // the opening quote
    while (true) {
      if (at_ == text_.size()) fail("a string has no end");
      const char c = text_[at_];
      if (static_cast<unsigned char>(c) < 0x20) fail("a control character in a string");
      ++at_;
      if (c == '"') return out;
      if (c == '\\')
        parse_escape(out);
      else
        out += c;
    }
  }

  void parse_escape(std::string& out) {
    const char c = at_ < text_.size() ? text_[at_++] : '\0';
    constexpr std::string_view names = "\"\\/bfnrt", meanings = "\"\\/\b\f\n\r\t";
    if (c == 'u') {
      uint32_t code = parse_hex4();
      if (code >= 0xD800 && code < 0xE000) {  // two halves make one character
        const uint32_t second = code < 0xDC00 && take("\\u") ? parse_hex4() : 0;
        if (second < 0xDC00 || second >= 0xE000) fail("half of a surrogate pair");
        code = 0x10000 + ((code - 0xD800) << 10) + (second - 0xDC00);
      }
      append_utf8(out, code);
    } else if (const size_t i = names.find(c); c != '\0' && i != names.npos) {
      out += meanings[i];
    } else {
      fail("unknown escape in a string");
    }
  }

  uint32_t parse_hex4() {
    uint32_t code = 0;
    const std::string_view digits = text_.substr(at_, 4);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), code, 16);
    if (error != std::errc() || digits.size() != 4 || end != digits.data() + 4)
      fail("expected four hex digits");
    at_ += 4;
    return code;
  }

  static void append_utf8(std::string& out, uint32_t code) {
    if (code < 0x80) {
      out += char(code);
    } else if (code < 0x800) {
      out += char(0xC0 | (code >> 6));
      out += char(0x80 | (code & 0x3F));
    } else if (code < 0x10000) {
      out += char(0xE0 | (code >> 12));
      out += char(0x80 | ((code >> 6) & 0x3F));
      out += char(0x80 | (code & 0x3F));
    } else {
      out += char(0xF0 | (code >> 18));
      out += char(0x80 | ((code >> 12) & 0x3F));
      out += char(0x80 | ((code >> 6) & 0x3F));
      out += char(0x80 | (code & 0x3F));
    }
  }

  std::string_view text_;
  std::string source_;
  size_t at_ = 0;
};

}  // namespace

bool Value::has(std::string_view member) const {
  const auto* object = std::get_if<Object>(&data_);
  return object && std::any_of(object->begin(), object->end(), [&](auto& m) { return m.first == member; });
}

bool Value::boolean() const {
  if (const auto* value = std::get_if<bool>(&data_)) return *value;
  throw InputError("JSON: expected true or false, found " + text().substr(0, 40));
}

double Value::number() const {
  if (const auto* value = std::get_if<double>(&data_)) return *value;
  throw InputError("JSON: expected a number, found " + text().substr(0, 40));
}

const std::string& Value::string() const {
  if (const auto* value = std::get_if<std::string>(&data_)) return *value;
  throw InputError("JSON: expected a string, found " + text().substr(0, 40));
}

const Value::Array& Value::array() const {
  if (const auto* value = std::get_if<Array>(&data_)) return *value;
  throw InputError("JSON: expected an array, found " + text().substr(0, 40));
}

const Value::Object& Value::members() const {
  if (const auto* value = std::get_if<Object>(&data_)) return *value;
  throw InputError("JSON: expected an object, found " + text().substr(0, 40));
}

const Value& Value::at(std::string_view member) const {
  for (const auto& [name, value] : members())
    if (name == member) return value;
  throw InputError(fmt::format("JSON: member \"{}\" is missing", member));
}

std::string Value::text() const {
  std::string out;
  append_to(out);
  return out;
}

void Value::append_to(std::string& out) const {
  if (const auto* boolean = std::get_if<bool>(&data_)) {
    out += *boolean ? "true" : "false";
  } else if (const auto* number = std::get_if<double>(&data_)) {
    out += std::isfinite(*number) ? fmt::format("{}", *number) : "null";
  } else if (const auto* string = std::get_if<std::string>(&data_)) {
    out += json::quoted(*string);
  } else if (const auto* array = std::get_if<Array>(&data_)) {
    out += '[';
    for (const Value& value : *array) {
      if (&value != array->data()) out += ',';
      value.append_to(out);
    }
    out += ']';
  } else if (const auto* object = std::get_if<Object>(&data_)) {
    out += '{';
    for (const auto& member : *object) {
      if (&member != object->data()) out += ',';
      out += json::quoted(member.first) + ':';
      member.second.append_to(out);
    }
    out += '}';
  } else {
    out += "null";
  }
}

Value parse(std::string_view text, const std::string& source) {
  return Parser(text, source).parse_document();
}

std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    switch (c) {
      case '"':
        out += "\\\"";
        break;
      case '\\':
        out += "\\\\";
        break;
      case '\n':
        out += "\\n";
        break;
      case '\r':
        out += "\\r";
        break;
      case '\t':
        out += "\\t";
        break;
      default:
        if (static_cast<unsigned char>(c) < 0x20)
          out += fmt::format("\\u{:04x}", int(c));
        else
          out += c;
    }
  }
  return out + '"';
}

static_assert(std::endian::native == std::endian::little, "arrays are stored as the processor holds them");
static_assert(std::numeric_limits<float>::is_iec559 && sizeof(float) == 4);

std::string base64(const std::vector<float>& numbers) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(numbers.data());
  const size_t size = numbers.size() * sizeof(float);
  std::string out;
  out.reserve((size + 2) / 3 * 4);
  for (size_t i = 0; i < size; i += 3) {
    const size_t left = std::min<size_t>(3, size - i);
    const uint32_t triple = uint32_t(bytes[i]) << 16 | (left > 1 ? uint32_t(bytes[i + 1]) << 8 : 0u) |
                            (left > 2 ? uint32_t(bytes[i + 2]) : 0u);
    out += alphabet[triple >> 18];
    out += alphabet[(triple >> 12) & 63];
    out += left > 1 ? alphabet[(triple >> 6) & 63] : '=';
    out += left > 2 ? alphabet[triple & 63] : '=';
  }
  return out;
}

std::vector<float> floats_from_base64(std::string_view text) {
  std::array<int, 256> value_of;
  value_of.fill(-1);
  for (size_t i = 0; i < alphabet.size(); ++i) value_of[static_cast<unsigned char>(alphabet[i])] = int(i);

  // four characters of six bits make three bytes
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  std::vector<unsigned char> bytes;
  bytes.reserve(text.size() * 3 / 4);
  uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const int value = value_of[static_cast<unsigned char>(c)];
    if (value < 0) throw InputError(fmt::format("base64: unexpected character '{}'", c));
    bits = bits << 6 | uint32_t(value);
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes.push_back(static_cast<unsigned char>(bits >> count));
    }
  }
  if (bytes.size() % sizeof(float) != 0)
    throw InputError(fmt::format("base64: {} bytes are no whole number of float32", bytes.size()));
  std::vector<float> numbers(bytes.size() / sizeof(float));
  if (!bytes.empty()) std::memcpy(numbers.data(), bytes.data(), bytes.size());
  return numbers;
}

}  // namespace easydyn::visu::json

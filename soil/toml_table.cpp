#include "soil/toml_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "easydyn/error.hpp"
#include "easydyn/nearest_name.hpp"

namespace easydyn::soil {
namespace {

std::string type_name(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return node.is_array_of_tables() ? "an array of tables" : "an array";
    case toml::node_type::string:
      return "a string";
    case toml::node_type::integer:
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "true or false";
    default:
      return "a date or a time";
  }
}

}  // namespace

bool Range::contains(double value) const {
  return std::isfinite(value) && (includes_low ? value >= low : value > low) &&
         (includes_high ? value <= high : value < high);
}

std::string Range::description() const {
  std::vector<std::string> limits;
  if (std::isfinite(low)) {
    limits.push_back(fmt::format("{} {}", includes_low ? ">=" : ">", low));
  }
  if (std::isfinite(high)) {
    limits.push_back(fmt::format("{} {}", includes_high ? "<=" : "<", high));
  }
  return limits.empty() ? "finite" : fmt::format("{}", fmt::join(limits, " and "));
}

void TomlTable::refuse_other_keys(const std::vector<std::string>& known) const {
  for (const auto& [key, node] : table_.get()) {
    if (std::find(known.begin(), known.end(), key.str()) == known.end()) {
      const std::string nearest = find_nearest(key.str(), known);
      fail_at(key.source(), fmt::format("unknown key \"{}\", {}", key.str(),
                                        nearest.empty() ? fmt::format("known are {}", fmt::join(known, ", "))
                                                        : fmt::format("did you mean \"{}\"?", nearest)));
    }
  }
}

bool TomlTable::has(std::string_view key) const {
  return find(key) != nullptr;
}

double TomlTable::number(std::string_view key, const char* unit, const Range& range) const {
  return check_number(key, get(key), unit, range);
}

double TomlTable::number(std::string_view key, const char* unit, const Range& range, double otherwise) const {
  const toml::node* node = find(key);
  return node ? check_number(key, *node, unit, range) : otherwise;
}

std::string TomlTable::text(std::string_view key) const {
  std::string text = check_text(key, get(key));
  if (text.empty()) {
    fail(key, fmt::format("{} is empty", key));
  }
  return text;
}

std::string TomlTable::text(std::string_view key, std::string otherwise) const {
  const toml::node* node = find(key);
  return node ? check_text(key, *node) : std::move(otherwise);
}

std::vector<double> TomlTable::numbers(std::string_view key, const char* unit) const {
  const toml::node& node = get(key);
  const toml::array* array = node.as_array();
  if (!array) {
    fail_type(key, node, "an array of numbers");
  }
  std::vector<double> values;
  for (const toml::node& element : *array) {
    values.push_back(check_number(fmt::format("{}[{}]", key, values.size()), element, unit, any_number));
  }
  return values;
}

bool TomlTable::flag(std::string_view key, bool otherwise) const {
  const toml::node* node = find(key);
  if (!node) return otherwise;
  if (!node->is_boolean()) {
    fail_type(key, *node, "true or false");
  }
  return *node->value<bool>();
}

std::array<double, 2> TomlTable::interval(std::string_view key, const char* unit,
                                          bool may_be_infinite) const {
  const toml::node& node = get(key);
  const toml::array* array = node.as_array();
  if (!array || array->size() != 2 || !array->get(0)->is_number() || !array->get(1)->is_number()) {
    fail(key, fmt::format("{} must be an array of two numbers [{}]: from, to", key, unit));
  }
  const std::array<double, 2> ends{*array->get(0)->value<double>(), *array->get(1)->value<double>()};
  const bool is_finite = std::isfinite(ends[0]) && std::isfinite(ends[1]);
  if (!(ends[0] < ends[1]) || !(is_finite || may_be_infinite)) {
    fail(key, fmt::format("{} = {}..{} {}, must be {}ascending", key, ends[0], ends[1], unit,
                          may_be_infinite ? "" : "finite and "));
  }
  return ends;
}

TomlTable TomlTable::table(std::string_view key) const {
  static const toml::table nothing;
  const toml::node* node = find(key);
  if (node && !node->is_table()) {
    fail_type(key, *node, "a table");
  }
  return {file_, fmt::format("[{}]", key), node ? *node->as_table() : nothing};
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) const {
  std::vector<TomlTable> tables;
  if (const toml::node* node = find(key)) {
    if (!node->is_array_of_tables()) {
      fail(key, fmt::format("{} is {}, must be [[{}]]", key, type_name(*node), key));
    }
    for (const toml::node& element : *node->as_array()) {
      tables.emplace_back(file_, fmt::format("{} {}", key, tables.size() + 1), *element.as_table());
    }
  }
  return tables;
}

void TomlTable::fail(const std::string& what) const {
  fail_at(table_.get().source(), what);
}

void TomlTable::fail(std::string_view key, const std::string& what) const {
  const toml::node* node = table_.get().get(key);
  fail_at(node ? node->source() : table_.get().source(), what);
}

const toml::node* TomlTable::find(std::string_view key) const {
  return table_.get().get(key);
}

const toml::node& TomlTable::get(std::string_view key) const {
  const toml::node* node = find(key);
  if (!node) {
    fail(fmt::format("\"{}\" is missing", key));
  }
  return *node;
}

double TomlTable::check_number(std::string_view key, const toml::node& node, const char* unit,
                               const Range& range) const {
  if (!node.is_number()) {
    fail_type(key, node, "a number");
  }
  const double value = *node.value<double>();
  if (!range.contains(value)) {
    std::string accepted = range.description();
    if (!std::isfinite(value) && accepted != "finite") accepted = "a finite number, " + accepted;
    fail_at(node.source(),
            fmt::format("{} = {}{}{}, must be {}", key, value, *unit ? " " : "", unit, accepted));
  }
  return value;
}

std::string TomlTable::check_text(std::string_view key, const toml::node& node) const {
  if (!node.is_string()) {
    fail_type(key, node, "a string");
  }
  return *node.value<std::string>();
}

void TomlTable::fail_at(const toml::source_region& where, const std::string& what) const {
  throw InputError(fmt::format("{}:{}:{}: {}{}{}", file_.string(), where.begin.line, where.begin.column,
                               object_, object_.empty() ? "" : ": ", what));
}

void TomlTable::fail_type(std::string_view key, const toml::node& node, const char* expected) const {
  fail_at(node.source(), fmt::format("{} is {}, must be {}", key, type_name(node), expected));
}

}  // namespace easydyn::soil

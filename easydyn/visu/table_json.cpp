#include "easydyn/visu/table_json.hpp"

#include <fmt/format.h>

#include "easydyn/error.hpp"
#include "easydyn/visu/json.hpp"

namespace easydyn::visu {

namespace {

json::Value to_value(const std::vector<std::string>& texts) {
  return json::Value(json::Value::Array(texts.begin(), texts.end()));
}

std::vector<std::string> texts_of(const json::Value& value) {
  std::vector<std::string> texts;
  for (const json::Value& text : value.array()) texts.push_back(text.string());
  return texts;
}

}  // namespace

std::string to_json(const std::vector<Table>& tables) {
  json::Value::Array list;
  for (const Table& table : tables) {
    json::Value::Array rows;
    for (const auto& row : table.rows) rows.push_back(to_value(row));
    list.push_back(json::object({{"title", table.caption},
                                 {"header", to_value(table.header)},
                                 {"rows", json::Value(std::move(rows))}}));
  }
  return json::Value(std::move(list)).text();
}

std::vector<Table> tables_from_json(const std::string& text, const std::string& source) {
  std::vector<Table> tables;
  const json::Value list = json::parse(text, source);  // lives as long as the loop
  try {
    for (const json::Value& value : list.array()) {
      Table table{texts_of(value.at("header")), {}, value.at("title").string()};
      for (const json::Value& row : value.at("rows").array()) {
        table.rows.push_back(texts_of(row));
        if (table.rows.back().size() != table.header.size())
          throw InputError(fmt::format("table \"{}\": a row of {} cells under {} headings", table.caption,
                                       table.rows.back().size(), table.header.size()));
      }
      tables.push_back(std::move(table));
    }
  } catch (const Error& error) {
    throw InputError(source + ": " + error.what());
  }
  return tables;
}

}  // namespace easydyn::visu

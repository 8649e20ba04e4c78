#include "easydyn/visu/parameter_json.hpp"

#include "easydyn/error.hpp"
#include "easydyn/visu/json.hpp"

namespace easydyn::visu {

std::string to_json(const std::vector<Parameter>& parameters) {
  json::Value::Array rows;
  for (const Parameter& p : parameters)
    rows.push_back(json::object(
        {{"group", p.group}, {"name", p.name}, {"value", p.value}, {"unit", p.unit}, {"source", p.source}}));
  return json::Value(std::move(rows)).text();
}

std::vector<Parameter> parameters_from_json(const std::string& text, const std::string& source) {
  std::vector<Parameter> parameters;
  const json::Value rows = json::parse(text, source);  // lives as long as the loop
  try {
    for (const json::Value& row : rows.array())
      parameters.push_back({row.at("group").string(), row.at("name").string(), row.at("value").number(),
                            row.at("unit").string(), row.at("source").string()});
  } catch (const Error& error) {
    throw InputError(source + ": " + error.what());
  }
  return parameters;
}

}  // namespace easydyn::visu

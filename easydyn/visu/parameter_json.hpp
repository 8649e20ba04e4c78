#pragma once

#include <string>
#include <vector>

#include "easydyn/parameter.hpp"

namespace easydyn::visu {

/// The table of parameters as result files hold it (`/parameters`): a JSON array of objects with the members
/// group, name, value, unit and source.
std::string to_json(const std::vector<Parameter>& parameters);

/// @throws InputError naming `source` and what was expected where the text is no such table
std::vector<Parameter> parameters_from_json(const std::string& text, const std::string& source);

}  // namespace easydyn::visu

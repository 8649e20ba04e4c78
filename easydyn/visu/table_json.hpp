#pragma once

#include <string>
#include <vector>

#include "easydyn/visu/report.hpp"

namespace easydyn::visu {

/// Tables as result files hold them (`/vehicle/tables`): a JSON array of objects with the members title (the
/// caption), header (texts) and rows (arrays of texts, as many as the header has).
std::string to_json(const std::vector<Table>& tables);

/// @throws InputError naming `source` and what was expected where the text holds no such tables
std::vector<Table> tables_from_json(const std::string& text, const std::string& source);

}  // namespace easydyn::visu

#pragma once

#include <string>

namespace easydyn::soil {

/// Memory that this process may take [byte]: that of the machine, or less where a control group (container, job of a
/// batch system) sets a limit.
double physical_memory();

/// @param what    needs it, in the plural
/// @param remedy  what to do where there is not enough
/// @param limit   [byte]; 0: 80 % of physical_memory()
/// @throws ModelError if `bytes` are more than the limit
void require_memory(double bytes, const std::string& what, const std::string& remedy, double limit = 0);

}  // namespace easydyn::soil

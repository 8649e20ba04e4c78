#pragma once

// Private to soil: parts of the site file.

#include <vector>

#include "soil/site.hpp"
#include "soil/toml_table.hpp"

namespace easydyn::soil {

/// One [[receiver]], [[receiver_line]] or [[receiver_grid]], [[snapshot]] of a site file (site_file.hpp).
/// @throws InputError file, line, value and range
Receiver read_receiver(TomlTable& table);
std::vector<Receiver> read_receiver_line(TomlTable& table);
std::vector<Receiver> read_receiver_grid(TomlTable& table);
Snapshot read_snapshot(TomlTable& table);

}  // namespace easydyn::soil

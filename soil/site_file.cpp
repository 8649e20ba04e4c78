#include "soil/site_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <set>
#include <sstream>
#include <string_view>

#include "easydyn/error.hpp"
#include "soil/site_recordings.hpp"
#include "soil/toml_table.hpp"

namespace easydyn::soil {
namespace {

// Room for saturated soil: c_p = 31.6 c_s, 1500 m/s over cs 47.4 m/s. Elements of degree 4 do not lock there
// (tests/soil/water_table_test.cpp); nothing is verified beyond.
constexpr double highest_poisson_ratio = 0.4995;

std::string read_text_file(const std::filesystem::path& path) {
  std::error_code ignored;
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path, ignored)) {
    throw InputError(fmt::format("{}: cannot be read: no such file, or no permission", path.string()));
  }
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

toml::table parse(const std::string& text, const std::filesystem::path& path) {
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw InputError(fmt::format("{}:{}:{}: {}", path.string(), error.source().begin.line,
                                 error.source().begin.column, error.description()));
  }
}

// cp / cs = sqrt((2 - 2 nu) / (1 - 2 nu))
double compute_speed_ratio(double nu) {
  return std::sqrt((2 - 2 * nu) / (1 - 2 * nu));
}

// The two wave speeds from cs with cp or nu, or from E with nu.
void read_stiffness(const TomlTable& table, Layer& layer) {
  constexpr Range poisson_range{.low = 0, .high = highest_poisson_ratio};
  if (table.has("E") == table.has("cs")) {
    table.fail(table.has("E") ? "both E and cs are given, must be one of them"
                              : "no stiffness: give cs with cp or nu, or E with nu");
  }
  if (table.has("E")) {
    if (table.has("cp")) {
      table.fail("cp", "both E and cp are given, must be E with nu");
    }
    const double E = table.number("E", "Pa", positive);
    const double nu = table.number("nu", "", poisson_range);
    layer.cs = std::sqrt(E / (2 * (1 + nu) * layer.density));
    layer.cp = layer.cs * compute_speed_ratio(nu);
    return;
  }
  layer.cs = table.number("cs", "m/s", positive);
  if (table.has("cp") == table.has("nu")) {
    table.fail(table.has("cp") ? "both cp and nu are given, must be one of them"
                               : "no compression wave speed: give cp or nu beside cs");
  }
  if (table.has("nu")) {
    layer.cp = layer.cs * compute_speed_ratio(table.number("nu", "", poisson_range));
    return;
  }
  layer.cp = table.number("cp", "m/s", positive);
  const double lowest = layer.cs * compute_speed_ratio(0);
  const double highest = layer.cs * compute_speed_ratio(highest_poisson_ratio);
  constexpr double rounding = 1e-6;
  if (!(layer.cp >= lowest * (1 - rounding) && layer.cp <= highest * (1 + rounding))) {
    table.fail(
        "cp",
        fmt::format("cp = {} m/s, must be >= {:.6g} and <= {:.6g} (Poisson ratio 0 to {} with cs = {} m/s)",
                    layer.cp, lowest, highest, highest_poisson_ratio, layer.cs));
  }
}

Layer read_layer(TomlTable& table, bool is_half_space) {
  table.refuse_other_keys({"name", "thickness", "density", "cs", "cp", "nu", "E", "damping", "source"});
  Layer layer;
  layer.name = table.text("name", "");
  if (!layer.name.empty()) {
    table.set_object(fmt::format("layer \"{}\"", layer.name));
  }
  if (!is_half_space) {
    if (!table.has("thickness")) {
      table.fail("\"thickness\" is missing: only the last layer, the half-space, has none");
    }
    layer.thickness = table.number("thickness", "m", positive);
  } else {
    if (table.has("thickness")) {
      table.fail("thickness", "the last layer is the half-space, must have no thickness");
    }
    layer.thickness = std::numeric_limits<double>::infinity();
  }
  layer.density = table.number("density", "kg/m3", positive);
  read_stiffness(table, layer);
  layer.damping = table.number("damping", "", {.low = 0, .high = 0.2, .includes_high = false});
  layer.source = table.text("source", "");
  return layer;
}

Block read_block(TomlTable& table) {
  table.refuse_other_keys(
      {"name", "x", "y", "z", "open", "mirrored", "density", "cs", "cp", "nu", "E", "damping", "source"});
  Block block;
  block.name = table.text("name", "");
  if (!block.name.empty()) {
    table.set_object(fmt::format("block \"{}\"", block.name));
  }
  if (table.has("x")) block.x = table.interval("x", "m", true);
  if (table.has("y")) block.y = table.interval("y", "m", true);
  block.z = table.interval("z", "m", false);
  if (block.z[1] > 0) {
    table.fail("z",
               fmt::format("z = {}..{} m, must be <= 0 (0 is the surface; an embankment is a first layer "
                           "with open blocks beside it)",
                           block.z[0], block.z[1]));
  }
  block.mirrored = table.flag("mirrored", false);
  if (block.mirrored && block.y[0] < 0 && block.y[1] > 0) {
    table.fail("mirrored",
               fmt::format("y = {}..{} m contains y = 0, must be on one side of it to be mirrored",
                           block.y[0], block.y[1]));
  }
  block.open = table.flag("open", false);
  block.material.name = block.name;
  block.material.source = table.text("source", "");
  if (block.open) {
    for (const char* key : {"density", "cs", "cp", "nu", "E", "damping"}) {
      if (table.has(key)) {
        table.fail(key, fmt::format("both open = true and {} are given, must be one of them", key));
      }
    }
    return block;
  }
  block.material.density = table.number("density", "kg/m3", positive);
  read_stiffness(table, block.material);
  block.material.damping = table.number("damping", "", {.low = 0, .high = 0.2, .includes_high = false});
  return block;
}

void read_receivers(const TomlTable& root, Site& site) {
  std::set<std::string> names;
  const auto add = [&](const TomlTable& table, const std::vector<Receiver>& receivers) {
    for (const Receiver& receiver : receivers) {
      if (!names.insert(receiver.name).second) {
        table.fail("name", receiver.group.empty()
                               ? "the name appears twice"
                               : fmt::format("a receiver \"{}\" is there already", receiver.name));
      }
      site.receivers.push_back(receiver);
    }
  };
  for (TomlTable& table : root.tables("receiver")) {
    const Receiver receiver = read_receiver(table);
    add(table, {receiver});
  }
  for (TomlTable& table : root.tables("receiver_line")) {
    const std::vector<Receiver> line = read_receiver_line(table);
    add(table, line);
  }
  for (TomlTable& table : root.tables("receiver_grid")) {
    const std::vector<Receiver> grid = read_receiver_grid(table);
    add(table, grid);
  }
  if (site.receivers.empty()) {
    root.fail("no receiver: give at least one [[receiver]], [[receiver_line]] or [[receiver_grid]]");
  }
}

void read_snapshots(const TomlTable& root, Site& site) {
  std::set<std::string> names;
  for (TomlTable& table : root.tables("snapshot")) {
    site.snapshots.push_back(read_snapshot(table));
    if (!names.insert(site.snapshots.back().name).second) {
      table.fail("name", "the name appears twice");
    }
  }
}

// A table of settings, all optional; the keys that it has are noted in the site.
TomlTable read_group(const TomlTable& root, const char* name, const std::vector<std::string>& keys,
                     Site& site) {
  TomlTable group = root.table(name);
  group.refuse_other_keys(keys);
  for (const std::string& key : keys) {
    if (group.has(key)) site.given.insert(key);
  }
  return group;
}

void read_settings(const TomlTable& root, Site& site) {
  const TomlTable solver = read_group(
      root, "solver", {"highest_frequency", "damping_frequency", "points_per_wavelength", "margin"}, site);
  site.highest_frequency = solver.number("highest_frequency", "Hz", positive, site.highest_frequency);
  site.damping_frequency = solver.number("damping_frequency", "Hz", positive, site.damping_frequency);
  site.points_per_wavelength =
      solver.number("points_per_wavelength", "", {.low = 4, .high = 50}, site.points_per_wavelength);
  site.margin = solver.number("margin", "m", not_negative, site.margin);

  const TomlTable loads = read_group(root, "loads", {"taper_length", "duration", "decay_time"}, site);
  site.taper_length = loads.number("taper_length", "m", not_negative, site.taper_length);
  site.duration = loads.number("duration", "s", not_negative, site.duration);
  site.decay_time = loads.number("decay_time", "s", not_negative, site.decay_time);
}

}  // namespace

Site read_site(const std::filesystem::path& path) {
  return parse_site(read_text_file(path), path);
}

Site parse_site(const std::string& text, const std::filesystem::path& path) {
  Site site;
  site.text = text;
  const toml::table parsed = parse(site.text, path);
  const TomlTable root(path, "", parsed);
  root.refuse_other_keys({"name", "source", "layer", "block", "receiver", "receiver_line", "receiver_grid",
                          "snapshot", "solver", "loads"});
  site.name = root.text("name", path.stem().string());
  root.text("source", "");

  std::vector<TomlTable> layers = root.tables("layer");
  if (layers.empty()) {
    root.fail("no layer: give at least one [[layer]], the half-space");
  }
  for (TomlTable& table : layers) {
    site.layers.push_back(read_layer(table, &table == &layers.back()));
  }

  for (TomlTable& table : root.tables("block")) {
    site.blocks.push_back(read_block(table));
  }
  read_receivers(root, site);
  read_snapshots(root, site);
  read_settings(root, site);
  return site;
}

}  // namespace easydyn::soil

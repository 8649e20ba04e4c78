#include "soil/site_recordings.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace easydyn::soil {
namespace {

constexpr double most_receivers = 100000;  // of a line or a grid
constexpr Range count_range{.low = 1, .high = most_receivers};

std::array<double, 3> read_position(const TomlTable& table, const char* key) {
  const std::vector<double> position = table.numbers(key, "m");
  if (position.size() != 2 && position.size() != 3) {
    table.fail(key,
               fmt::format("{} has {} numbers, must have 2 (x, y) or 3 (x, y, z)", key, position.size()));
  }
  const double z = position.size() == 3 ? position[2] : 0;
  if (z > 0) {
    table.fail(key, fmt::format("z = {} m, must be <= 0 (0 is the surface)", z));
  }
  return {position[0], position[1], z};
}

// "A (0, 8, -1)": to the micrometre, so that -1e-17 reads 0.
Receiver make_receiver(const std::string& group, const std::array<double, 3>& position) {
  std::array<double, 3> shown = position;
  for (double& value : shown) value = std::round(value * 1e6) / 1e6 + 0.0;
  return {fmt::format("{} ({:.10g}, {:.10g}, {:.10g})", group, shown[0], shown[1], shown[2]), position,
          group};
}

// Number of points from one end to the other, both included.
int count_points(const TomlTable& table, const std::string& place, double length, double spacing) {
  const double intervals = length / spacing;
  if (!(intervals <= most_receivers)) {
    table.fail("spacing", fmt::format("{} = {} m gives {:.3g} receivers over {:.10g} m, must be at most {}",
                                      place, spacing, intervals, length, most_receivers));
  }
  const double whole = std::max(1.0, std::round(intervals));
  if (!(std::abs(intervals - whole) <= 1e-6 * whole)) {
    table.fail("spacing", fmt::format("{} = {} m does not divide the {:.10g} m, must be e.g. {:.10g}", place,
                                      spacing, length, length / whole));
  }
  return static_cast<int>(whole) + 1;
}

void require_one_of(const TomlTable& table) {
  if (table.has("count") == table.has("spacing")) {
    table.fail(table.has("count") ? "both count and spacing are given, must be one of them"
                                  : "no number of receivers: give count or spacing");
  }
}

int read_count(const TomlTable& table, const std::string& place, double value, int lowest) {
  if (!(value == std::floor(value) && value >= lowest && count_range.contains(value))) {
    table.fail("count", fmt::format("{} = {}, must be a whole number, >= {} and <= {}", place, value, lowest,
                                    most_receivers));
  }
  return static_cast<int>(value);
}

std::string read_group_name(TomlTable& table) {
  const std::string name = table.text("name", table.object());
  if (table.has("name")) {
    if (name.empty()) table.fail("name", "name is empty");
    table.set_object(fmt::format("{} \"{}\"", table.object().substr(0, table.object().find(' ')), name));
  }
  table.text("source", "");
  return name;
}

// The point `i` of `count` points from `a` to `b`, the ends without rounding.
double divide(double a, double b, int i, int count) {
  return i + 1 == count && count > 1 ? b : count == 1 ? a : a + (b - a) * i / (count - 1);
}

}  // namespace

Receiver read_receiver(TomlTable& table) {
  table.refuse_other_keys({"name", "position", "distance", "source"});
  Receiver receiver;
  receiver.name = table.text("name");
  table.set_object(fmt::format("receiver \"{}\"", receiver.name));
  table.text("source", "");
  if (table.has("position") == table.has("distance")) {
    table.fail(table.has("position") ? "both position and distance are given, must be one of them"
                                     : "no place: give position = [x, y, z] or distance");
  }
  if (table.has("distance")) {
    receiver.position = {0, table.number("distance", "m", any_number), 0};
  } else {
    receiver.position = read_position(table, "position");
  }
  return receiver;
}

std::vector<Receiver> read_receiver_line(TomlTable& table) {
  table.refuse_other_keys({"name", "from", "to", "count", "spacing", "source"});
  const std::string group = read_group_name(table);
  const std::array<double, 3> from = read_position(table, "from"), to = read_position(table, "to");
  const double length = std::hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]);
  if (!(length > 0)) {
    table.fail("to", "the line ends where it starts, must have a length");
  }
  require_one_of(table);
  const int count = table.has("count")
                        ? read_count(table, "count", table.number("count", "", any_number), 2)
                        : count_points(table, "spacing", length, table.number("spacing", "m", positive));
  std::vector<Receiver> receivers;
  for (int i = 0; i < count; ++i) {
    receivers.push_back(
        make_receiver(group, {divide(from[0], to[0], i, count), divide(from[1], to[1], i, count),
                              divide(from[2], to[2], i, count)}));
  }
  return receivers;
}

std::vector<Receiver> read_receiver_grid(TomlTable& table) {
  table.refuse_other_keys({"name", "from", "to", "count", "spacing", "source"});
  const std::string group = read_group_name(table);
  const std::array<double, 3> from = read_position(table, "from"), to = read_position(table, "to");
  require_one_of(table);
  const char* const key = table.has("count") ? "count" : "spacing";
  const std::vector<double> values = table.numbers(key, table.has("count") ? "" : "m");
  const std::size_t axes = table.numbers("from", "m").size();
  if (axes != table.numbers("to", "m").size()) {
    table.fail("to", "to has not as many numbers as from, must have");
  }
  if (values.size() != axes) {
    table.fail(
        key, fmt::format("{} has {} numbers, must have {}: one for each of from", key, values.size(), axes));
  }
  std::array<int, 3> count{1, 1, 1};
  double total = 1;
  for (std::size_t c = 0; c < axes; ++c) {
    const std::string place = fmt::format("{}[{}]", key, c);
    const double length = std::abs(to[c] - from[c]);
    if (table.has("count")) {
      count[c] = read_count(table, place, values[c], length > 0 ? 2 : 1);
      if (length == 0 && count[c] != 1) {
        table.fail(key, fmt::format("{} = {} where from and to are the same, must be 1", place, count[c]));
      }
    } else {
      if (!positive.contains(values[c])) {
        table.fail(key, fmt::format("{} = {} m, must be > 0", place, values[c]));
      }
      if (length > 0) count[c] = count_points(table, place, length, values[c]);
    }
    total *= count[c];
  }
  if (!(total <= most_receivers)) {
    table.fail(key, fmt::format("{} gives {} receivers, must be at most {}", key, total, most_receivers));
  }
  std::vector<Receiver> receivers;
  for (int k = 0; k < count[2]; ++k) {
    for (int j = 0; j < count[1]; ++j) {
      for (int i = 0; i < count[0]; ++i) {
        receivers.push_back(
            make_receiver(group, {divide(from[0], to[0], i, count[0]), divide(from[1], to[1], j, count[1]),
                                  divide(from[2], to[2], k, count[2])}));
      }
    }
  }
  return receivers;
}

Snapshot read_snapshot(TomlTable& table) {
  table.refuse_other_keys({"name", "x", "y", "z", "step", "begin", "end"});
  Snapshot snapshot;
  int axes = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const char* const key = axis == 0 ? "x" : axis == 1 ? "y" : "z";
    if (!table.has(key)) continue;
    snapshot.axis = axis;
    snapshot.place = table.number(key, "m", axis == 2 ? Range{.high = 0} : any_number);
    ++axes;
  }
  if (axes != 1) {
    table.fail(axes == 0 ? "no plane: give x, y or z (z = 0 is the surface)"
                         : "more than one of x, y and z are given, must be one of them");
  }
  snapshot.name = table.text("name", snapshot.axis == 2 && snapshot.place == 0
                                         ? std::string("surface")
                                         : fmt::format("{}={:.10g}", "xyz"[snapshot.axis], snapshot.place));
  // It becomes the name of files.
  if (snapshot.name.empty() || snapshot.name.find_first_of("/\\\"<>&:*?|") != std::string::npos ||
      snapshot.name.front() == '.') {
    table.fail("name",
               fmt::format("name = \"{}\", must be the name of a file: not empty, without / \\ \" < > & : "
                           "* ? | and no dot in front",
                           snapshot.name));
  }
  table.set_object(fmt::format("snapshot \"{}\"", snapshot.name));
  snapshot.step = table.number("step", "s", positive);
  snapshot.begin = table.number("begin", "s", any_number, snapshot.begin);
  snapshot.end = table.number("end", "s", any_number, snapshot.end);
  if (!(snapshot.end > snapshot.begin)) {
    table.fail("end", fmt::format("end = {} s, must be > begin = {} s", snapshot.end, snapshot.begin));
  }
  return snapshot;
}

}  // namespace easydyn::soil

#include "easydyn/results/channels.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <set>

#include "easydyn/error.hpp"
#include "easydyn/results/pending_file.hpp"

namespace easydyn::results {
namespace {

// A field with a comma, a quote or a line break stands in quotes, its quotes doubled.
std::string quote_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) {
    return text;
  }
  std::string quoted = "\"";
  for (const char c : text) {
    quoted += c;
    if (c == '"') {
      quoted += '"';
    }
  }
  return quoted + '"';
}

void check_table(const ChannelTable& table) {
  std::set<std::string> names;
  if (!table.time.allFinite()) {
    throw ModelError("channels: a time is not finite");
  }
  for (const Channel& channel : table.channels) {
    if (!names.insert(channel.name).second) {
      throw ModelError(fmt::format("channel \"{}\" appears twice", channel.name));
    }
    if (channel.values.size() != table.time.size()) {
      throw ModelError(fmt::format("channel \"{}\": {} values, must be {} (one per time)", channel.name,
                                   channel.values.size(), table.time.size()));
    }
    for (Eigen::Index i = 0; i < channel.values.size(); ++i) {
      if (!std::isfinite(channel.values(i))) {
        throw ModelError(fmt::format("channel \"{}\": value at t = {} s is {}, must be finite", channel.name,
                                     table.time(i), channel.values(i)));
      }
    }
  }
}

}  // namespace

void ChannelTable::add(const std::string& name, const std::string& units,
                       const Eigen::Ref<const Eigen::VectorXd>& values) {
  channels.push_back({name, units, values});
}

void write_channels(const std::filesystem::path& path, const ChannelTable& table) {
  check_table(table);
  PendingFile pending(path);
  std::ofstream file(pending.partial_path(), std::ios::binary);

  fmt::memory_buffer line;
  const auto end_line = [&] {
    line.push_back('\n');
    file.write(line.data(), static_cast<std::streamsize>(line.size()));
    line.clear();
  };
  fmt::format_to(std::back_inserter(line), "time [s]");
  for (const Channel& channel : table.channels) {
    fmt::format_to(std::back_inserter(line), ",{}",
                   quote_field(fmt::format("{} [{}]", channel.name, channel.units)));
  }
  end_line();
  for (Eigen::Index i = 0; i < table.time.size(); ++i) {
    fmt::format_to(std::back_inserter(line), "{}", table.time(i));
    for (const Channel& channel : table.channels) {
      fmt::format_to(std::back_inserter(line), ",{}", channel.values(i));
    }
    end_line();
  }
  file.close();
  if (!file) {
    throw InputError(fmt::format("{}: cannot be written", path.string()));
  }
  pending.commit();
}

}  // namespace easydyn::results

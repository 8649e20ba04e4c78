#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

namespace easydyn::results {

/// A named quantity over time.
struct Channel {
  std::string name;        ///< e.g. "rail deflection, x = 0"
  std::string units;       ///< SI, "1" where dimensionless
  Eigen::VectorXd values;  ///< one per time
};

/// A small table of channels over one time axis [s], for a spreadsheet: what fits one page of a report.
struct ChannelTable {
  Eigen::VectorXd time;
  std::vector<Channel> channels;

  void add(const std::string& name, const std::string& units,
           const Eigen::Ref<const Eigen::VectorXd>& values);
};

/// Writes comma-separated values (RFC 4180, decimal point, lines end in \n): a header "time [s],name
/// [units],..." and one row per time; each number with as many digits as bring it back exactly. The file
/// appears complete or not at all.
/// @throws InputError if the file cannot be written; ModelError if a channel has not one value per time, a
///         name appears twice or a value is not finite (channel and time named)
void write_channels(const std::filesystem::path& path, const ChannelTable& table);

}  // namespace easydyn::results

#include "soil/report/comparison.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "easydyn/error.hpp"
#include "easydyn/visu/parameter_json.hpp"
#include "soil/third_octave.hpp"

namespace easydyn::soil::report {
namespace {

namespace fs = std::filesystem;

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double same_place = 1e-3;  // [m]

std::vector<Parameter> read_parameters(const results::ResultReader& file) {
  if (!file.has("/parameters")) return {};
  return visu::parameters_from_json(file.read_text("/parameters"), file.path().string() + ":/parameters");
}

std::string list_positions(const Result& result) {
  constexpr std::size_t most = 6;
  const std::vector<Receiver>& receivers = result.vibrations.receivers;
  if (receivers.empty()) return "none";
  std::string text;
  for (std::size_t r = 0; r < std::min(most, receivers.size()); ++r) {
    const auto& p = receivers[r].position;
    text += fmt::format("{}({:.6g}, {:.6g}, {:.6g})", r == 0 ? "" : ", ", p[0], p[1], p[2]);
  }
  if (receivers.size() > most) text += fmt::format(" and {} more", receivers.size() - most);
  return text;
}

// NaN where a level is not known or weak.
VectorXd known(VectorXd levels) {
  double strongest = -std::numeric_limits<double>::infinity();
  for (const double level : levels)
    if (level > strongest) strongest = level;
  return levels.unaryExpr([&](double level) {
    return level >= strongest - weakest_level ? level : std::numeric_limits<double>::quiet_NaN();
  });
}

}  // namespace

Result read_result(const fs::path& folder, const std::string& label) {
  const fs::path file = folder / "vibrations.h5";
  if (!fs::is_directory(folder)) throw InputError(fmt::format("{}: no such folder", folder.string()));
  if (!fs::exists(file))
    throw InputError(fmt::format("{}: holds no vibrations.h5, which a comparison needs", folder.string()));
  const results::ResultReader reader(file);
  Result result{.label = label,
                .folder = folder,
                .program = fmt::format("{} {}", reader.read_text_attribute("program"),
                                       reader.read_text_attribute("version")),
                .created = reader.read_text_attribute("created"),
                .command = reader.read_text_attribute("command"),
                .description = {},
                .vibrations = read_vibrations(file),
                .parameters = {}};
  if (result.vibrations.time.size() < 2)
    throw InputError(
        fmt::format("{}:/time: {} value, must be at least 2", file.string(), result.vibrations.time.size()));
  if (const fs::path track = folder / "results.h5"; fs::exists(track)) {
    const results::ResultReader step_1(track);
    result.parameters = read_parameters(step_1);
    if (step_1.has("/description")) result.description = step_1.read_text("/description");
  }
  result.parameters.insert(result.parameters.end(), result.vibrations.parameters.begin(),
                           result.vibrations.parameters.end());
  return result;
}

std::vector<std::string> make_labels(const std::vector<fs::path>& folders) {
  std::vector<std::vector<std::string>> names;  // of each folder, from the last to the root
  for (const fs::path& folder : folders) {
    std::vector<std::string> parts;
    for (const fs::path& part : (fs::absolute(folder).lexically_normal() / "").parent_path().relative_path())
      parts.insert(parts.begin(), part.string());
    if (std::find(names.begin(), names.end(), parts) != names.end())
      throw InputError(fmt::format("{}: given twice; a result is compared with others", folder.string()));
    names.push_back(std::move(parts));
  }
  std::vector<std::string> labels;
  for (const auto& own : names) {
    std::size_t depth = 1;  // names needed
    for (const auto& other : names) {
      if (&other == &own) continue;
      const auto shared =
          std::mismatch(own.begin(), own.end(), other.begin(), other.end()).first - own.begin();
      depth = std::max(depth, size_t(shared) + 1);
    }
    std::string label = own.empty() ? "/" : own.front();
    for (std::size_t i = 1; i < std::min(depth, own.size()); ++i) label.insert(0, own[i] + "/");
    labels.push_back(std::move(label));
  }
  return labels;
}

Places find_common_places(const std::vector<Result>& results) {
  struct Place {
    Receiver receiver;
    std::vector<Index> column;
  };
  std::vector<Place> all;
  for (std::size_t n = 0; n < results.size(); ++n) {
    const std::vector<Receiver>& receivers = results[n].vibrations.receivers;
    for (std::size_t r = 0; r < receivers.size(); ++r) {
      const auto is_here = [&](const Place& place) {
        for (std::size_t c = 0; c < 3; ++c)
          if (!(std::abs(place.receiver.position[c] - receivers[r].position[c]) <= same_place)) return false;
        return true;
      };
      auto at = std::find_if(all.begin(), all.end(), is_here);
      if (at == all.end()) at = all.insert(all.end(), {receivers[r], std::vector<Index>(results.size(), -1)});
      if (at->column[n] < 0)
        at->column[n] = Index(r);  // a single receiver and a point of a line may coincide
    }
  }
  std::erase_if(all, [](const Place& place) {
    return std::count_if(place.column.begin(), place.column.end(), [](Index c) { return c >= 0; }) < 2;
  });
  if (all.empty()) {
    std::string text;
    for (const Result& result : results)
      text += fmt::format("; {}: {}", result.folder.string(), list_positions(result));
    throw InputError("no two results have a receiver in common (within 1 mm); receivers [m]" + text);
  }
  MatrixXd position(Index(all.size()), 3);
  std::vector<std::string> names, groups;
  std::vector<std::vector<Index>> column;
  for (const Place& place : all) {
    position.row(Index(names.size())) = Eigen::RowVector3d::Map(place.receiver.position.data());
    names.push_back(place.receiver.name);
    groups.push_back(place.receiver.group);
    column.push_back(place.column);
  }
  return {Receivers(std::move(position), std::move(names), std::move(groups)), std::move(column)};
}

Comparison::Comparison(const std::vector<Result>& results, const Places& places)
    : results_(results), places_(places) {
  const VectorXd all = third_octave_centres();
  Index known = 1;
  for (const Result& result : results)
    for (const Indicators& i : result.vibrations.indicators)
      for (Index b = known; b < all.size(); ++b)
        if (!std::isnan(i.third_octave_rms(b))) known = b + 1;
  centres_ = all.head(known);
}

VectorXd Comparison::levels(Index place, std::size_t result) const {
  const double factor = std::sqrt(results_[result].duration() / results_.front().duration());
  return (factor * indicators(place, result).third_octave_rms.head(centres_.size()))
      .unaryExpr(&compute_level);
}

VectorXd Comparison::insertion_loss(Index place, std::size_t result) const {
  return known(levels(place, places_.reference(place))) - known(levels(place, result));
}

}  // namespace easydyn::soil::report

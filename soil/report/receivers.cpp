#include "soil/report/receivers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "soil/report/sections.hpp"
#include "soil/report/text.hpp"

namespace easydyn::soil::report {

namespace {

using Eigen::Index;

constexpr Index most_rows = 24;  // of receivers, before lines and grids are told by curves

}  // namespace

Receivers::Receivers(Eigen::MatrixXd at, std::vector<std::string> names_of_all,
                     std::vector<std::string> groups_of_all)
    : position(std::move(at)),
      names(std::move(names_of_all)),
      groups(std::move(groups_of_all)),
      distance(position.col(1).cwiseAbs()) {
  groups.resize(size_t(count()));
  if (count() <= most_rows) {
    near.resize(size_t(count()));
    std::iota(near.begin(), near.end(), Index(0));
  } else {
    near = members("");
    for (const std::string& group : group_names()) {
      const std::vector<Index> of_group = members(group);
      near.push_back(of_group.front());
      if (of_group.size() > 1) near.push_back(of_group.back());
    }
  }
  std::stable_sort(near.begin(), near.end(), [&](Index a, Index b) { return distance(a) < distance(b); });
}

std::string Receivers::label(Index i) const {
  return name_of(names, i, "receiver");
}

std::vector<Index> Receivers::members(const std::string& group) const {
  std::vector<Index> indices;
  for (Index i = 0; i < count(); ++i)
    if (groups[size_t(i)] == group) indices.push_back(i);
  return indices;
}

std::vector<std::string> Receivers::group_names() const {
  std::vector<std::string> all;
  for (const std::string& group : groups)
    if (!group.empty() && std::find(all.begin(), all.end(), group) == all.end()) all.push_back(group);
  return all;
}

std::string Receivers::place(Index i) const {
  return fmt::format("x = {} m, y = {} m, z = {} m", visu::short_number_text(position(i, 0)),
                     visu::short_number_text(position(i, 1)), visu::short_number_text(position(i, 2)));
}

double compute_level(double velocity) {
  return velocity > 0 ? 20 * std::log10(velocity / level_reference)
                      : std::numeric_limits<double>::quiet_NaN();
}

visu::Axis third_octave_axis() {
  return {.label = "one-third octave band centre",
          .unit = "Hz",
          .scale = visu::Scale::logarithmic,
          .ticks = {1, 2, 4, 8, 16, 31.5, 63}};
}

}  // namespace easydyn::soil::report

#include "soil/report/text.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "soil/frequency_filter.hpp"

namespace easydyn::soil::report {

std::vector<Eigen::Index> spread(Eigen::Index n, Eigen::Index count) {
  std::vector<Eigen::Index> chosen;
  const Eigen::Index m = std::min(n, count);
  for (Eigen::Index i = 0; i < m; ++i) chosen.push_back(m == 1 ? 0 : (i * (n - 1) + (m - 1) / 2) / (m - 1));
  return chosen;
}

std::string name_of(const std::vector<std::string>& names, Eigen::Index i, const std::string& what) {
  return size_t(i) < names.size() ? names[size_t(i)] : fmt::format("{} {}", what, i + 1);
}

std::string band_text(double highest_frequency) {
  return fmt::format(
      "The loads are passed unchanged up to {} Hz and rolled off to zero at {} Hz; what lies above is not in "
      "the figures.",
      visu::short_number_text(highest_frequency), visu::short_number_text(roll_off * highest_frequency));
}

}  // namespace easydyn::soil::report

#include "soil/report/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace easydyn::soil::report {

std::string number_text(double value, int digits) {
  if (std::isnan(value)) return "\u2013";
  if (std::isinf(value)) return value > 0 ? "\u221e" : "\u2212\u221e";
  const double size = std::abs(value);
  std::string text;
  if (size == 0) {
    text = "0";
  } else if (size < 1e-4 || size >= 1e7) {
    const int exponent = int(std::floor(std::log10(size)));
    text = fmt::format("{:.{}f}e{}", value / std::pow(10, exponent), digits - 1, exponent);
  } else {
    const int before_point = int(std::floor(std::log10(size))) + 1;
    text = fmt::format("{:.{}f}", value, std::max(0, digits - before_point));
  }
  if (text.front() == '-') text.replace(0, 1, "\u2212");
  return text;
}

std::vector<Eigen::Index> spread(Eigen::Index n, Eigen::Index count) {
  std::vector<Eigen::Index> chosen;
  const Eigen::Index m = std::min(n, count);
  for (Eigen::Index i = 0; i < m; ++i) chosen.push_back(m == 1 ? 0 : (i * (n - 1) + (m - 1) / 2) / (m - 1));
  return chosen;
}

std::string name_of(const std::vector<std::string>& names, Eigen::Index i, const std::string& what) {
  return size_t(i) < names.size() ? names[size_t(i)] : fmt::format("{} {}", what, i + 1);
}

}  // namespace easydyn::soil::report

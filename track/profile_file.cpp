#include "track/profile_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "easydyn/error.hpp"

namespace easydyn::track {

namespace {

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return text.substr(text.size());
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::optional<double> metres_per(std::string_view unit) {
  constexpr std::array<std::pair<std::string_view, double>, 6> units = {
      {{"m", 1}, {"dm", 0.1}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}, {"km", 1e3}}};
  for (const auto& [name, factor] : units)
    if (name == unit) return factor;
  return {};
}

class ProfileReader {
 public:
  ProfileReader(const std::filesystem::path& path, const ProfileFileOptions& options)
      : path_(path), units_{options.x_unit, options.r_unit} {
    for (const std::string& unit : units_)
      if (!unit.empty() && !metres_per(unit))
        throw InputError(fmt::format("{}: unit \"{}\" in the options, must be m, dm, cm, mm, um or km",
                                     path_.string(), unit));
  }

  SplineProfile read(const SplineProfileOptions& spline) {
    std::ifstream file(path_);
    if (!file) throw InputError(fmt::format("{}: cannot be read", path_.string()));
    for (std::string line; std::getline(file, line);) {
      ++line_number_;
      line_ = line;
      if (line_number_ == 1 && line_.substr(0, 3) == "\xEF\xBB\xBF") line_.remove_prefix(3);
      std::string_view content = trimmed(line_.substr(0, line_.find('#')));
      if (!content.empty()) read_row(content);
    }
    if (file.bad()) throw InputError(fmt::format("{}: reading failed", path_.string()));
    if (x_.size() < 4)
      throw InputError(fmt::format("{}:{}:1: {} points, must be >= 4", path_.string(),
                                   std::max(line_number_, 1), x_.size()));
    try {
      return SplineProfile(path_.filename().string(), std::move(x_), std::move(r_), spline);
    } catch (const ModelError& error) {  // what only the whole can show: ends, taper
      throw InputError(fmt::format("{}:{}:1: {}", path_.string(), line_number_, error.what()));
    }
  }

 private:
  [[noreturn]] void fail(std::string_view where, const std::string& what) const {
    const auto column = where.data() ? where.data() - line_.data() + 1 : 1;
    throw InputError(fmt::format("{}:{}:{}: {}", path_.string(), line_number_, column, what));
  }

  void read_row(std::string_view content) {
    const bool is_first = delimiter_ == 0;
    if (is_first) {
      delimiter_ = content.find(';') != std::string_view::npos ? ';' : ',';
      if (content.find(delimiter_) == std::string_view::npos)
        fail(content, fmt::format("\"{}\", must be two columns separated by , or ;", content));
    }
    std::array<std::string_view, 2> columns;
    const auto mark = content.find(delimiter_);
    if (mark == std::string_view::npos || content.find(delimiter_, mark + 1) != std::string_view::npos)
      fail(content, fmt::format("\"{}\", must be two columns separated by {}", content, delimiter_));
    columns[0] = trimmed(content.substr(0, mark));
    columns[1] = trimmed(content.substr(mark + 1));
    if (is_first && begins_with_a_letter(columns[0]) && begins_with_a_letter(columns[1])) {
      read_header(columns);
      return;
    }
    if (is_first || factors_[0] == 0) take_units(content);
    const double x = read_number(columns[0], "position") * factors_[0];
    const double r = read_number(columns[1], "height") * factors_[1];
    if (!x_.empty() && !(x > x_.back()))
      fail(columns[0],
           fmt::format("position = {} m, must be > {} m, that of the point before", x, x_.back()));
    x_.push_back(x);
    r_.push_back(r);
  }

  static bool begins_with_a_letter(std::string_view text) {
    // numbers that are none (nan, inf) are data, and refused as such
    return !text.empty() && std::isalpha(static_cast<unsigned char>(text[0])) && text.substr(0, 3) != "nan" &&
           text.substr(0, 3) != "NaN" && text.substr(0, 3) != "inf";
  }

  void read_header(const std::array<std::string_view, 2>& columns) {
    for (std::size_t c = 0; c < 2; ++c) {
      const auto open = columns[c].find('['), close = columns[c].find(']');
      if (open == std::string_view::npos) continue;
      if (close == std::string_view::npos || close < open)
        fail(columns[c],
             fmt::format("\"{}\", must be a name and a unit in brackets, e.g. x [m]", columns[c]));
      const std::string unit(trimmed(columns[c].substr(open + 1, close - open - 1)));
      if (!metres_per(unit))
        fail(columns[c].substr(open), fmt::format("unit \"{}\", must be m, dm, cm, mm, um or km", unit));
      if (!units_[c].empty() && units_[c] != unit)
        fail(columns[c].substr(open),
             fmt::format("unit \"{}\", must be \"{}\" as in the options", unit, units_[c]));
      units_[c] = unit;
    }
  }

  void take_units(std::string_view content) {
    for (std::size_t c = 0; c < 2; ++c) {
      if (units_[c].empty())
        fail(content, fmt::format("the unit of {} is not known: write a header \"x [m]{} r [mm]\" or set {}",
                                  c == 0 ? "x" : "r", delimiter_, c == 0 ? "x_unit" : "r_unit"));
      factors_[c] = *metres_per(units_[c]);
    }
  }

  double read_number(std::string_view text, const char* quantity) const {
    double value = 0;
    const std::string_view digits = text.substr(0, 1) == "+" ? text.substr(1) : text;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (text.empty() || error != std::errc() || end != digits.data() + digits.size())
      fail(text, fmt::format("{} \"{}\", must be a number with a decimal point", quantity, text));
    if (!std::isfinite(value)) fail(text, fmt::format("{} = {}, must be finite", quantity, text));
    return value;
  }

  std::filesystem::path path_;
  std::array<std::string, 2> units_;
  std::array<double, 2> factors_ = {0, 0};  // 0: units not yet taken
  char delimiter_ = 0;
  int line_number_ = 0;
  std::string_view line_;
  std::vector<double> x_, r_;
};

}  // namespace

SplineProfile read_profile(const std::filesystem::path& path, const ProfileFileOptions& options) {
  return ProfileReader(path, options).read(options.spline);
}

}  // namespace easydyn::track

#include "easydyn/visu/number_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace easydyn::visu {

namespace {

std::string power_of_ten(int exponent) {
  constexpr std::array<const char*, 10> digits = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = exponent < 0 ? "10⁻" : "10";
  for (const char c : std::to_string(std::abs(exponent))) text += digits[size_t(c - '0')];
  return text;
}

std::string number(double value, int digits, bool keep_zeros) {
  if (std::isnan(value)) return "–";
  if (std::isinf(value)) return value > 0 ? "∞" : "−∞";
  if (value == 0) return "0";

  // rounded first, so that 0.99996 has the exponent of 1.00
  const std::string rounded = fmt::format("{:.{}e}", std::abs(value), digits - 1);
  const size_t e = rounded.find('e');
  const int exponent = std::stoi(rounded.substr(e + 1));
  const bool scientific = exponent < -4 || exponent > 5;
  std::string text = scientific
                         ? rounded.substr(0, e)
                         : fmt::format("{:.{}f}", std::stod(rounded), std::max(0, digits - 1 - exponent));
  if (!keep_zeros && text.find('.') != text.npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  if (scientific) text = (text == "1" ? "" : text + "·") + power_of_ten(exponent);
  return value < 0 ? "−" + text : text;
}

}  // namespace

std::string number_text(double value, int digits) {
  return number(value, digits, true);
}

std::string short_number_text(double value, int digits) {
  return number(value, digits, false);
}

}  // namespace easydyn::visu

#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "easydyn/error.hpp"

/// Checks of what a user described. Each throws ModelError with one line of the same form:
///   track "t2000-like": ballast stiffness = -2.5e+07 N/m, must be > 0
/// NaN and infinity never pass.
namespace easydyn {

/// Throws unless `accepted`; `range` is what the value must be, e.g. "> 0".
inline void require(bool accepted, std::string_view object, std::string_view quantity, double value,
                    std::string_view unit, std::string_view range) {
  if (!(accepted && std::isfinite(value))) {
    const std::string_view space = unit.empty() ? "" : " ";
    throw ModelError(
        fmt::format("{}: {} = {:g}{}{}, must be {}", object, quantity, value, space, unit, range));
  }
}

inline void require_positive(std::string_view object, std::string_view quantity, double value,
                             std::string_view unit) {
  require(value > 0, object, quantity, value, unit, "> 0");
}

inline void require_not_negative(std::string_view object, std::string_view quantity, double value,
                                 std::string_view unit) {
  require(value >= 0, object, quantity, value, unit, ">= 0");
}

inline void require_finite(std::string_view object, std::string_view quantity, double value,
                           std::string_view unit) {
  require(true, object, quantity, value, unit, "finite");
}

}  // namespace easydyn

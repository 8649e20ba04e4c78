#pragma once

#include <string>

#include "easydyn/parameter.hpp"
#include "soil/mobility.hpp"

namespace easydyn::soil {

/// What is left of impulse responses at the end of their window: small if the motion has died out.
struct ResponseRest {
  /// Largest displacement in the last tenth of the window over the largest one at all, both of any component at one
  /// place under one load; of all places and loads the largest ratio [1].
  double share = 0;
  double window = 0;  ///< [s]
  std::string
      where;  ///< that place, e.g. "a receiver at (0, 16, 0) m from the footprint"; empty if nothing moves

  static constexpr double accepted = 0.01;  ///< above it the responses are cut off
};

ResponseRest find_rest(const Mobility& mobility);

/// As a row of the parameters.
Parameter describe_rest(const ResponseRest& rest);

}  // namespace easydyn::soil

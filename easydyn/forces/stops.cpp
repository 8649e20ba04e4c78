#include "easydyn/forces/stops.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "easydyn/require.hpp"

namespace easydyn {

Stops::Force Stops::compute_force(double u, double rate) const {
  const double side = u < shortest ? 1 : u > longest ? -1 : 0;  // the way the stop pushes
  if (side == 0) return {};
  const double depth = side > 0 ? shortest - u : u - longest, depth_rate = -side * rate;
  const double force = std::max(0.0, stiffness * depth * (1 + damping * depth_rate));
  return {side * force, 0.5 * stiffness * depth * depth, (force - stiffness * depth) * depth_rate};
}

void Stops::check(std::string_view object, std::string_view unit) const {
  if (!(shortest < longest))
    throw ModelError(fmt::format("{}: stops at {:g} and {:g} {}, the first must be less than the second",
                                 object, shortest, longest, unit));
  require_positive(object, "stiffness of the stops", stiffness, fmt::format("N/{}", unit));
  require_not_negative(object, "damping of the stops", damping, fmt::format("s/{}", unit));
}

}  // namespace easydyn

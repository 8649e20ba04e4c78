#pragma once

#include <limits>
#include <string_view>

namespace easydyn {

/// Elastic stops that bound a length or an angle u to shortest ... longest. Beyond a stop by the depth p,
///
///   F = k p (1 + c p.) >= 0          pushing back
///
/// (Hunt & Crossley, J. Appl. Mech. 42, 1975): the force starts from zero and never pulls. For slow impacts the
/// coefficient of restitution is e = 1 - 2 c v / 3 with the speed v at the touch. Potential energy k p^2 / 2.
struct Stops {
  double shortest = -std::numeric_limits<double>::infinity();  ///< [m or rad]
  double longest = std::numeric_limits<double>::infinity();    ///< [m or rad], > shortest
  double stiffness = 0;                                        ///< k [N/m or N m/rad], > 0
  double damping = 0;                                          ///< c [s/m or s/rad], >= 0

  struct Force {
    double force = 0;       ///< on u: positive lengthens [N or N m]
    double potential = 0;   ///< [J]
    double dissipated = 0;  ///< [W]
  };
  Force compute_force(double u, double rate) const;

  /// @throws ModelError naming `object`
  void check(std::string_view object, std::string_view unit) const;
};

}  // namespace easydyn

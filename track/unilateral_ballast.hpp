#pragma once

#include <algorithm>

namespace easydyn::track {

/// Ballast below a hanging sleeper: it pushes only when the gap is closed, and never pulls.
///
///   c = u_top - u_below - gap
///   F = max(0, k_b c + s d_b c.)   c > 0, else 0       s = min(1, c / c_0),   c_0 = gap / 10
///
/// u are downward [m], F the compression [N]. The damper takes hold over the depth c_0 so that the force is
/// continuous when the sleeper comes down at speed.
struct UnilateralBallast {
  double stiffness;  ///< k_b [N/m], >= 0
  double damping;    ///< d_b [N s/m], >= 0
  double gap;        ///< [m], > 0

  /// @param compression  u_top - u_below [m], @param rate  of it [m/s]
  double force(double compression, double rate) const {
    const double c = compression - gap;
    if (c <= 0) return 0;
    return std::max(0.0, stiffness * c + std::min(1.0, c / (0.1 * gap)) * damping * rate);
  }
  /// Elastic energy k_b c^2 / 2 [J].
  double energy(double compression) const {
    const double c = std::max(0.0, compression - gap);
    return 0.5 * stiffness * c * c;
  }
  /// What the force takes beyond the growth of the energy, F c. - k_b c c. [W], >= 0.
  double dissipated_power(double compression, double rate) const {
    const double c = std::max(0.0, compression - gap);
    return (force(compression, rate) - stiffness * c) * rate;
  }
};

}  // namespace easydyn::track

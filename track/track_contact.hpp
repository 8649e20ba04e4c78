#pragma once

#include "easydyn/mbs/body.hpp"

namespace easydyn::track {

/// A nonlinear force between the track and something on it or under it, at one port of the track: a wheel, the ballast
/// under a hanging sleeper.
///
/// The force F pushes the port apart from its counterpart and depends on the approach a of the two, and on its rate:
///
///   F = F(a, a.)     a falls as the port's displacement (and the height of the body) rises     dF/da >= 0, dF/da. >= 0
///
/// Every evaluation of the system applies F for the present approach; a solver that moves the port or the body by a
/// little can ask for the force then, without evaluating the system again.
class TrackContact {
 public:
  struct Force {
    double F = 0;          ///< [N]
    double stiffness = 0;  ///< dF/da [N/m]
    double damping = 0;    ///< dF/da. [N s/m]
  };

  virtual ~TrackContact() = default;
  /// Where approach and rate are larger than at the last evaluation by `change` [m] and `rate_change` [m/s].
  virtual Force force_after(double change, double rate_change) const = 0;
  /// The body that feels F upward at its origin; null: only the track does.
  virtual const Body* body() const = 0;
};

}  // namespace easydyn::track

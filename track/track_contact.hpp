#pragma once

#include <string>

#include "easydyn/mbs/body.hpp"

namespace easydyn::track {

/// A force between the track and something on it at one port of the track: a wheel, a moving load.
///
/// F pushes the rail down and the body, if there is one, up. It depends on the approach a of the two and on its rate:
///
///   F = F(a, a.)     a falls as the rail goes down or the body up      dF/da >= 0, dF/da. >= 0
///
/// Every evaluation of the system applies F for the present approach; a solver that moves rail or body by a little can
/// ask for the force then, without evaluating the system again.
class TrackContact {
 public:
  struct Force {
    double F = 0;          ///< [N]
    double stiffness = 0;  ///< dF/da [N/m]
    double damping = 0;    ///< dF/da. [N s/m]
  };

  explicit TrackContact(std::string name) : name_(std::move(name)) {}
  virtual ~TrackContact() = default;

  const std::string& name() const { return name_; }
  double force() const { return force_; }                ///< at the last evaluation [N]
  double x() const { return x_; }                        ///< at the last evaluation [m]
  virtual bool is_closed() const { return force_ > 0; }  ///< at the last evaluation

  /// Where approach and rate are larger than at the last evaluation by `change` [m] and `rate_change` [m/s].
  virtual Force force_after(double change, double rate_change) const = 0;
  /// The body that feels F upward at its origin; null: only the track does.
  virtual const Body* body() const = 0;

 protected:
  double force_ = 0, x_ = 0;  // at the last evaluation

 private:
  std::string name_;
};

}  // namespace easydyn::track

#pragma once

#include <algorithm>
#include <cmath>

namespace easydyn::soil {

/// Tells a motion that grows by itself from one that its loads explain. Ground that was at rest never moves with
/// more energy than the loads have brought in:
///
///   T(t) <= max over s <= t of W(s),   T kinetic energy,  W = int sum_j F_j v_j dt
///
/// An unstable time step breaks this long before a number overflows. The kinetic energy is a norm of the motion; the
/// sum of kinetic and strain energy is none: leapfrog conserves it even where both of its parts grow without bound.
/// `tolerance` leaves room for the half step between work and energy.
class EnergyGuard {
 public:
  static constexpr double tolerance = 10;

  /// Work of the loads during a step [J].
  void add_work(double work) {
    work_ += work;
    most_ = std::max(most_, work_);
  }
  double most_work() const { return most_; }  ///< [J] highest W up to now
  bool is_finite(double energy) const { return std::isfinite(energy) && std::isfinite(work_); }
  bool is_explained(double kinetic_energy) const { return kinetic_energy <= tolerance * most_; }

 private:
  double work_ = 0, most_ = 0;
};

}  // namespace easydyn::soil

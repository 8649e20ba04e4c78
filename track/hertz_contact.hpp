#pragma once

#include <cmath>

#include "easydyn/require.hpp"

namespace easydyn::track {

/// Hertzian wheel/rail contact, vertical, without tension.
///
///   F = K delta^(3/2)  for delta > 0,  0 otherwise         delta = r - w - z   (indentation [m])
///
/// z is the height of the wheel centre above its place on an undeformed smooth rail (positive **up**, as the
/// vehicle), w the deflection of the rail (positive **down**, as the track), r the height of the rail's
/// profile (positive **up**). This is the one place where the two directions meet. F pushes the wheel up and
/// the rail down. Conservative: potential energy 2/5 K delta^(5/2), no dissipation. Valid for an indentation
/// far below the wheel radius; F, dF/d(delta) and the energy are continuous at delta = 0.
class HertzContact {
 public:
  /// @param K_wheel   constant of one wheel [N/m^1.5], > 0; 8.6e10 (F: STEM) to 1e11 (F: railFE)
  /// @param contacts  wheels side by side that share the load: 2 for a wheelset, 1 for one wheel
  /// @throws ModelError if a parameter is out of its range
  explicit HertzContact(double K_wheel = 1e11, int contacts = 2) : K_(K_wheel * contacts) {
    require_positive("wheel/rail contact", "K", K_wheel, "N/m^1.5");
    require(contacts >= 1, "wheel/rail contact", "contacts", contacts, "", ">= 1");
  }

  static double indentation(double z, double w, double r) { return r - w - z; }

  double constant() const { return K_; }  ///< all contacts together [N/m^1.5]
  double force(double delta) const { return delta > 0 ? K_ * delta * std::sqrt(delta) : 0; }
  double stiffness(double delta) const {
    return delta > 0 ? 1.5 * K_ * std::sqrt(delta) : 0;
  }  ///< dF/d(delta)
  double energy(double delta) const { return delta > 0 ? 0.4 * K_ * delta * delta * std::sqrt(delta) : 0; }

  /// Indentation under the load Q >= 0 [m].
  double indentation_under(double Q) const { return std::pow(Q / K_, 2.0 / 3.0); }
  /// Linearised stiffness under the load Q: k_H = 1.5 K^(2/3) Q^(1/3) [N/m].
  double stiffness_under(double Q) const { return 1.5 * std::cbrt(K_ * K_ * Q); }

 private:
  double K_;
};

/// Zhai's constant of one wheel of radius R [m] with a worn tread: K = G^-1.5, G = 3.86e-8 R^-0.115
/// m/N^(2/3); cone tread: G = 4.57e-8 R^-0.149. Provenance M-h.
inline double zhai_contact_constant(double R, bool worn_tread) {
  require_positive("wheel/rail contact", "wheel radius", R, "m");
  const double G = worn_tread ? 3.86e-8 * std::pow(R, -0.115) : 4.57e-8 * std::pow(R, -0.149);
  return std::pow(G, -1.5);
}

}  // namespace easydyn::track

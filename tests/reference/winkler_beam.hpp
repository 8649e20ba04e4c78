#pragma once

#include <cmath>
#include <complex>

/// Closed forms of the infinite Euler-Bernoulli beam on a Winkler foundation, w positive along the load.
///
///   E I w'''' + m w.. + k w = p(x, t)
///
/// References: M. Hetenyi, Beams on Elastic Foundation, University of Michigan Press, 1946 (static); L.
/// Fryba, Vibration of Solids and Structures under Moving Loads, 3rd ed., Telford, 1999, chapter 13 (moving
/// load); K. F. Graff, Wave Motion in Elastic Solids, Oxford, 1975, section 3.3 (receptance).
namespace easydyn::reference {

struct WinklerBeam {
  double EI;  ///< [N m2]
  double m;   ///< [kg/m]
  double k;   ///< [N/m2]

  double lambda() const { return std::pow(k / (4 * EI), 0.25); }                  ///< [1/m]
  double critical_speed() const { return std::pow(4 * k * EI / (m * m), 0.25); }  ///< [m/s]

  /// Static deflection at the distance s from the load P [m].
  double static_deflection(double P, double s) const {
    const double ls = lambda() * std::abs(s);
    return P * lambda() / (2 * k) * std::exp(-ls) * (std::cos(ls) + std::sin(ls));
  }

  /// Deflection at s = x - v t under a load that moves at the constant speed v < critical_speed().
  double moving_deflection(double P, double v, double s) const {
    const double a2 = std::pow(v / critical_speed(), 2), l = lambda();
    const double c = l * std::sqrt(1 - a2), d = l * std::sqrt(1 + a2), r = std::abs(s);
    return P * l / (2 * k * std::sqrt(1 - a2)) * std::exp(-c * r) *
           (std::cos(d * r) + std::sqrt((1 - a2) / (1 + a2)) * std::sin(d * r));
  }

  /// Deflection per unit harmonic force at its point, for a complex (damped) foundation stiffness [m/N]:
  /// 1 / (2 sqrt(2) EI^(1/4) (k - m w^2)^(3/4)), on the branch of outgoing and decaying waves.
  std::complex<double> point_receptance(double omega, std::complex<double> k_dynamic) const {
    const std::complex<double> stiffness = k_dynamic - m * omega * omega;
    return 1.0 / (2 * std::sqrt(2.0) * std::pow(EI, 0.25) * std::pow(stiffness, 0.75));
  }
};

/// First pinned-pinned frequency of a rail between supports L apart [Hz].
inline double pinned_pinned_frequency(double EI, double m, double L) {
  return std::acos(-1.0) / (2 * L * L) * std::sqrt(EI / m);
}

}  // namespace easydyn::reference

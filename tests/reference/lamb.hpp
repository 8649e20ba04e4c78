#pragma once

#include <functional>

namespace easydyn::reference {

/// Lamb's problem: a vertical force P H(t), downward, at the origin of the surface of a homogeneous elastic
/// half-space; displacement of the surface at distance r, as u mu r / P against tau = t c_S / r.
///
/// Vertical (positive along the load): closed form; beyond a Poisson ratio of 0.2631 two of its roots are
/// complex and the formula is taken in complex arithmetic. Reference: C. L. Pekeris, PNAS 41, 1955; E. Kausel, "Lamb's problem at
/// its simplest", Proc. R. Soc. A 469, 2013.
///
/// Radial (positive away from the load), derived here from the transform solution by turning the Hankel integral
/// to the imaginary axis, p = i w (w in units of 1 / c_S, a2 = (c_S / c_P)^2):
///
///   u_r = -1/pi^2 int_{sqrt(a2)}^{min(tau, 1)} Im G(i w) w tau / sqrt(tau^2 - w^2) dw
///         - 1/pi Res_R w_R tau / sqrt(tau^2 - w_R^2)   (second term for tau > w_R = c_S / c_R)
///   G = (1 - 2 w^2 - 2 alpha beta) / ((1 - 2 w^2)^2 + 4 w^2 alpha beta), alpha = sqrt(a2 - w^2), beta =
///   sqrt(1 - w^2), Res_R its residue in w at w_R
///
/// The static limits are (1 - nu) / (2 pi) and -(1 - 2 nu) / (4 pi) (Boussinesq).
class Lamb {
 public:
  explicit Lamb(double poisson_ratio);

  double rayleigh_slowness() const { return w_R_; }  ///< c_S / c_R
  double vertical(double tau) const;
  double radial(double tau) const;

  /// Displacement mu r u at time t [s] under the force f(t) instead of a step, given f' and the interval in which
  /// it is not zero; `speed` = c_S [m/s].
  double convolve(bool is_vertical, const std::function<double(double)>& force_rate, double begin, double end,
                  double t, double r, double speed) const;

 private:
  double nu_, a2_, w_R_, residue_radial_;
};

}  // namespace easydyn::reference

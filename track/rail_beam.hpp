#pragma once

#include <Eigen/Core>
#include <limits>

namespace easydyn::track {

/// Values and derivatives with respect to x of the four shape functions of a beam element at one point.
struct BeamShape {
  Eigen::RowVector4d N;    ///< deflection:  w   = N q      [1, m, 1, m]
  Eigen::RowVector4d dN;   ///< slope:       w'  = dN q     [1/m, 1, 1/m, 1]
  Eigen::RowVector4d ddN;  ///< curvature:   w'' = ddN q    [1/m2, 1/m, 1/m2, 1/m]
};

/// What a beam of Timoshenko's theory is made of, per length. The defaults of the last two make it a beam of
/// Euler and Bernoulli.
struct BeamProperties {
  double bending_stiffness = 0;                                      ///< E I [N m2], > 0
  double mass_per_length = 0;                                        ///< rho A [kg/m], > 0
  double shear_stiffness = std::numeric_limits<double>::infinity();  ///< kappa G A [N], > 0
  double rotary_inertia = 0;                                         ///< rho I [kg m], >= 0

  bool is_shear_stiff() const { return shear_stiffness == std::numeric_limits<double>::infinity(); }
};

/// Beam element in the vertical plane.
///
///   kappa G A (w' - phi)' + p = rho A w..        E I phi'' + kappa G A (w' - phi) = rho I phi..
///
/// w is the deflection, positive **downward** [m], phi the rotation of the section [rad], x forward, p the load
/// per length [N/m]. q = (w_1, phi_1, w_2, phi_2). Shape functions are the exact static solution without load,
/// which depends on Phi = 12 E I / (kappa G A l^2): the static stiffness is exact at any length, there is no
/// locking. The mass is consistent with the same functions, for the deflection (rho A) and the rotation (rho I).
///
/// Euler and Bernoulli (kappa G A infinite, rho I = 0): phi = w', cubic Hermite polynomials, frequencies converge with
/// the fourth order, valid below about 1 kHz for a rail. Timoshenko: w' jumps at the nodes where the shear force does;
/// frequencies converge with the second order, as the shear force is constant in an element (1 % at the pinned-pinned
/// frequency of a rail with four elements between the sleepers).
///
/// At a contact that moves with x_c(t) the deflection, its rate and its acceleration are
///   w = N q,   dw/dt = N qd + v dN q,   d2w/dt2 = N qdd + 2 v dN qd + v^2 ddN q + a dN q
/// with v = dx_c/dt, a = dv/dt: the convective terms.
///
/// References: J. S. Przemieniecki, Theory of Matrix Structural Analysis, McGraw-Hill, 1968, sections 5.6 and
/// 11.4; Z. Friedman, J. B. Kosmatka, An improved two-node Timoshenko beam finite element, Comput. Struct. 47(3),
/// 1993, doi:10.1016/0045-7949(93)90243-7.
class BeamElement {
 public:
  /// Euler and Bernoulli.
  /// @param EI      bending stiffness [N m2], > 0
  /// @param rhoA    mass per length [kg/m], > 0
  /// @param length  [m], > 0
  /// @throws ModelError if a parameter is out of its range
  BeamElement(double EI, double rhoA, double length) : BeamElement(BeamProperties{EI, rhoA}, length) {}
  BeamElement(const BeamProperties& beam, double length);

  Eigen::Matrix4d compute_stiffness() const;  ///< symmetric, two rigid-body motions [N/m, N, N m]
  Eigen::Matrix4d compute_mass() const;       ///< consistent, positive definite [kg, kg m, kg m2]
  /// Deflection at the relative position xi = (x - x_1) / length in [0, 1].
  BeamShape shape(double xi) const;
  Eigen::RowVector4d rotation_shape(double xi) const;  ///< phi = T q  [1/m, 1, 1/m, 1]
  double length() const { return length_; }

 private:
  BeamProperties beam_;
  double length_;
  double Phi_;  ///< 12 E I / (kappa G A l^2), 0 for Euler and Bernoulli
};

/// Hermite shape functions (Euler and Bernoulli) at the relative position xi = (x - x_1) / length in [0, 1].
BeamShape compute_beam_shape(double xi, double length);

}  // namespace easydyn::track

#pragma once

#include <Eigen/Core>

namespace easydyn::track {

/// Values and derivatives with respect to x of the four shape functions of a beam element at one point.
struct BeamShape {
  Eigen::RowVector4d N;    ///< deflection:  w   = N q      [1, m, 1, m]
  Eigen::RowVector4d dN;   ///< slope:       w'  = dN q     [1/m, 1, 1/m, 1]
  Eigen::RowVector4d ddN;  ///< curvature:   w'' = ddN q    [1/m2, 1/m, 1/m2, 1/m]
};

/// Euler-Bernoulli beam element in the vertical plane.
///
///   E I w'''' + rho A w.. = p(x, t)       w(x) = N(x) q,  q = (w_1, w_1', w_2, w_2')
///
/// w is the deflection, positive **downward** [m], w' = dw/dx its slope [rad], x forward. N are the cubic
/// Hermite polynomials: w and w' are continuous along the rail, w'' jumps at the nodes by the discretisation
/// error. Valid below about 1 kHz for a rail (no shear, no rotary inertia).
///
/// At a contact that moves with x_c(t) the deflection, its rate and its acceleration are
///   w = N q,   dw/dt = N qd + v dN q,   d2w/dt2 = N qdd + 2 v dN qd + v^2 ddN q + a dN q
/// with v = dx_c/dt, a = dv/dt: the convective terms.
///
/// Reference: J. S. Przemieniecki, Theory of Matrix Structural Analysis, McGraw-Hill, 1968, sections 5.6
/// and 11.4 (without shear).
class BeamElement {
 public:
  /// @param EI      bending stiffness [N m2], > 0
  /// @param rhoA    mass per length [kg/m], > 0
  /// @param length  [m], > 0
  /// @throws ModelError if a parameter is out of its range
  BeamElement(double EI, double rhoA, double length);

  Eigen::Matrix4d compute_stiffness() const;  ///< symmetric, two rigid-body motions [N/m, N, N m]
  Eigen::Matrix4d compute_mass() const;       ///< consistent, positive definite [kg, kg m, kg m2]
  double length() const { return length_; }

 private:
  double EI_, rhoA_, length_;
};

/// Hermite shape functions at the relative position xi = (x - x_1) / length in [0, 1].
BeamShape compute_beam_shape(double xi, double length);

}  // namespace easydyn::track

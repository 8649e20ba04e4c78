#include "track/rail_beam.hpp"

#include <array>

#include "easydyn/require.hpp"

namespace easydyn::track {

BeamElement::BeamElement(const BeamProperties& beam, double length) : beam_(beam), length_(length) {
  require_positive("beam element", "EI", beam.bending_stiffness, "N m2");
  require_positive("beam element", "rhoA", beam.mass_per_length, "kg/m");
  if (!beam.is_shear_stiff()) require_positive("beam element", "kappa G A", beam.shear_stiffness, "N");
  require_not_negative("beam element", "rhoI", beam.rotary_inertia, "kg m");
  require_positive("beam element", "length", length, "m");
  Phi_ = 12 * beam.bending_stiffness / (beam.shear_stiffness * length * length);
}

Eigen::Matrix4d BeamElement::compute_stiffness() const {
  const double l = length_, Phi = Phi_;
  Eigen::Matrix4d K;
  K << 12, 6 * l, -12, 6 * l,                               //
      6 * l, (4 + Phi) * l * l, -6 * l, (2 - Phi) * l * l,  //
      -12, -6 * l, 12, -6 * l,                              //
      6 * l, (2 - Phi) * l * l, -6 * l, (4 + Phi) * l * l;
  return beam_.bending_stiffness / (l * l * l * (1 + Phi)) * K;
}

Eigen::Matrix4d BeamElement::compute_mass() const {
  // Gauss, four points: exact up to degree 7, the products of cubics have 6
  constexpr std::array<double, 2> place = {0.8611363115940526, 0.3399810435848563};
  constexpr std::array<double, 2> weight = {0.3478548451374538, 0.6521451548625461};
  Eigen::Matrix4d M = Eigen::Matrix4d::Zero();
  for (std::size_t p = 0; p < place.size(); ++p)
    for (const double side : {-1, 1}) {
      const double xi = 0.5 * (1 + side * place[p]), dx = 0.5 * weight[p] * length_;
      const Eigen::RowVector4d N = shape(xi).N, T = rotation_shape(xi);
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
          M(i, j) += dx * (beam_.mass_per_length * (N[i] * N[j]) + beam_.rotary_inertia * (T[i] * T[j]));
    }
  return M;
}

BeamShape BeamElement::shape(double xi) const {
  if (Phi_ == 0) return compute_beam_shape(xi, length_);
  // Hermite's functions and Phi times the shear part, linear in the ends and a parabola from their rotations
  const double l = length_, bubble = 0.5 * l * (xi - xi * xi), dbubble = 0.5 * (1 - 2 * xi);
  BeamShape s = compute_beam_shape(xi, l);
  s.N += Phi_ * Eigen::RowVector4d(1 - xi, bubble, xi, -bubble);
  s.dN += Phi_ * Eigen::RowVector4d(-1 / l, dbubble, 1 / l, -dbubble);
  s.ddN += Phi_ * Eigen::RowVector4d(0, -1 / l, 0, 1 / l);
  s.N /= 1 + Phi_;
  s.dN /= 1 + Phi_;
  s.ddN /= 1 + Phi_;
  return s;
}

Eigen::RowVector4d BeamElement::rotation_shape(double xi) const {
  const Eigen::RowVector4d T =
      compute_beam_shape(xi, length_).dN + Phi_ * Eigen::RowVector4d(0, 1 - xi, 0, xi);
  return T / (1 + Phi_);
}

BeamShape compute_beam_shape(double xi, double length) {
  const double l = length, x2 = xi * xi, x3 = x2 * xi;
  BeamShape s;
  s.N << 1 - 3 * x2 + 2 * x3, l * (xi - 2 * x2 + x3), 3 * x2 - 2 * x3, l * (x3 - x2);
  s.dN << 6 * (x2 - xi) / l, 1 - 4 * xi + 3 * x2, 6 * (xi - x2) / l, 3 * x2 - 2 * xi;
  s.ddN << (12 * xi - 6) / (l * l), (6 * xi - 4) / l, (6 - 12 * xi) / (l * l), (6 * xi - 2) / l;
  return s;
}

}  // namespace easydyn::track

#include "track/rail_beam.hpp"

#include "easydyn/require.hpp"

namespace easydyn::track {

BeamElement::BeamElement(double EI, double rhoA, double length) : EI_(EI), rhoA_(rhoA), length_(length) {
  require_positive("beam element", "EI", EI, "N m2");
  require_positive("beam element", "rhoA", rhoA, "kg/m");
  require_positive("beam element", "length", length, "m");
}

Eigen::Matrix4d BeamElement::compute_stiffness() const {
  const double l = length_;
  Eigen::Matrix4d K;
  K << 12, 6 * l, -12, 6 * l,               //
      6 * l, 4 * l * l, -6 * l, 2 * l * l,  //
      -12, -6 * l, 12, -6 * l,              //
      6 * l, 2 * l * l, -6 * l, 4 * l * l;
  return EI_ / (l * l * l) * K;
}

Eigen::Matrix4d BeamElement::compute_mass() const {
  const double l = length_;
  Eigen::Matrix4d M;
  M << 156, 22 * l, 54, -13 * l,              //
      22 * l, 4 * l * l, 13 * l, -3 * l * l,  //
      54, 13 * l, 156, -22 * l,               //
      -13 * l, -3 * l * l, -22 * l, 4 * l * l;
  return rhoA_ * l / 420 * M;
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

#pragma once

#include <Eigen/Core>

namespace easydyn::soil {

/// Gauss-Lobatto-Legendre points of one element of degree N on [-1, 1]: nodes of the shape functions and
/// quadrature points at once, which makes the mass diagonal. The quadrature is exact to degree 2 N - 1.
struct GllRule {
  explicit GllRule(int degree);  ///< @throws ModelError unless 1 <= degree <= 12

  int degree;
  Eigen::VectorXd points;      ///< N + 1, ascending, first -1, last 1
  Eigen::VectorXd weights;     ///< N + 1, sum 2
  Eigen::MatrixXd derivative;  ///< (i, j): derivative of shape function j at point i

  /// Values of the N + 1 shape functions at s.
  Eigen::VectorXd compute_shape(double s) const;
  /// Integrals of the N + 1 shape functions over [a, b], exact.
  Eigen::VectorXd integrate_shape(double a, double b) const;
  /// Stiffness of a line element on [-1, 1]: sum_q w_q D_qi D_qj.
  Eigen::MatrixXd compute_stiffness() const;
  /// Antisymmetric part of w_i D_ij; the symmetric part is diag(-1/2, 0, ..., 0, 1/2), because w_i D_ij +
  /// w_j D_ji are the end values of the product of two shape functions.
  Eigen::MatrixXd compute_antisymmetric_gradient() const;
};

}  // namespace easydyn::soil

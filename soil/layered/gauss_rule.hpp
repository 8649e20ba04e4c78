#pragma once

#include <Eigen/Core>

namespace easydyn::soil {

/// Gauss-Legendre points and weights on [-1, 1]: exact for polynomials up to degree 2 n - 1.
struct GaussRule {
  explicit GaussRule(int n);
  Eigen::VectorXd points, weights;
};

}  // namespace easydyn::soil

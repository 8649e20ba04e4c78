#pragma once
// Private to easydyn/sim: matrices of states in mixed units.

#include <Eigen/Core>
#include <cmath>

namespace easydyn {

/// Scales rows and columns of A by powers of two so that both have like norms: entries in pascal beside some in metre
/// would drown in each other's rounding. A becomes S^-1 A S; returns the diagonal of S, so that an eigenvector of the
/// scaled matrix times S is one of A.
/// Reference: B. N. Parlett, C. Reinsch, Numer. Math. 13, 1969, algorithm "balance".
inline Eigen::VectorXd balance(Eigen::MatrixXd& A) {
  const Eigen::Index n = A.rows();
  Eigen::VectorXd scales = Eigen::VectorXd::Ones(n);
  for (bool has_changed = true; has_changed;) {
    has_changed = false;
    for (Eigen::Index i = 0; i < n; ++i) {
      const double diagonal = std::abs(A(i, i)), column = A.col(i).lpNorm<1>() - diagonal,
                   row = A.row(i).lpNorm<1>() - diagonal;
      if (!(column > 0) || !(row > 0)) continue;
      const double f = std::exp2(std::round(0.5 * std::log2(row / column)));
      if (column * f + row / f >= 0.95 * (column + row)) continue;
      A.col(i) *= f;
      A.row(i) /= f;
      scales[i] *= f;
      has_changed = true;
    }
  }
  return scales;
}

}  // namespace easydyn

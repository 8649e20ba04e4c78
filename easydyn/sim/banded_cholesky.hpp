#pragma once

#include <Eigen/Core>

#include "easydyn/mbs/linear_structure.hpp"

namespace easydyn {

/// Several right-hand sides side by side: row i holds entry i of each, so that solving eight costs little
/// more than solving one.
using RightHandSides = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Cholesky factor A = L L^T of a symmetric positive definite banded matrix.
///
/// Factor: n b^2 operations, solve: 4 n b per right-hand side, memory n (b + 1) doubles, b = half bandwidth.
/// Reference: G. Golub, C. Van Loan, Matrix Computations, 4th ed., 2013, sec. 4.3.5.
class BandedCholesky {
 public:
  BandedCholesky() = default;
  /// @throws SolverError naming `name` and the row if A is not positive definite
  BandedCholesky(const SparseMatrix& A, int half_bandwidth, const std::string& name);

  /// X := A^-1 X.
  void solve_in_place(RightHandSides& X) const;
  /// x := A^-1 x for n numbers. Each unknown takes part in the next ones as soon as it is known, so that the way through
  /// the matrix is as short as the additions allow.
  void solve_in_place(double* x) const;
  /// Rows first <= i <= last of column j of A^-1, into x[0] ... x[last - first]. Exact but for what the forward
  /// substitution leaves beyond `last`: for a column that has decayed there.
  void solve_unit_in_part(int j, int first, int last, double* x) const;
  int size() const { return n_; }
  int half_bandwidth() const { return b_; }

 private:
  template <int columns>
  void solve_columns(double* X, int stride) const;

  int n_ = 0, b_ = 0;
  // Row i holds L(i, i-b) ... L(i, i-1), then 1 / L(i, i).
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> L_;
  // Row i holds L(i+1, i) ... L(i+b, i): the columns, one after the other.
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> columns_;
};

}  // namespace easydyn

#pragma once

#include <Eigen/Core>

#include "easydyn/mbs/linear_structure.hpp"

namespace easydyn {

/// Several right-hand sides side by side: row i holds entry i of each, so that solving eight costs little
/// more than solving one.
using RightHandSides = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Factors A = L D L^T of a symmetric positive definite banded matrix, L with ones on its diagonal (Cholesky's method
/// without square roots).
///
/// Factor: n b^2 operations, solve: 4 n b per right-hand side, memory 2 n (b + 1) doubles, b = half bandwidth.
/// Reference: G. Golub, C. Van Loan, Matrix Computations, 4th ed., 2013, sec. 4.3.5 and 4.3.6.
class BandedCholesky {
 public:
  BandedCholesky() = default;
  /// @throws SolverError naming `name` and the row if A is not positive definite
  BandedCholesky(const SparseMatrix& A, int half_bandwidth, const std::string& name);

  /// X := A^-1 X.
  void solve_in_place(RightHandSides& X) const;
  /// x := A^-1 x for n numbers. The last b unknowns stay in registers; an unknown waits for the one before it by one
  /// multiplication and addition only.
  void solve_in_place(double* x) const;
  /// Rows first <= i <= last of column j of A^-1, into x[0] ... x[last - first]. Exact but for what the forward
  /// substitution leaves beyond `last`: for a column that has decayed there.
  void solve_unit_in_part(int j, int first, int last, double* x) const;
  int size() const { return n_; }
  int half_bandwidth() const { return b_; }

 private:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  template <int columns>
  void solve_columns(double* X, int stride) const;
  template <int b>
  void solve_with_bandwidth(double* x) const;
  void forward_row(int i, double* x) const;
  void backward_row(int i, double* x) const;

  int n_ = 0, b_ = 0;
  Rows rows_;     // row i holds L(i, i-b) ... L(i, i-1)
  Rows columns_;  // row i holds L(i+1, i) ... L(i+b, i)
  Eigen::VectorXd inverse_D_;
};

}  // namespace easydyn

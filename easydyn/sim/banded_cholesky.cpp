#include "easydyn/sim/banded_cholesky.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "easydyn/error.hpp"

namespace easydyn {

BandedCholesky::BandedCholesky(const SparseMatrix& A, int half_bandwidth, const std::string& name)
    : n_(static_cast<int>(A.rows())), b_(half_bandwidth) {
  L_.setZero(n_, b_ + 1);
  for (int i = 0; i < n_; ++i)
    for (SparseMatrix::InnerIterator it(A, i); it; ++it)
      if (it.col() <= i) L_(i, static_cast<int>(it.col()) - i + b_) = it.value();

  // Row by row: L(i,j) = (A(i,j) - sum_k L(i,k) L(j,k)) / L(j,j).
  for (int i = 0; i < n_; ++i) {
    const int first = std::max(0, i - b_);
    double* row_i = L_.row(i).data() + (b_ - i);  // row_i[j] = L(i, j)
    for (int j = first; j < i; ++j) {
      const double* row_j = L_.row(j).data() + (b_ - j);
      double sum = row_i[j];
      for (int k = std::max(first, j - b_); k < j; ++k) sum -= row_i[k] * row_j[k];
      row_i[j] = sum * row_j[j];
    }
    double pivot = row_i[i];
    for (int k = first; k < i; ++k) pivot -= row_i[k] * row_i[k];
    if (!(pivot > 0))
      throw SolverError(
          fmt::format("structure \"{}\": matrix is not positive definite at coordinate {} "
                      "(pivot {:.3g}); is it free to move, or is a stiffness or mass negative?",
                      name, i, pivot));
    row_i[i] = 1 / std::sqrt(pivot);
  }
  columns_.setZero(n_, b_);
  for (int i = 0; i < n_; ++i)
    for (int k = 1; k <= std::min(b_, n_ - 1 - i); ++k) columns_(i, k - 1) = L_(i + k, b_ - k);
}

template <int columns>
void BandedCholesky::solve_columns(double* X, int stride) const {
  using Row = Eigen::Array<double, 1, columns>;
  const auto row = [X, stride](int i) {
    return Eigen::Map<Row>(X + static_cast<std::ptrdiff_t>(i) * stride);
  };
  // L y = x
  for (int i = 0; i < n_; ++i) {
    const double* L = L_.row(i).data() + (b_ - i);
    Row sum = row(i);
    for (int k = std::max(0, i - b_); k < i; ++k) sum -= L[k] * row(k);
    row(i) = sum * L[i];
  }
  // L^T x = y
  for (int i = n_ - 1; i >= 0; --i) {
    const double* L = L_.row(i).data() + (b_ - i);
    const Row x = row(i) * L[i];
    row(i) = x;
    for (int k = std::max(0, i - b_); k < i; ++k) row(k) -= L[k] * x;
  }
}

void BandedCholesky::solve_in_place(double* x) const {
  // L y = x, column by column
  for (int i = 0; i < n_; ++i) {
    const double y = x[i] * L_(i, b_);
    x[i] = y;
    const double* L = columns_.row(i).data();
    const int rest = std::min(b_, n_ - 1 - i);
    for (int k = 0; k < rest; ++k) x[i + 1 + k] -= L[k] * y;
  }
  // L^T x = y, row by row
  for (int i = n_ - 1; i >= 0; --i) {
    const double* L = L_.row(i).data();
    const double value = x[i] * L[b_];
    x[i] = value;
    for (int k = std::max(0, b_ - i); k < b_; ++k) x[i - b_ + k] -= L[k] * value;
  }
}

void BandedCholesky::solve_unit_in_part(int j, int first, int last, double* x) const {
  std::fill_n(x, last - first + 1, 0.0);
  x -= first;  // now by row
  x[j] = 1;
  for (int i = j; i <= last; ++i) {
    x[i] *= L_(i, b_);
    for (int k = 1; k <= std::min(b_, last - i); ++k) x[i + k] -= columns_(i, k - 1) * x[i];
  }
  for (int i = last; i >= first; --i) {
    x[i] *= L_(i, b_);
    for (int k = std::max(first, i - b_); k < i; ++k) x[k] -= L_(i, k - i + b_) * x[i];
  }
}

void BandedCholesky::solve_in_place(RightHandSides& X) const {
  const int m = static_cast<int>(X.cols());
  int c = 0;
  for (; c + 8 <= m; c += 8) solve_columns<8>(X.data() + c, m);
  for (; c + 4 <= m; c += 4) solve_columns<4>(X.data() + c, m);
  if (m == 1) return solve_in_place(X.data());
  for (; c < m; ++c) solve_columns<1>(X.data() + c, m);
}

}  // namespace easydyn

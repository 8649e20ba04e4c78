#include "easydyn/sim/banded_cholesky.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "easydyn/error.hpp"

namespace easydyn {

BandedCholesky::BandedCholesky(const SparseMatrix& A, int half_bandwidth, const std::string& name)
    : n_(static_cast<int>(A.rows())),
      b_(std::max(1, half_bandwidth)) {  // a diagonal matrix too has its arrays
  Eigen::VectorXd D = Eigen::VectorXd::Zero(n_);
  rows_.setZero(n_, b_);
  for (int i = 0; i < n_; ++i)
    for (SparseMatrix::InnerIterator it(A, i); it; ++it) {
      if (it.col() < i) rows_(i, static_cast<int>(it.col()) - i + b_) = it.value();
      if (it.col() == i) D[i] = it.value();
    }

  // Row by row, first with G = L D in its place: G(i,j) = A(i,j) - sum_k G(i,k) L(j,k), D(i) = A(i,i) - sum_k G(i,k) L(i,k).
  inverse_D_.resize(n_);
  for (int i = 0; i < n_; ++i) {
    const int first = std::max(0, i - b_);
    double* const row_i =
        rows_.data() + static_cast<std::ptrdiff_t>(i) * b_ + (b_ - i);  // row_i[j] = L(i, j)
    for (int j = first; j < i; ++j) {
      const double* const row_j = rows_.data() + static_cast<std::ptrdiff_t>(j) * b_ + (b_ - j);
      double sum = row_i[j];
      for (int k = std::max(first, j - b_); k < j; ++k) sum -= row_i[k] * row_j[k];
      row_i[j] = sum;
    }
    double pivot = D[i];
    for (int k = first; k < i; ++k) {
      const double G = row_i[k];
      row_i[k] = G * inverse_D_[k];
      pivot -= G * row_i[k];
    }
    if (!(pivot > 0))
      throw SolverError(
          fmt::format("structure \"{}\": matrix is not positive definite at coordinate {} "
                      "(pivot {:.3g}); is it free to move, or is a stiffness or mass negative?",
                      name, i, pivot));
    inverse_D_[i] = 1 / pivot;
  }
  columns_.setZero(n_, b_);
  for (int i = 0; i < n_; ++i)
    for (int k = 1; k <= std::min(b_, n_ - 1 - i); ++k) columns_(i, k - 1) = rows_(i + k, b_ - k);
}

template <int columns>
void BandedCholesky::solve_columns(double* X, int stride) const {
  using Row = Eigen::Array<double, 1, columns>;
  const auto row = [X, stride](int i) {
    return Eigen::Map<Row>(X + static_cast<std::ptrdiff_t>(i) * stride);
  };
  // L y = x
  for (int i = 0; i < n_; ++i) {
    const double* const L = rows_.data() + static_cast<std::ptrdiff_t>(i) * b_ + (b_ - i);
    Row sum = row(i);
    for (int k = std::max(0, i - b_); k < i; ++k) sum -= L[k] * row(k);
    row(i) = sum;
  }
  // L^T x = D^-1 y
  for (int i = n_ - 1; i >= 0; --i) {
    const double* const L = columns_.data() + static_cast<std::ptrdiff_t>(i) * b_;
    Row sum = row(i) * inverse_D_[i];
    for (int k = 1; k <= std::min(b_, n_ - 1 - i); ++k) sum -= L[k - 1] * row(i + k);
    row(i) = sum;
  }
}

void BandedCholesky::forward_row(int i, double* x) const {
  const double* const L = rows_.data() + static_cast<std::ptrdiff_t>(i) * b_ + (b_ - i);
  double sum = x[i];
  for (int k = std::max(0, i - b_); k < i; ++k) sum -= L[k] * x[k];
  x[i] = sum;
}

void BandedCholesky::backward_row(int i, double* x) const {
  const double* const L = columns_.data() + static_cast<std::ptrdiff_t>(i) * b_;
  double sum = x[i] * inverse_D_[i];
  for (int k = std::min(b_, n_ - 1 - i); k >= 1; --k) sum -= L[k - 1] * x[i + k];
  x[i] = sum;
}

namespace {

// x_i less the products with the b unknowns before it, which w holds in the order of their rows modulo b; the newest comes
// last. j = i modulo b.
template <int b, int j, int... k>
inline double next_forward(const double* L, double x, const double* w, std::integer_sequence<int, k...>) {
  ((x -= L[k] * w[(j + k) % b]), ...);
  return x;
}

// The same from the other end: x_(i+b) comes first, x_(i+1) last.
template <int b, int j, int... k>
inline double next_backward(const double* L, double x, const double* w, std::integer_sequence<int, k...>) {
  ((x -= L[b - 1 - k] * w[(j + b - k) % b]), ...);
  return x;
}

template <int b, int... j>
inline void forward_block(const double* rows, double* x, double* w, std::integer_sequence<int, j...>) {
  ((x[j] = w[j] = next_forward<b, j>(rows + j * b, x[j], w, std::make_integer_sequence<int, b>())), ...);
}

template <int b, int... j>
inline void backward_block(const double* columns, const double* inverse_D, double* x, double* w,
                           std::integer_sequence<int, j...>) {
  ((x[b - 1 - j] = w[b - 1 - j] =
        next_backward<b, b - 1 - j>(columns + (b - 1 - j) * b, x[b - 1 - j] * inverse_D[b - 1 - j], w,
                                    std::make_integer_sequence<int, b>())),
   ...);
}

}  // namespace

template <int b>
void BandedCholesky::solve_with_bandwidth(double* x) const {
  const int whole = n_ - n_ % b;
  double w[b] = {};
  for (int i = 0; i < whole; i += b)
    forward_block<b>(rows_.data() + static_cast<std::ptrdiff_t>(i) * b, x + i, w,
                     std::make_integer_sequence<int, b>());
  for (int i = whole; i < n_; ++i) forward_row(i, x);
  for (int i = n_ - 1; i >= whole; --i) backward_row(i, x);
  for (int j = 0; j < b; ++j) w[j] = whole + j < n_ ? x[whole + j] : 0;
  for (int i = whole - b; i >= 0; i -= b)
    backward_block<b>(columns_.data() + static_cast<std::ptrdiff_t>(i) * b, inverse_D_.data() + i, x + i, w,
                      std::make_integer_sequence<int, b>());
}

void BandedCholesky::solve_in_place(double* x) const {
  switch (b_) {  // those of tracks with 2 to 6 elements per bay
    case 6:
      return solve_with_bandwidth<6>(x);
    case 7:
      return solve_with_bandwidth<7>(x);
    case 8:
      return solve_with_bandwidth<8>(x);
    case 9:
      return solve_with_bandwidth<9>(x);
    case 10:
      return solve_with_bandwidth<10>(x);
    case 11:
      return solve_with_bandwidth<11>(x);
    case 12:
      return solve_with_bandwidth<12>(x);
    case 13:
      return solve_with_bandwidth<13>(x);
    case 14:
      return solve_with_bandwidth<14>(x);
    default:
      break;
  }
  for (int i = 0; i < n_; ++i) forward_row(i, x);
  for (int i = n_ - 1; i >= 0; --i) backward_row(i, x);
}

void BandedCholesky::solve_unit_in_part(int j, int first, int last, double* x) const {
  std::fill_n(x, last - first + 1, 0.0);
  const auto at = [x, first](int i) -> double& { return x[i - first]; };
  at(j) = 1;
  for (int i = j; i <= last; ++i)
    for (int k = 1; k <= std::min(b_, last - i); ++k) at(i + k) -= columns_(i, k - 1) * at(i);
  for (int i = j; i <= last; ++i) at(i) *= inverse_D_[i];
  for (int i = last; i >= first; --i)
    for (int k = std::max(first, i - b_); k < i; ++k) at(k) -= rows_(i, k - i + b_) * at(i);
}

void BandedCholesky::solve_in_place(RightHandSides& X) const {
  const int m = static_cast<int>(X.cols());
  if (m == 1) return solve_in_place(X.data());
  int c = 0;
  for (; c + 8 <= m; c += 8) solve_columns<8>(X.data() + c, m);
  for (; c + 4 <= m; c += 4) solve_columns<4>(X.data() + c, m);
  for (; c < m; ++c) solve_columns<1>(X.data() + c, m);
}

}  // namespace easydyn

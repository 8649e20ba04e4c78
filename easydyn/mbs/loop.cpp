#include "easydyn/mbs/loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "easydyn/error.hpp"

namespace easydyn {

using Eigen::VectorXd;

namespace {
// Pivots of J below this part of the largest count as zero: angles of a linkage closer than that to a dead
// point cannot tell one branch from the other.
constexpr double rank_threshold = 1e-7;
constexpr int max_iterations = 50, max_halvings = 12;
}  // namespace

LoopClosure::LoopClosure(std::string system, std::string name, std::span<const double> guess, int first)
    : system_(std::move(system)), name_(std::move(name)), n_(static_cast<int>(guess.size())), first_(first) {
  set_guess(guess);
  rate_ = bias_ = step_ = VectorXd::Zero(n_);
  gradients_.resize(guess.size());
}

void LoopClosure::set_guess(std::span<const double> guess) {
  for (const double value : guess)
    if (!std::isfinite(value))
      throw ModelError(fmt::format("loop \"{}\": guess {} must be finite", name_, value));
  p_ = guess_ = VectorXd::Map(guess.data(), n_);
  orientation_ = 0;
}

void LoopClosure::write_guess(double* memory) const {
  std::copy_n(guess_.data(), n_, memory);
  memory[n_] = 0;
}

void LoopClosure::write_memory(double* memory) const {
  std::copy_n(p_.data(), n_, memory);
  memory[n_] = orientation_;
}

void LoopClosure::read_memory(const double* memory) {
  std::copy_n(memory, n_, p_.data());
  orientation_ = static_cast<int>(memory[n_]);
}

void LoopClosure::begin(double t) {
  t_ = t;
  start_ = p_;
  phase_ = Phase::newton;
  iterations_ = halvings_ = 0;
  rate_.setZero();
  bias_.setZero();
}

Expr LoopClosure::unknown(int i) const {
  return Expr::of_parts(p_[i], rate_[i], bias_[i], Gradient::unit(first_ + i));
}

Expr LoopClosure::solution(int i) const {
  return Expr::of_parts(p_[i], rate_[i], bias_[i], gradients_[static_cast<std::size_t>(i)]);
}

void LoopClosure::fail(const std::string& what) {
  std::string values;
  for (int i = 0; i < n_; ++i) values += fmt::format("{}{:.6g}", i ? ", " : "", p_[i]);
  p_ = start_;  // the last good solution
  throw SolverError(fmt::format("loop \"{}\" of system \"{}\" {} at t = {} s; its unknowns are ({})", name_,
                                system_, what, t_, values));
}

void LoopClosure::decompose(std::span<const Expr> equations) {
  const auto m = static_cast<Eigen::Index>(equations.size());
  if (m < n_)
    throw ModelError(fmt::format("loop \"{}\" of system \"{}\": {} equations, must be at least {}", name_,
                                 system_, m, n_));
  jacobian_.setZero(m, n_);
  for (Eigen::Index e = 0; e < m; ++e)
    for (const Gradient::Entry& g : equations[static_cast<std::size_t>(e)].gradient())
      if (g.coordinate >= first_ && g.coordinate < first_ + n_) jacobian_(e, g.coordinate - first_) = g.value;
  if (!jacobian_.allFinite()) fail("has equations that are not finite");
  scale_ = jacobian_.cwiseAbs().maxCoeff();
  qr_.compute(jacobian_);
  qr_.setThreshold(rank_threshold);
}

// As qr_.solve(right), without its temporary vectors: J P = Q R, x = P R^-1 Q^T right.
template <class X>
void LoopClosure::solve_least_squares(VectorXd& right, X&& x) {
  const Eigen::MatrixXd& QR = qr_.matrixQR();
  const Eigen::Index m = QR.rows(), rank = qr_.nonzeroPivots();
  double workspace = 0;
  for (Eigen::Index k = 0; k < rank; ++k)
    right.tail(m - k).applyHouseholderOnTheLeft(QR.col(k).tail(m - k - 1), qr_.hCoeffs()[k], &workspace);
  QR.topLeftCorner(rank, rank).triangularView<Eigen::Upper>().solveInPlace(right.head(rank));
  x.setZero();
  for (Eigen::Index k = 0; k < rank; ++k) x[qr_.colsPermutation().indices()[k]] = right[k];
}

int LoopClosure::compute_orientation() const {
  if (jacobian_.rows() != n_) return 0;
  // J P = Q R; each reflection of Q changes the sign, unless it has nothing to do.
  const auto& order = qr_.colsPermutation().indices();
  bool is_negative = false;
  for (int i = 0; i < n_; ++i) {
    if (qr_.matrixQR()(i, i) < 0) is_negative = !is_negative;
    if (qr_.hCoeffs()[i] != 0) is_negative = !is_negative;
    for (int j = 0; j < i; ++j)
      if (order[j] > order[i]) is_negative = !is_negative;
  }
  return is_negative ? -1 : 1;
}

bool LoopClosure::take(std::span<const Expr> equations) {
  const auto m = static_cast<Eigen::Index>(equations.size());
  residual_.resize(m);
  right_.resize(m);
  for (Eigen::Index e = 0; e < m; ++e) residual_[e] = equations[static_cast<std::size_t>(e)].value();
  const double norm = residual_.norm();

  if (phase_ == Phase::rates) {
    // The second derivatives are those of g with the rates known; gradients as before.
    for (Eigen::Index e = 0; e < m; ++e) right_[e] = -equations[static_cast<std::size_t>(e)].bias();
    solve_least_squares(right_, bias_);
    return true;
  }

  const bool is_rounding = norm < 1e-12 * (1 + scale_);
  if (phase_ == Phase::line_search && !(norm <= last_norm_) && !is_rounding && halvings_ < max_halvings) {
    // Too far (or out of the domain of a function): half the step.
    ++halvings_;
    step_ *= 0.5;
    p_ -= step_;
    return false;
  }
  if (!std::isfinite(norm)) fail("has equations that are not finite");

  decompose(equations);
  last_norm_ = norm;
  halvings_ = 0;
  if (++iterations_ > max_iterations)
    fail(fmt::format("cannot be closed: residual {:.3g} after {} iterations", norm, max_iterations));
  right_ = -residual_;
  solve_least_squares(right_, step_);

  // Rounding of the equations: the closure is as good as numbers allow when the step no longer counts.
  const double magnitude = 1 + p_.lpNorm<Eigen::Infinity>();
  const double size = step_.lpNorm<Eigen::Infinity>();
  if (size > 1e-13 * magnitude && !(size < 1e-10 * magnitude && iterations_ > 10)) {
    p_ += step_;
    phase_ = Phase::line_search;
    return false;
  }
  p_ += step_;
  if (norm > 1e-9 * (scale_ * magnitude) + 1e-12)
    fail(fmt::format("cannot be closed: its equations contradict each other (residual {:.3g})", norm));
  if (qr_.rank() < n_)
    fail(
        fmt::format("is singular (rank {} of {}): the mechanism is at a dead point or has more freedom than "
                    "coordinates",
                    qr_.rank(), n_));
  const int orientation = compute_orientation();
  if (orientation_ * orientation < 0)
    fail("has passed a dead point or left its branch since the last solution");
  orientation_ = orientation;

  // Rates, and the gradients in the coordinates: dp/dq = -J^+ dg/dq.
  for (Eigen::Index e = 0; e < m; ++e) right_[e] = -equations[static_cast<std::size_t>(e)].rate();
  solve_least_squares(right_, rate_);
  inverse_.resize(n_, m);
  for (Eigen::Index e = 0; e < m; ++e) {
    right_ = VectorXd::Unit(m, e);
    solve_least_squares(right_, inverse_.col(e));
  }
  for (int i = 0; i < n_; ++i) {
    Gradient sum;
    for (Eigen::Index e = 0; e < m; ++e) {
      if (inverse_(i, e) == 0) continue;
      sum =
          Gradient::combine(1, sum, -inverse_(i, e),
                            Gradient::without(equations[static_cast<std::size_t>(e)].gradient(), first_, n_));
    }
    gradients_[static_cast<std::size_t>(i)] = std::move(sum);
  }
  phase_ = Phase::rates;
  return false;
}

}  // namespace easydyn

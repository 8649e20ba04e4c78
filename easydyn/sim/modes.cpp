#include "easydyn/sim/modes.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <numbers>

#include "easydyn/error.hpp"
#include "easydyn/sim/balance.hpp"
#include "easydyn/sim/state_space.hpp"

namespace easydyn {

using Eigen::MatrixXd;
using Eigen::VectorXcd;

namespace {

constexpr double two_pi = 2 * std::numbers::pi;

Mode make_mode(std::complex<double> pole, VectorXcd shape) {
  const double w = std::abs(pole);
  if (shape.size() == 0) return {pole, w / two_pi, w > 0 ? -pole.real() / w : 0.0, shape};
  Eigen::Index largest = 0;
  shape.cwiseAbs().maxCoeff(&largest);
  // Eigenvectors have unit length: what is left of the coordinates in an electrical mode is rounding.
  if (std::abs(shape[largest]) > 1e-12) {
    shape /= shape[largest];
  } else {
    shape.setZero();
  }
  return {pole, w / two_pi, w > 0 ? -pole.real() / w : 0.0, std::move(shape)};
}

// One mode per pair of complex eigenvalues, one per real one; the first n entries are the coordinates.
std::vector<Mode> modes_of(MatrixXd A, Eigen::Index n) {
  const Eigen::VectorXd scales = balance(A);
  const Eigen::EigenSolver<MatrixXd> eigen(A);
  if (eigen.info() != Eigen::Success) throw SolverError("modes: the eigenvalue iteration did not converge");
  std::vector<Mode> modes;
  for (Eigen::Index i = 0; i < A.rows(); ++i)
    if (eigen.eigenvalues()[i].imag() >= 0) {
      const VectorXcd vector = (scales.asDiagonal() * eigen.eigenvectors().col(i)).normalized();
      modes.push_back(make_mode(eigen.eigenvalues()[i], vector.head(n)));
    }
  return modes;
}

void sort_by_frequency(std::vector<Mode>& modes) {
  std::stable_sort(modes.begin(), modes.end(),
                   [](const Mode& a, const Mode& b) { return a.frequency < b.frequency; });
}

}  // namespace

std::vector<Mode> compute_modes(const StateSpace& space) {
  std::vector<Mode> modes = modes_of(space.A, space.coordinates);
  sort_by_frequency(modes);
  return modes;
}

std::vector<Mode> compute_modes(const Linearization& lin) {
  const Eigen::Index n = lin.M.rows();
  std::vector<Mode> modes;
  const bool is_symmetric = (lin.K - lin.K.transpose()).norm() <= 1e-7 * lin.K.norm();

  // Below rounding of the differences, damping counts as none.
  const bool is_undamped = lin.C.norm() <= 1e-12 * std::sqrt(lin.K.norm() * lin.M.norm());

  if (is_undamped && is_symmetric) {
    const MatrixXd K = 0.5 * (lin.K + lin.K.transpose());
    const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> eigen(K, lin.M);
    if (eigen.info() != Eigen::Success) throw SolverError("modes: the mass matrix is not positive definite");
    for (Eigen::Index i = 0; i < n; ++i) {
      const std::complex<double> pole = std::sqrt(std::complex<double>(-eigen.eigenvalues()[i], 0));
      const VectorXcd shape = eigen.eigenvectors().col(i).cast<std::complex<double>>();
      modes.push_back(make_mode(pole, shape));
      if (pole.imag() == 0 && pole.real() > 0)
        modes.push_back(make_mode(-pole, shape));  // grows, and its mirror decays
    }
  } else {
    const Eigen::FullPivLU<MatrixXd> M(lin.M);
    if (!M.isInvertible()) throw SolverError("modes: the mass matrix is singular");
    MatrixXd A = MatrixXd::Zero(2 * n, 2 * n);
    A.topRightCorner(n, n).setIdentity();
    A.bottomLeftCorner(n, n) = -M.solve(lin.K);
    A.bottomRightCorner(n, n) = -M.solve(lin.C);
    modes = modes_of(A, n);
  }
  sort_by_frequency(modes);
  return modes;
}

}  // namespace easydyn

#include "easydyn/sim/modes.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <numbers>

#include "easydyn/error.hpp"

namespace easydyn {

using Eigen::MatrixXd;
using Eigen::VectorXcd;

namespace {

constexpr double two_pi = 2 * std::numbers::pi;

Mode make_mode(std::complex<double> pole, VectorXcd shape) {
  Eigen::Index largest = 0;
  shape.cwiseAbs().maxCoeff(&largest);
  shape /= shape[largest];
  const double w = std::abs(pole);
  return {pole, w / two_pi, w > 0 ? -pole.real() / w : 0.0, std::move(shape)};
}

}  // namespace

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
      modes.push_back(make_mode(pole, eigen.eigenvectors().col(i).cast<std::complex<double>>()));
    }
  } else {
    const Eigen::FullPivLU<MatrixXd> M(lin.M);
    if (!M.isInvertible()) throw SolverError("modes: the mass matrix is singular");
    MatrixXd A = MatrixXd::Zero(2 * n, 2 * n);
    A.topRightCorner(n, n).setIdentity();
    A.bottomLeftCorner(n, n) = -M.solve(lin.K);
    A.bottomRightCorner(n, n) = -M.solve(lin.C);
    const Eigen::EigenSolver<MatrixXd> eigen(A);
    if (eigen.info() != Eigen::Success) throw SolverError("modes: the eigenvalue iteration did not converge");
    for (Eigen::Index i = 0; i < 2 * n; ++i)
      if (eigen.eigenvalues()[i].imag() >= 0)
        modes.push_back(make_mode(eigen.eigenvalues()[i], eigen.eigenvectors().col(i).head(n)));
  }
  std::stable_sort(modes.begin(), modes.end(),
                   [](const Mode& a, const Mode& b) { return a.frequency < b.frequency; });
  return modes;
}

}  // namespace easydyn

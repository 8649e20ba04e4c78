#pragma once

#include <Eigen/Core>
#include <cmath>

/// How the results of two passages are compared.
namespace easydyn::track {

/// max |a - b| / max |b|.
inline double largest_relative_difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

/// Columns without what is above 200 Hz: convolution with a sinc under a Gaussian window (down by 1e-9 from 250 Hz on).
/// Rows are dt [s] apart; 0.26 s are lost at either end.
inline Eigen::MatrixXd below_200_hz(const Eigen::MatrixXd& columns, double dt) {
  const double pi = std::acos(-1.0), cut = 225, sigma = 6.2 / (2 * pi * 25);
  const int reach = static_cast<int>(std::ceil(6.5 * sigma / dt));
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(columns.rows() - 2 * reach, columns.cols());
  for (int k = -reach; k <= reach; ++k) {
    const double t = k * dt, sinc = k == 0 ? 2 * cut : std::sin(2 * pi * cut * t) / (pi * t);
    result +=
        dt * sinc * std::exp(-0.5 * t * t / (sigma * sigma)) * columns.middleRows(reach + k, result.rows());
  }
  return result;
}

}  // namespace easydyn::track

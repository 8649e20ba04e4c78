#include "soil/gll.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "easydyn/error.hpp"

namespace easydyn::soil {

namespace {

/// Legendre polynomials P_n and P_{n-1} at s, by the three-term recurrence.
std::pair<double, double> legendre(int n, double s) {
  double previous = 1, current = s;
  for (int k = 2; k <= n; ++k) {
    const double next = ((2 * k - 1) * s * current - (k - 1) * previous) / k;
    previous = current;
    current = next;
  }
  return n == 0 ? std::pair{1.0, 0.0} : std::pair{current, previous};
}

}  // namespace

GllRule::GllRule(int degree_)
    : degree(degree_), points(degree_ + 1), weights(degree_ + 1), derivative(degree_ + 1, degree_ + 1) {
  if (degree < 1 || degree > 12)
    throw ModelError(fmt::format("GLL rule: degree = {}, must be in 1..12", degree));
  const int N = degree;
  // Points: zeros of (1 - s^2) P_N'(s) = N (P_{N-1} - s P_N), by Newton from the Chebyshev-Lobatto points;
  // the derivative of P_{N-1} - s P_N is -(N + 1) P_N.
  for (int i = 0; i <= N; ++i) {
    double s = -std::cos(M_PI * i / N);
    if (i > 0 && i < N)
      for (int iteration = 0; iteration < 50; ++iteration) {
        const auto [P, Q] = legendre(N, s);
        const double step = (Q - s * P) / ((N + 1) * P);
        s += step;
        if (std::abs(step) < 1e-16) break;
      }
    const double P = legendre(N, s).first;
    points(i) = s;
    weights(i) = 2.0 / (N * (N + 1) * P * P);
  }
  points(0) = -1;
  points(N) = 1;
  for (int i = 0; i <= N; ++i)
    for (int j = 0; j <= N; ++j) {
      if (i != j)
        derivative(i, j) =
            legendre(N, points(i)).first / legendre(N, points(j)).first / (points(i) - points(j));
      else
        derivative(i, j) = i == 0 ? -N * (N + 1) / 4.0 : i == N ? N * (N + 1) / 4.0 : 0.0;
    }
}

Eigen::VectorXd GllRule::compute_shape(double s) const {
  Eigen::VectorXd values(degree + 1);
  for (int i = 0; i <= degree; ++i) {
    double product = 1;
    for (int j = 0; j <= degree; ++j)
      if (j != i) product *= (s - points(j)) / (points(i) - points(j));
    values(i) = product;
  }
  return values;
}

Eigen::VectorXd GllRule::integrate_shape(double a, double b) const {
  // The rule itself is exact to degree 2 N - 1 >= N on any interval.
  Eigen::VectorXd integral = Eigen::VectorXd::Zero(degree + 1);
  for (int q = 0; q <= degree; ++q) {
    const double s = 0.5 * (a + b) + 0.5 * (b - a) * points(q);
    integral += 0.5 * (b - a) * weights(q) * compute_shape(s);
  }
  return integral;
}

Eigen::MatrixXd GllRule::compute_stiffness() const {
  return derivative.transpose() * weights.asDiagonal() * derivative;
}

Eigen::MatrixXd GllRule::compute_antisymmetric_gradient() const {
  const Eigen::MatrixXd G = weights.asDiagonal() * derivative;
  return 0.5 * (G - G.transpose());
}

}  // namespace easydyn::soil

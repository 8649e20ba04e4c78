#include "easydyn/sim/state_space.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <numbers>
#include <utility>

#include "easydyn/error.hpp"
#include "easydyn/sim/accelerations.hpp"
#include "easydyn/sim/balance.hpp"
#include "easydyn/sim/difference.hpp"

namespace easydyn {

using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

StateSpace linearize_state_space(System& system, const State& state, double difference) {
  if (!(difference > 0))
    throw ModelError(fmt::format("linearization: difference = {}, must be > 0", difference));
  const int n = system.size(), nx = system.first_order_size(), nu = system.input_size(),
            nz = system.output_size(), ny = 2 * n + nx;
  AccelerationSolver solver(system);
  State shifted = state;
  // Rates of y, with the outputs below.
  const auto rates = [&]() -> VectorXd {
    solver.solve(shifted);
    VectorXd y(ny + nz);
    y.head(ny) << shifted.qd, shifted.qdd, shifted.xd;
    if (nz > 0) system.evaluate(std::as_const(shifted));
    for (int i = 0; i < nz; ++i) y[ny + i] = system.output_value(i);
    return y;
  };
  const auto by = [&](double& x, double origin, double scale = 1) {
    return central_difference(
        [&](double d) {
          x = origin + d;
          return rates();
        },
        difference * scale);
  };
  MatrixXd by_y(ny + nz, ny), by_u(ny + nz, nu);
  for (int i = 0; i < n; ++i) {
    by_y.col(i) = by(shifted.q[i], state.q[i]);
    by_y.col(n + i) = by(shifted.qd[i], state.qd[i]);
  }
  for (int i = 0; i < nx; ++i)
    by_y.col(2 * n + i) = by(shifted.x[i], state.x[i], std::max(1.0, std::abs(state.x[i])));
  for (int i = 0; i < nu; ++i) {
    const KeptInput input(system, i);
    by_u.col(i) = central_difference(
        [&](double d) {
          system.set_input(i, input.value() + d);
          return rates();
        },
        difference * std::max(1.0, std::abs(input.value())));
  }
  StateSpace space;
  space.A = by_y.topRows(ny);
  space.B = by_u.topRows(ny);
  space.C = by_y.bottomRows(nz);
  space.D = by_u.bottomRows(nz);
  space.coordinates = n;
  return space;
}

std::vector<MatrixXcd> compute_frequency_response(const StateSpace& space, const VectorXd& frequencies) {
  std::vector<MatrixXcd> responses;
  const Eigen::Index size = space.A.rows();
  // Rows and columns of like norms: the rank is then decided whatever the units of the states.
  MatrixXd A = space.A;
  const VectorXd scales = balance(A);
  const MatrixXcd B = (scales.cwiseInverse().asDiagonal() * space.B).cast<std::complex<double>>();
  for (const double f : frequencies) {
    if (!(f >= 0)) throw ModelError(fmt::format("frequency response: frequency = {} Hz, must be >= 0", f));
    const std::complex<double> iw(0, 2 * std::numbers::pi * f);
    const MatrixXcd G = iw * MatrixXcd::Identity(size, size) - A;
    const Eigen::FullPivLU<MatrixXcd> lu(G);
    if (!lu.isInvertible())
      throw SolverError(fmt::format("frequency response: {} Hz is the frequency of an undamped mode", f));
    responses.push_back(scales.asDiagonal() * lu.solve(B));
  }
  return responses;
}

}  // namespace easydyn

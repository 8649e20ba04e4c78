#include "easydyn/sim/linearization.hpp"

#include <fmt/format.h>

#include "easydyn/error.hpp"

namespace easydyn {

using Eigen::MatrixXd;
using Eigen::VectorXd;

Linearization linearize(System& system, const State& state, double difference) {
  if (!(difference > 0))
    throw ModelError(fmt::format("linearization: difference = {}, must be > 0", difference));
  const int n = system.size();
  Linearization lin{system.compute_mass_matrix(state), MatrixXd(n, n), MatrixXd(n, n)};

  // Column i: (r(-2d) - 8 r(-d) + 8 r(d) - r(2d)) / 12 d.
  const auto column = [&](VectorXd State::*x, int i) -> VectorXd {
    State shifted = state;
    const auto r = [&](double d) -> VectorXd {
      (shifted.*x)[i] = (state.*x)[i] + d;
      return system.compute_residual(shifted);
    };
    return (r(-2 * difference) - 8 * r(-difference) + 8 * r(difference) - r(2 * difference)) /
           (12 * difference);
  };
  for (int i = 0; i < n; ++i) {
    lin.K.col(i) = column(&State::q, i);
    lin.C.col(i) = column(&State::qd, i);
  }
  return lin;
}

}  // namespace easydyn

#include "easydyn/sim/linearization.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "easydyn/error.hpp"
#include "easydyn/sim/difference.hpp"

namespace easydyn {

using Eigen::MatrixXd;

Linearization linearize(System& system, const State& state, double difference) {
  if (!(difference > 0))
    throw ModelError(fmt::format("linearization: difference = {}, must be > 0", difference));
  if (system.constraint_size() > 0)
    throw ModelError(fmt::format(
        "linearization: system \"{}\" has velocity constraints, which M, C and K cannot hold: use "
        "linearize_state_space",
        system.name()));
  const int n = system.size();
  Linearization lin{system.compute_mass_matrix(state), MatrixXd(n, n), MatrixXd(n, n)};

  State shifted = state;
  const auto by = [&](double& x, double origin, double step) {
    return central_difference(
        [&](double d) {
          x = origin + d;
          return system.compute_residual(shifted);
        },
        step);
  };
  for (int i = 0; i < n; ++i) {
    lin.K.col(i) = by(shifted.q[i], state.q[i], difference);
    lin.C.col(i) = by(shifted.qd[i], state.qd[i], difference);
  }
  lin.B.resize(n, system.input_size());
  for (int i = 0; i < system.input_size(); ++i) {
    const KeptInput input(system, i);
    lin.B.col(i) = -central_difference(
        [&](double d) {
          system.set_input(i, input.value() + d);
          return system.compute_residual(state);
        },
        difference * std::max(1.0, std::abs(input.value())));
  }
  return lin;
}

}  // namespace easydyn

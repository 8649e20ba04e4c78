#include "easydyn/sim/linearization.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "easydyn/error.hpp"

namespace easydyn {

using Eigen::MatrixXd;
using Eigen::VectorXd;

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
  // (r(-2d) - 8 r(-d) + 8 r(d) - r(2d)) / 12 d
  const auto derivative = [&](auto set, double step) -> VectorXd {
    const auto r = [&](double d) -> VectorXd {
      set(d);
      return system.compute_residual(shifted);
    };
    const VectorXd sum = r(-2 * step) - 8 * r(-step) + 8 * r(step) - r(2 * step);
    set(0.0);
    return sum / (12 * step);
  };
  for (int i = 0; i < n; ++i) {
    lin.K.col(i) = derivative([&](double d) { shifted.q[i] = state.q[i] + d; }, difference);
    lin.C.col(i) = derivative([&](double d) { shifted.qd[i] = state.qd[i] + d; }, difference);
  }
  lin.B.resize(n, system.input_size());
  for (int i = 0; i < system.input_size(); ++i) {
    const double value = system.input_value(i);
    lin.B.col(i) = -derivative([&](double d) { system.set_input(i, value + d); },
                               difference * std::max(1.0, std::abs(value)));
  }
  return lin;
}

}  // namespace easydyn

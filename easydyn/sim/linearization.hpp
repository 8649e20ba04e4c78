#pragma once

#include <Eigen/Core>

#include "easydyn/mbs/system.hpp"

namespace easydyn {

/// Small motions x about a state: M x.. + C x. + K x = B u; M, C, K n x n, M symmetric, C and K need not be; B n x
/// inputs, forces per unit of the system's inputs u.
struct Linearization {
  Eigen::MatrixXd M, C, K;
  Eigen::MatrixXd B = {};
};

/// Of the coordinates alone: first-order states are constant here (state_space.hpp has them). M exactly; C = dr/dqd,
/// K = dr/dq and B = -dr/du by fourth-order central differences of the residual.
/// @throws ModelError where there are velocity constraints
/// @param difference  step in q and qd [m, rad, m/s, rad/s]; in u, times its own size where it is above 1
Linearization linearize(System& system, const State& state, double difference = 1e-4);

}  // namespace easydyn

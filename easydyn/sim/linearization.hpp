#pragma once

#include <Eigen/Core>

#include "easydyn/mbs/system.hpp"

namespace easydyn {

/// Small motions x about a state: M x.. + C x. + K x = 0, n x n each; M is symmetric, C and K need not be.
struct Linearization {
  Eigen::MatrixXd M, C, K;
};

/// Of the coordinates alone: first-order states and inputs are constant here (state_space.hpp has them). M exactly; C = dr/dqd and K = dr/dq by fourth-order central differences of the residual.
/// @param difference  step in q and qd [m, rad, m/s, rad/s]
Linearization linearize(System& system, const State& state, double difference = 1e-4);

}  // namespace easydyn

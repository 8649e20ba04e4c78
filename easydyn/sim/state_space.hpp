#pragma once

#include <Eigen/Core>
#include <vector>

#include "easydyn/mbs/system.hpp"

namespace easydyn {

/// Small motions about a state in first-order form: y. = A y + B u with y = (q, qd, x) and the inputs u, each as a
/// deviation. Where velocity constraints act, motions along them only.
struct StateSpace {
  Eigen::MatrixXd A, B;
  int coordinates = 0;  ///< n: entries of q, then as many of qd, then x
};

/// A and B by fourth-order central differences of the accelerations and rates.
/// @param difference  step in q, qd, x and u
StateSpace linearize_state_space(System& system, const State& state, double difference = 1e-4);

/// Response to u = Re(U exp(i w t)): y = Re(H U exp(i w t)), H(w) = (i w - A)^-1 B, one matrix per frequency.
/// @param frequencies  [Hz], >= 0
/// @throws SolverError if a frequency is that of an undamped mode
std::vector<Eigen::MatrixXcd> compute_frequency_response(const StateSpace& space,
                                                         const Eigen::VectorXd& frequencies);

}  // namespace easydyn

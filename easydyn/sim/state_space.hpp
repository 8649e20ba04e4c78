#pragma once

#include <Eigen/Core>
#include <vector>

#include "easydyn/mbs/system.hpp"

namespace easydyn {

/// Small motions about a state in first-order form:
///
///   y. = A y + B u        z = C y + D u
///
/// with y = (q, qd, x), the inputs u and the outputs z of the system, each as a deviation. Where velocity constraints
/// act, motions along them only.
struct StateSpace {
  Eigen::MatrixXd A, B, C, D;
  int coordinates = 0;  ///< n: entries of q, then as many of qd, then x
};

/// A, B, C and D by fourth-order central differences of the accelerations, rates and outputs.
/// @param difference  step in q, qd, x and u
StateSpace linearize_state_space(System& system, const State& state, double difference = 1e-4);

/// Response to u = Re(U exp(i w t)): y = Re(H U exp(i w t)), H(w) = (i w - A)^-1 B, one matrix per frequency.
/// Of the outputs: C H + D.
/// @param frequencies  [Hz], >= 0
/// @throws SolverError if a frequency is that of an undamped mode
std::vector<Eigen::MatrixXcd> compute_frequency_response(const StateSpace& space,
                                                         const Eigen::VectorXd& frequencies);

}  // namespace easydyn

#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <vector>

#include "easydyn/mbs/system.hpp"
#include "easydyn/sim/banded_cholesky.hpp"

namespace easydyn {

/// Accelerations, constraint forces and rates of first-order states that satisfy the equations of motion at given
/// t, q, qd and x:
///
///   [ M  -A^T ] [ qdd    ]   [ -(h - Q)          ]
///   [ A   0   ] [ lambda ] = [ -phi. (qdd = 0)   ]      x. = f
///
/// Structures: M_s qdd_s = N^T F - C qd - K q with their mass matrices factorised once.
class AccelerationSolver {
 public:
  explicit AccelerationSolver(System& system);

  /// Sets state.qdd, state.lambda and state.xd.
  /// @throws SolverError if the mass matrix is singular or constraints contradict each other or repeat
  void solve(State& state);
  /// Takes the component of qd that violates the velocity constraints out of it, with the mass matrix as measure:
  /// qd - M^-1 A^T (A M^-1 A^T)^-1 phi.
  void project_velocities(State& state);

 private:
  void assemble(const State& state);
  [[noreturn]] void throw_singular(const State& state) const;

  System& system_;
  std::vector<BandedCholesky> masses_;  // of the structures
  Eigen::MatrixXd M_, KKT_;
  Eigen::VectorXd bias_, right_;
};

/// Sets state.qdd (and lambda, xd) so that the equations of motion hold.
/// @throws SolverError if the mass matrix is singular
void set_consistent_accelerations(System& system, State& state);

}  // namespace easydyn

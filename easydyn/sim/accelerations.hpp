#pragma once

#include <Eigen/Core>
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
/// By Cholesky factors M = L L^T and, with Y = L^-1 A^T, A M^-1 A^T = Y^T Y, in place: nothing is allocated after the
/// first evaluation. A pivot that is 1e-14 of its diagonal entry, what rounding leaves, counts as zero.
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
  void factorise(const State& state);
  void solve_constraints();
  [[noreturn]] void throw_singular(const State& state);

  System& system_;
  std::vector<BandedCholesky> masses_;  // of the structures
  std::vector<RightHandSides> sides_;   // of theirs
  Eigen::MatrixXd M_;                   // then L
  Eigen::MatrixXd Y_, S_;               // Y; Y^T Y, then its factor
  Eigen::VectorXd bias_, diagonal_, lambda_;
};

/// Sets state.qdd (and lambda, xd) so that the equations of motion hold.
/// @throws SolverError as AccelerationSolver, or if an acceleration is not finite, naming the coordinates that are not
void set_consistent_accelerations(System& system, State& state);

}  // namespace easydyn

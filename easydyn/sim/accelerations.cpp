#include "easydyn/sim/accelerations.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>

#include "easydyn/error.hpp"

namespace easydyn {

using Eigen::MatrixXd;
using Eigen::VectorXd;

AccelerationSolver::AccelerationSolver(System& system) : system_(system) {
  for (const auto& s : system.structures()) masses_.emplace_back(s->M(), s->half_bandwidth(), s->name());
}

void AccelerationSolver::throw_singular(const State& state) const {
  const int n = system_.body_size();
  const Eigen::FullPivLU<MatrixXd> lu(M_);
  if (lu.rank() < n) {
    Eigen::Index worst = 0;
    lu.kernel().col(0).cwiseAbs().maxCoeff(&worst);
    throw SolverError(
        fmt::format("system \"{}\": the mass matrix is singular at t = {} s (rank {} of {}); does coordinate "
                    "\"{}\" move a mass?",
                    system_.name(), state.t, lu.rank(), n, system_.coordinate_name(static_cast<int>(worst))));
  }
  throw SolverError(fmt::format(
      "system \"{}\": its {} velocity constraints are not independent at t = {} s; leave out those that "
      "follow from the others",
      system_.name(), system_.constraint_size(), state.t));
}

// Rows of the constraints below and beside the mass matrix.
void AccelerationSolver::assemble(const State& state) {
  const int n = system_.body_size(), nc = system_.constraint_size();
  M_.resize(n, n);
  bias_.resize(n);
  system_.compute_mass_and_bias(state, M_, bias_);
  KKT_.setZero(n + nc, n + nc);
  KKT_.topLeftCorner(n, n) = M_;
  int row = n;
  for (const VelocityConstraint& c : system_.velocity_constraints()) {
    for (const Gradient::Entry& a : c.row()) {
      if (a.coordinate >= n) continue;  // held
      KKT_(row, a.coordinate) += a.value;
      KKT_(a.coordinate, row) -= a.value;
    }
    ++row;
  }
}

void AccelerationSolver::solve(State& state) {
  const int n = system_.body_size(), nc = system_.constraint_size();
  if (nc == 0) {
    M_.resize(n, n);
    bias_.resize(n);
    system_.compute_mass_and_bias(state, M_, bias_);
    const Eigen::LLT<Eigen::Ref<MatrixXd>> cholesky(M_);  // in place
    if (n > 0 && (cholesky.info() != Eigen::Success || cholesky.rcond() < 1e-15)) {
      system_.compute_mass_and_bias(state, M_, bias_);
      throw_singular(state);
    }
    state.qdd.head(n) = -bias_;
    if (n > 0) cholesky.solveInPlace(state.qdd.head(n));
  } else {
    assemble(state);
    right_.resize(n + nc);
    right_.head(n) = -bias_;
    int row = n;
    for (const VelocityConstraint& c : system_.velocity_constraints()) right_[row++] = -c.bias();
    const Eigen::FullPivLU<MatrixXd> lu(KKT_);
    if (!lu.isInvertible()) throw_singular(state);
    right_ = lu.solve(right_);
    state.qdd.head(n) = right_.head(n);
    state.lambda = right_.tail(nc);
  }
  state.xd = system_.first_order_rates();

  if (masses_.empty()) return;
  // The ports of this evaluation hold the forces on the structures.
  for (int k = 0; k < static_cast<int>(masses_.size()); ++k) {
    const LinearStructure& s = *system_.structures()[static_cast<std::size_t>(k)];
    const int at = system_.structure_offset(k);
    RightHandSides y = -(s.C() * state.qd.segment(at, s.size()) + s.K() * state.q.segment(at, s.size()));
    for (const System::PortRecord& p : system_.ports()) {
      if (p.structure != k) continue;
      for (std::size_t i = 0; i < static_cast<std::size_t>(p.shape.count); ++i)
        y(p.shape.index[i], 0) += p.shape.value[i] * p.force;
    }
    masses_[static_cast<std::size_t>(k)].solve_in_place(y);
    state.qdd.segment(at, s.size()) = y.col(0);
  }
}

void AccelerationSolver::project_velocities(State& state) {
  const int n = system_.body_size(), nc = system_.constraint_size();
  if (nc == 0) return;
  assemble(state);
  right_.setZero(n + nc);
  int row = n;
  for (const VelocityConstraint& c : system_.velocity_constraints()) right_[row++] = -c.velocity();
  const Eigen::FullPivLU<MatrixXd> lu(KKT_);
  if (!lu.isInvertible()) throw_singular(state);
  state.qd.head(n) += lu.solve(right_).head(n);
}

void set_consistent_accelerations(System& system, State& state) {
  AccelerationSolver(system).solve(state);
}

}  // namespace easydyn

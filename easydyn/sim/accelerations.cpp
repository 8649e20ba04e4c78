#include "easydyn/sim/accelerations.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "easydyn/error.hpp"

namespace easydyn {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// A = L L^T in place, by its lower triangle. False if a pivot is zero but for rounding. (Not a number passes: it is for
// the integrator to see.)
bool factorise_in_place(MatrixXd& A, VectorXd& diagonal) {
  constexpr double rounding = 1e-14;  // some ten roundings of the diagonal entry
  const Eigen::Index n = A.rows();
  if (diagonal.size() < n) diagonal.resize(n);
  diagonal.head(n) = A.diagonal();
  const Eigen::LLT<Eigen::Ref<MatrixXd>> cholesky(A);
  return cholesky.info() == Eigen::Success &&
         !(A.diagonal().array().square() <= rounding * diagonal.head(n).array()).any();
}

}  // namespace

AccelerationSolver::AccelerationSolver(System& system) : system_(system) {
  for (const auto& s : system.structures()) masses_.emplace_back(s->M(), s->half_bandwidth(), s->name());
  sides_.resize(masses_.size());
}

void AccelerationSolver::throw_singular(const State& state) {
  const int n = system_.body_size();
  system_.compute_mass_and_bias(state, M_, bias_);
  Eigen::FullPivLU<MatrixXd> lu(M_);
  if (lu.rank() == n)  // singular in the measure of its own diagonal: the smallest pivot counts as zero
    lu.setThreshold(1.01 * lu.matrixLU().diagonal().cwiseAbs().minCoeff() / lu.maxPivot());
  Eigen::Index worst = 0;
  lu.kernel().col(0).cwiseAbs().maxCoeff(&worst);
  throw SolverError(
      fmt::format("system \"{}\": the mass matrix is singular at t = {} s (rank {} of {}); does coordinate "
                  "\"{}\" move a mass?",
                  system_.name(), state.t, lu.rank(), n, system_.coordinate_name(static_cast<int>(worst))));
}

// M_ becomes L; Y_ and S_ follow from the constraints.
void AccelerationSolver::factorise(const State& state) {
  const int n = system_.body_size(), nc = system_.constraint_size();
  M_.resize(n, n);
  bias_.resize(n);
  system_.compute_mass_and_bias(state, M_, bias_);
  if (n > 0 && !factorise_in_place(M_, diagonal_)) throw_singular(state);
  if (nc == 0) return;

  Y_.setZero(n, nc);
  int column = 0;
  for (const VelocityConstraint& c : system_.velocity_constraints()) {
    for (const Gradient::Entry& a : c.row())
      if (a.coordinate < n) Y_(a.coordinate, column) += a.value;  // others are held
    ++column;
  }
  for (int i = 0; i < nc; ++i) {  // one by one: together they would take memory for a copy
    auto y = Y_.col(i);
    M_.triangularView<Eigen::Lower>().solveInPlace(y);
  }
  S_.resize(nc, nc);
  S_.noalias() = Y_.transpose().lazyProduct(Y_);
  if (!factorise_in_place(S_, diagonal_))
    throw SolverError(fmt::format(
        "system \"{}\": its {} velocity constraints are not independent at t = {} s; leave out those that "
        "follow from the others",
        system_.name(), nc, state.t));
}

// lambda_ = (A M^-1 A^T)^-1 lambda_.
void AccelerationSolver::solve_constraints() {
  S_.triangularView<Eigen::Lower>().solveInPlace(lambda_);
  S_.triangularView<Eigen::Lower>().adjoint().solveInPlace(lambda_);
}

void AccelerationSolver::solve(State& state) {
  const int n = system_.body_size(), nc = system_.constraint_size();
  factorise(state);
  // With w = L^-1 bias: Y^T Y lambda = Y^T w - phi.(qdd = 0),  qdd = L^-T (Y lambda - w).
  const auto L = M_.triangularView<Eigen::Lower>();
  if (n > 0) L.solveInPlace(bias_);
  if (nc > 0) {
    lambda_.resize(nc);
    lambda_.noalias() = Y_.transpose().lazyProduct(bias_);
    int row = 0;
    for (const VelocityConstraint& c : system_.velocity_constraints()) lambda_[row++] -= c.bias();
    solve_constraints();
    bias_.noalias() -= Y_.lazyProduct(lambda_);
    state.lambda = lambda_;
  }
  if (n > 0) L.adjoint().solveInPlace(bias_);
  state.qdd.head(n) = -bias_;
  state.xd = system_.first_order_rates();

  // The ports of this evaluation hold the forces on the structures.
  for (int k = 0; k < static_cast<int>(masses_.size()); ++k) {
    const LinearStructure& s = *system_.structures()[static_cast<std::size_t>(k)];
    const int at = system_.structure_offset(k);
    RightHandSides& y = sides_[static_cast<std::size_t>(k)];
    y.setZero(s.size(), 1);
    auto force = state.qdd.segment(at, s.size());  // until it becomes the acceleration
    force.setZero();
    force.noalias() -= s.C() * state.qd.segment(at, s.size());
    force.noalias() -= s.K() * state.q.segment(at, s.size());
    for (const System::PortRecord& p : system_.ports()) {
      if (p.structure != k) continue;
      for (std::size_t i = 0; i < static_cast<std::size_t>(p.shape.count); ++i)
        force[p.shape.index[i]] += p.shape.value[i] * p.force;
    }
    y.col(0) = force;
    masses_[static_cast<std::size_t>(k)].solve_in_place(y);
    force = y.col(0);
  }
}

void AccelerationSolver::project_velocities(State& state) {
  const int n = system_.body_size(), nc = system_.constraint_size();
  if (nc == 0) return;
  factorise(state);
  lambda_.resize(nc);
  int row = 0;
  for (const VelocityConstraint& c : system_.velocity_constraints()) lambda_[row++] = -c.velocity();
  solve_constraints();
  bias_.noalias() = Y_.lazyProduct(lambda_);
  M_.triangularView<Eigen::Lower>().adjoint().solveInPlace(bias_);
  state.qd.head(n) += bias_;
}

void set_consistent_accelerations(System& system, State& state) {
  AccelerationSolver(system).solve(state);
  if (state.qdd.allFinite()) return;
  std::string names;
  for (int i = 0; i < system.size(); ++i)
    if (!std::isfinite(state.q[i]) || !std::isfinite(state.qd[i]))
      names +=
          fmt::format(" \"{}\" (q = {:g}, qd = {:g})", system.coordinate_name(i), state.q[i], state.qd[i]);
  throw SolverError(fmt::format("system \"{}\": accelerations are not finite at t = {:g} s{}", system.name(),
                                state.t, names.empty() ? "; a force or a position is not" : ", nor" + names));
}

}  // namespace easydyn

#include "easydyn/sim/newmark.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "easydyn/error.hpp"
#include "easydyn/sim/condensation.hpp"

namespace easydyn {

using Eigen::VectorXd;

namespace {
constexpr double beta = 0.25, gamma_ = 0.5;

// Magnitudes below which an unknown counts as zero: 1e-3 m/s^2 or rad/s^2, 1 N.
constexpr double acceleration_floor = 1e-3, force_floor = 1.0;

State consistent_initial_state(System& system) {
  State state = system.initial_state();
  set_consistent_accelerations(system, state);
  return state;
}
}  // namespace

void set_consistent_accelerations(System& system, State& state) {
  const VectorXd bias = system.compute_bias(state);
  const int n = system.body_size();
  state.qdd.setZero();
  if (n > 0) {
    Eigen::MatrixXd M(n, n);
    VectorXd body_bias(n);
    system.compute_mass_and_bias(state, M, body_bias);
    const Eigen::FullPivLU<Eigen::MatrixXd> lu(M);
    if (!lu.isInvertible())
      throw SolverError(
          fmt::format("system \"{}\": the mass matrix is singular at t = {} s (rank {} of {}); "
                      "does every coordinate move a mass?",
                      system.name(), state.t, lu.rank(), n));
    state.qdd.head(n) = lu.solve(-bias.head(n));
  }
  for (int k = 0; k < static_cast<int>(system.structures().size()); ++k) {
    const LinearStructure& s = *system.structures()[static_cast<std::size_t>(k)];
    RightHandSides x = -bias.segment(system.structure_offset(k), s.size());
    BandedCholesky(s.M(), s.half_bandwidth(), s.name()).solve_in_place(x);
    state.qdd.segment(system.structure_offset(k), s.size()) = x.col(0);
  }
}

Newmark::Newmark(System& system, const NewmarkOptions& options)
    : Newmark(system, consistent_initial_state(system), options) {}

Newmark::Newmark(System& system, State state, const NewmarkOptions& options)
    : system_(system),
      state_(std::move(state)),
      options_(options),
      n_bodies_(system.body_size()),
      h_(options.step) {
  const auto require_positive = [](double value, const char* name) {
    if (!(value > 0)) throw ModelError(fmt::format("Newmark: {} = {}, must be > 0", name, value));
  };
  require_positive(options.step, "step [s]");
  require_positive(options.tolerance, "tolerance");
  require_positive(options.min_step, "min_step [s]");
  require_positive(options.max_step, "max_step [s]");
  require_positive(options.newton_tolerance, "newton_tolerance");

  // The first evaluation tells how many ports there are, and their forces.
  system_.evaluate(state_);
  port_forces_.resize(static_cast<int>(system_.ports().size()));
  for (int p = 0; p < port_forces_.size(); ++p)
    port_forces_[p] = system_.ports()[static_cast<std::size_t>(p)].force;
  floors_.resize(n_bodies_ + port_forces_.size());
  floors_.head(n_bodies_).setConstant(acceleration_floor);
  floors_.tail(port_forces_.size()).setConstant(force_floor);
  scale_ = floors_;
  scale_.head(n_bodies_) = scale_.head(n_bodies_).cwiseMax(state_.qdd.head(n_bodies_).cwiseAbs());
  scale_.tail(port_forces_.size()) = scale_.tail(port_forces_.size()).cwiseMax(port_forces_.cwiseAbs());
}

Newmark::~Newmark() = default;

void Newmark::prepare(double h) {
  if (h == prepared_step_) return;
  condensation_ = std::make_unique<Condensation>(system_, 1.0, gamma_ * h, beta * h * h);
  statistics_.factorisations += static_cast<long>(system_.structures().size());
  jacobian_known_ = false;
  prepared_step_ = h;
}

void Newmark::set_unknowns(const VectorXd& z, State& next) {
  const double h = prepared_step_;
  const int n = n_bodies_;
  next.qdd.head(n) = z.head(n);
  next.q.head(n) = q_star_.head(n) + beta * h * h * z.head(n);
  next.qd.head(n) = qd_star_.head(n) + gamma_ * h * z.head(n);
}

void Newmark::evaluate(const VectorXd& z, State& next, VectorXd& residual) {
  const VectorXd forces = z.tail(port_forces_.size());
  set_unknowns(z, next);
  system_.compute_body_residual(
      next.t, next.q.data(), next.qd.data(), next.qdd.data(),
      [&](int k, const PortShape& shape) { return condensation_->motion(k, shape, forces); },
      residual.data());
  ++statistics_.evaluations;
  if (static_cast<int>(system_.ports().size()) != forces.size())
    throw ModelError(
        fmt::format("system \"{}\": forces() touched {} ports, {} before; touch the same ports in the "
                    "same order at each evaluation",
                    system_.name(), system_.ports().size(), forces.size()));
  for (int p = 0; p < forces.size(); ++p)
    residual[n_bodies_ + p] = forces[p] - system_.ports()[static_cast<std::size_t>(p)].force;
}

void Newmark::compute_jacobian(const VectorXd& z, State& next, const VectorXd& residual) {
  const int n = static_cast<int>(z.size());
  Eigen::MatrixXd J(n, n);
  VectorXd shifted = z, r(n);
  for (int i = 0; i < n; ++i) {
    const double delta = 1e-4 * scale_[i];
    shifted[i] = z[i] + delta;
    evaluate(shifted, next, r);
    J.col(i) = (r - residual) / (shifted[i] - z[i]);
    shifted[i] = z[i];
  }
  jacobian_.compute(J);
  jacobian_known_ = true;
  ++statistics_.jacobians;
}

bool Newmark::try_step(double h, State& next) {
  prepare(h);
  const int n = n_bodies_, n_ports = static_cast<int>(port_forces_.size());
  const int n_structures = static_cast<int>(state_.q.size()) - n;

  // What is known of the new state before its accelerations.
  next.t = state_.t + h;
  q_star_ = state_.q + h * state_.qd + (0.5 - beta) * h * h * state_.qdd;
  qd_star_ = state_.qd + (1 - gamma_) * h * state_.qdd;
  next.q = q_star_ + beta * h * h * state_.qdd;
  next.qd = qd_star_ + gamma_ * h * state_.qdd;
  next.qdd = state_.qdd;
  VectorXd z(n + n_ports), residual(n + n_ports);
  z << state_.qdd.head(n), port_forces_;

  VectorXd b(n_structures);
  if (n_structures > 0) {
    // Where are the structures touched at the new time? Then their free motion and port compliances.
    system_.evaluate(next);
    int at = 0;
    for (const auto& s : system_.structures()) {
      b.segment(at, s->size()).noalias() = -(s->C() * qd_star_.segment(n + at, s->size()));
      b.segment(at, s->size()).noalias() -= s->K() * q_star_.segment(n + at, s->size());
      at += s->size();
    }
    condensation_->solve(b, system_.ports());
    condensation_->set_bases(q_star_.tail(n_structures), beta * h * h, qd_star_.tail(n_structures),
                             gamma_ * h);
  }

  // Newton on accelerations and port forces.
  double previous = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < options_.max_iterations; ++iteration) {
    evaluate(z, next, residual);
    last_residual_ = residual.lpNorm<Eigen::Infinity>();
    if (!residual.allFinite()) return false;
    if (!jacobian_known_) {
      const VectorXd residual_here = residual;
      compute_jacobian(z, next, residual_here);
    }
    const VectorXd correction = jacobian_.solve(residual);
    z -= correction;
    const double size = correction.cwiseAbs().cwiseQuotient(scale_).maxCoeff();
    if (!std::isfinite(size)) return false;
    const bool stalled_at_roundoff =
        size < 1e-3 * std::sqrt(options_.newton_tolerance) && size >= 0.5 * previous;
    if (size <= options_.newton_tolerance || stalled_at_roundoff) {
      // A port whose place depends on the coordinates has moved: condense there and go on.
      if (n_structures > 0 && condensation_->ports_moved(system_.ports())) {
        condensation_->solve(b, system_.ports());
        previous = std::numeric_limits<double>::infinity();
        continue;
      }
      set_unknowns(z, next);
      next_scale_ = floors_.cwiseMax(0.9 * scale_).cwiseMax(z.cwiseAbs());
      port_forces_ = z.tail(n_ports);
      if (n_structures > 0) {
        y_.resize(n_structures);
        condensation_->compute_response(port_forces_, y_);
        next.qdd.tail(n_structures) = y_;
        next.q.tail(n_structures) = q_star_.tail(n_structures) + beta * h * h * y_;
        next.qd.tail(n_structures) = qd_star_.tail(n_structures) + gamma_ * h * y_;
      }
      return true;
    }
    if (size > 0.1 * previous) jacobian_known_ = false;  // converging slowly: renew
    previous = size;
  }
  return false;
}

double Newmark::local_error(const State& next, double h) const {
  if (next.qdd.size() == 0) return 0;
  return std::abs(beta - 1.0 / 6) * h * h * (next.qdd - state_.qdd).lpNorm<Eigen::Infinity>() /
         options_.tolerance;
}

void Newmark::step() {
  State next;
  for (;;) {
    const VectorXd forces_before = port_forces_;
    const bool converged = try_step(h_, next);
    if (!options_.variable_step) {
      if (!converged)
        throw SolverError(
            std::isfinite(last_residual_)
                ? fmt::format("Newmark: no convergence at t = {} s with step {} s after {} iterations, "
                              "residual {:.3g}; "
                              "try a smaller step",
                              state_.t, h_, options_.max_iterations, last_residual_)
                : fmt::format(
                      "Newmark: the residual is not a finite number at t = {} s with step {} s; does a force "
                      "divide by zero or take a root of a negative number?",
                      state_.t, h_));
      break;
    }

    // Accept or refuse, and choose the next step.
    const double error = converged ? local_error(next, h_) : 8;
    const double factor = std::clamp(0.9 / std::cbrt(std::max(error, 1e-9)), 0.25, 2.0);
    if (converged && error <= 1) {
      // Small changes are not worth a new factorisation.
      if (factor > 1.3 || factor < 0.9) h_ = std::min(h_ * factor, options_.max_step);
      accept(next);
      return;
    }
    ++statistics_.rejected;
    port_forces_ = forces_before;
    h_ *= std::min(factor, 0.5);
    if (h_ < options_.min_step)
      throw SolverError(
          fmt::format("Newmark: the step fell below {} s at t = {} s (local error {:.3g} of the "
                      "tolerance, residual {:.3g}); is there an impact, or is the tolerance too tight?",
                      options_.min_step, state_.t, error, last_residual_));
  }
  accept(next);
}

void Newmark::accept(State& next) {
  state_ = std::move(next);
  scale_ = next_scale_;
  ++statistics_.steps;
}

void Newmark::advance(double t_end, const std::function<void(const State&)>& after_each_step) {
  while (t_end - state_.t > 1e-6 * h_) {
    const double regular = h_;
    // A rest within a millionth of a step is the same step.
    const bool shortened = state_.t + h_ > t_end + 1e-6 * h_;
    if (shortened) h_ = t_end - state_.t;
    step();
    if (shortened) h_ = regular;
    if (after_each_step) after_each_step(state_);
  }
}

}  // namespace easydyn

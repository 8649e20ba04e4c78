#include "easydyn/sim/implicit_stepper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "easydyn/error.hpp"
#include "easydyn/sim/condensation.hpp"

namespace easydyn {

using Eigen::VectorXd;

namespace {
// Magnitudes below which an unknown counts as zero: 1e-3 m/s^2 or rad/s^2, 1 N.
constexpr double acceleration_floor = 1e-3, force_floor = 1.0;

}  // namespace

State ImplicitStepper::consistent_initial_state(System& system) {
  State state = system.initial_state();
  set_consistent_accelerations(system, state);
  return state;
}

GeneralizedAlpha::GeneralizedAlpha(System& system, State state, const StepperOptions& options, double rho)
    : ImplicitStepper(
          "generalised-alpha",
          [rho] {
            if (!(rho >= 0 && rho <= 1))
              throw ModelError(fmt::format("generalised-alpha: spectral_radius = {}, must be 0 to 1", rho));
            const double m = (2 * rho - 1) / (rho + 1), f = rho / (rho + 1);
            return Coefficients{m, f, (1 - m + f) * (1 - m + f) / 4, 0.5 - m + f};
          }(),
          system, std::move(state), options) {}

Hht::Hht(System& system, State state, const StepperOptions& options, double alpha)
    : ImplicitStepper(
          "HHT",
          [alpha] {
            if (!(alpha >= -1.0 / 3 && alpha <= 0))
              throw ModelError(fmt::format("HHT: alpha = {}, must be -1/3 to 0", alpha));
            return Coefficients{0, -alpha, (1 - alpha) * (1 - alpha) / 4, 0.5 - alpha};
          }(),
          system, std::move(state), options) {}

ImplicitStepper::ImplicitStepper(const char* method, const Coefficients& coefficients, System& system,
                                 State state, const StepperOptions& options)
    : Integrator(system, std::move(state)),
      method_(method),
      c_(coefficients),
      beta_(c_.beta * (1 - c_.alpha_f) / (1 - c_.alpha_m)),
      gamma_(c_.gamma * (1 - c_.alpha_f) / (1 - c_.alpha_m)),
      options_(options),
      n_bodies_(system.body_size()),
      n_first_(system.first_order_size()),
      n_constraints_(system.constraint_size()),
      h_(options.step) {
  const auto require_positive = [&](double value, const char* name) {
    if (!(value > 0)) throw ModelError(fmt::format("{}: {} = {}, must be > 0", method_, name, value));
  };
  require_positive(options.step, "step [s]");
  require_positive(options.tolerance, "tolerance");
  require_positive(options.min_step, "min_step [s]");
  require_positive(options.max_step, "max_step [s]");
  require_positive(options.newton_tolerance, "newton_tolerance");

  make_consistent();
  // The first evaluation tells how many ports there are, and their forces.
  system_.evaluate(state_);
  system_.update_loops(state_);
  last_change_ = VectorXd::Zero(n_first_);
  port_forces_.resize(static_cast<int>(system_.ports().size()));
  for (int p = 0; p < port_forces_.size(); ++p)
    port_forces_[p] = system_.ports()[static_cast<std::size_t>(p)].force;
  floors_.resize(system_.equation_count() + port_forces_.size());
  floors_.setConstant(force_floor);
  floors_.head(n_bodies_ + n_first_).setConstant(acceleration_floor);
  take_initial_unknowns(z_);
  scale_ = floors_.cwiseMax(z_.cwiseAbs());
}

ImplicitStepper::~ImplicitStepper() = default;

// A state whose accelerations do not satisfy the equations of motion would swing about those that do, for ever.
void ImplicitStepper::make_consistent() {
  if (n_constraints_ > 0) AccelerationSolver(system_).project_velocities(state_);
  State still = state_;
  still.qdd.setZero();
  still.xd.setZero();
  still.lambda.setZero();
  const double forces = system_.compute_residual(still).lpNorm<Eigen::Infinity>();
  const double error = system_.compute_residual(state_).lpNorm<Eigen::Infinity>();
  const double rate_error = n_first_ > 0 ? (state_.xd - system_.first_order_rates()).norm() : 0;
  // 1e-6 of the forces: a state that another run, or a quasi-static start, has left is taken as it is.
  const bool is_consistent =
      error <= 1e-6 * std::max(forces, 1.0) && rate_error <= 1e-6 * (1 + state_.xd.norm());
  if (!is_consistent || n_constraints_ > 0) set_consistent_accelerations(system_, state_);
  const bool has_memory =
      is_consistent && state_.a.size() == state_.qdd.size() && state_.w.size() == n_first_;
  a_ = has_memory ? state_.a : state_.qdd;
  w_ = has_memory ? state_.w : state_.xd;
}

void ImplicitStepper::take_initial_unknowns(VectorXd& z) const {
  z.resize(system_.equation_count() + port_forces_.size());
  z << state_.qdd.head(n_bodies_), state_.xd, state_.lambda, port_forces_;
}

void ImplicitStepper::prepare(double h) {
  if (h == prepared_step_) return;
  condensation_ = std::make_unique<Condensation>(system_, 1.0, gamma_ * h, beta_ * h * h);
  statistics_.factorisations += static_cast<long>(system_.structures().size());
  jacobian_known_ = false;
  prepared_step_ = h;
}

void ImplicitStepper::set_unknowns(const VectorXd& z, State& next) {
  const double h = prepared_step_;
  const int n = n_bodies_;
  next.qdd.head(n) = z.head(n);
  next.q.head(n) = q_star_.head(n) + beta_ * h * h * z.head(n);
  next.qd.head(n) = qd_star_.head(n) + gamma_ * h * z.head(n);
  next.xd = z.segment(n, n_first_);
  next.x = x_star_ + gamma_ * h * next.xd;
  next.lambda = z.segment(n + n_first_, n_constraints_);
}

void ImplicitStepper::evaluate(const VectorXd& z, State& next, VectorXd& residual) {
  forces_ = z.tail(port_forces_.size());
  set_unknowns(z, next);
  system_.compute_body_residual(
      System::body_state(next),
      [this](int k, const PortShape& shape) { return condensation_->motion(k, shape, forces_); },
      residual.data());
  system_.update_loops(next);  // the next trial starts from here
  ++statistics_.evaluations;
  if (static_cast<int>(system_.ports().size()) != forces_.size())
    throw ModelError(
        fmt::format("system \"{}\": forces() touched {} ports, {} before; touch the same ports in the "
                    "same order at each evaluation",
                    system_.name(), system_.ports().size(), forces_.size()));
  for (int p = 0; p < forces_.size(); ++p)
    residual[residual.size() - forces_.size() + p] =
        forces_[p] - system_.ports()[static_cast<std::size_t>(p)].force;
}

// By differences from residual_, at z.
void ImplicitStepper::compute_jacobian(const VectorXd& z, State& next) {
  const int n = static_cast<int>(z.size());
  differences_.resize(n, n);
  shifted_residual_.resize(n);
  shifted_ = z;
  for (int i = 0; i < n; ++i) {
    const double delta = 1e-4 * scale_[i];
    shifted_[i] = z[i] + delta;
    evaluate(shifted_, next, shifted_residual_);
    differences_.col(i) = (shifted_residual_ - residual_) / (shifted_[i] - z[i]);
    shifted_[i] = z[i];
  }
  jacobian_.compute(differences_);
  jacobian_known_ = true;
  ++statistics_.jacobians;
}

bool ImplicitStepper::try_step(double h, State& next) {
  prepare(h);
  const int n = n_bodies_, n_ports = static_cast<int>(port_forces_.size());
  const double f = c_.alpha_f, m = c_.alpha_m;
  const int n_structures = static_cast<int>(state_.q.size()) - n;

  // What is known of the new state before its accelerations.
  carried_ = (f * state_.qdd - m * a_) / (1 - m);  // the part of a_1 that is known
  q_star_ = state_.q + h * state_.qd + h * h * ((0.5 - c_.beta) * a_ + c_.beta * carried_);
  qd_star_ = state_.qd + h * ((1 - c_.gamma) * a_ + c_.gamma * carried_);
  x_star_ = state_.x + h * ((1 - c_.gamma) * w_ + c_.gamma / (1 - m) * (f * state_.xd - m * w_));
  next = state_;
  next.t = state_.t + h;
  next.q = q_star_ + beta_ * h * h * state_.qdd;
  next.qd = qd_star_ + gamma_ * h * state_.qdd;
  VectorXd& z = z_;
  take_initial_unknowns(z);
  residual_.resize(z.size());

  VectorXd& b = b_;
  b.resize(n_structures);
  if (n_structures > 0) {
    // Where are the structures touched at the new time? Then their free motion and port compliances.
    system_.evaluate(next);
    int at = 0;
    for (const auto& s : system_.structures()) {
      auto b_s = b.segment(at, s->size());
      b_s.setZero();
      b_s.noalias() -= s->C() * qd_star_.segment(n + at, s->size());
      b_s.noalias() -= s->K() * q_star_.segment(n + at, s->size());
      at += s->size();
    }
    condensation_->solve(b, system_.ports());
    condensation_->set_bases(q_star_.tail(n_structures), beta_ * h * h, qd_star_.tail(n_structures),
                             gamma_ * h);
  }

  // Newton on accelerations and port forces.
  double previous = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < options_.max_iterations; ++iteration) {
    evaluate(z, next, residual_);
    last_residual_ = residual_.lpNorm<Eigen::Infinity>();
    if (!residual_.allFinite()) return false;
    if (!jacobian_known_) compute_jacobian(z, next);
    correction_ = jacobian_.solve(residual_);
    z -= correction_;
    const double size = z.size() > 0 ? correction_.cwiseAbs().cwiseQuotient(scale_).maxCoeff() : 0.0;
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
        next.q.tail(n_structures) = q_star_.tail(n_structures) + beta_ * h * h * y_;
        next.qd.tail(n_structures) = qd_star_.tail(n_structures) + gamma_ * h * y_;
      }
      return true;
    }
    if (size > 0.1 * previous) jacobian_known_ = false;  // converging slowly: renew
    previous = size;
  }
  return false;
}

double ImplicitStepper::local_error(const State& next, double h) const {
  const double factor = std::abs(c_.beta - 1.0 / 6 + 0.5 * (c_.alpha_m - c_.alpha_f)) * h * h;
  double error = 0;
  if (next.qdd.size() > 0) error = factor * (next.qdd - state_.qdd).lpNorm<Eigen::Infinity>();
  // A first-order state errs like a rate, one order of h less: x... from the change of the change of its rate.
  if (next.xd.size() > 0) {
    const double rate_factor = std::abs(1.0 / 12 - (c_.alpha_m - c_.alpha_f) * (0.5 - c_.alpha_f)) * h;
    error = std::max(error, rate_factor * (next.xd - state_.xd - h * last_change_).lpNorm<Eigen::Infinity>());
  }
  return error / options_.tolerance;
}

void ImplicitStepper::step() {
  if (inputs_have_changed()) {
    set_consistent_accelerations(system_, state_);
    a_ = state_.qdd;
    w_ = state_.xd;
    jacobian_known_ = false;
  }
  State& next = next_;
  for (;;) {
    forces_before_ = port_forces_;
    bool converged = false;
    if (options_.variable_step) {
      try {
        converged = try_step(h_, next);
      } catch (const SolverError&) {  // a trial beyond what the system can do: a smaller step may pass
        if (0.5 * h_ < options_.min_step) throw;
        jacobian_known_ = false;
        last_residual_ = std::numeric_limits<double>::infinity();
      }
    } else {
      converged = try_step(h_, next);
    }
    if (!options_.variable_step) {
      if (!converged)
        throw SolverError(
            std::isfinite(last_residual_)
                ? fmt::format("{}: no convergence at t = {} s with step {} s after {} iterations, "
                              "residual {:.3g}; "
                              "try a smaller step",
                              method_, state_.t, h_, options_.max_iterations, last_residual_)
                : fmt::format(
                      "{}: the residual is not a finite number at t = {} s with step {} s; does a force "
                      "divide by zero or take a root of a negative number?",
                      method_, state_.t, h_));
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
    port_forces_ = forces_before_;
    h_ *= std::min(factor, 0.5);
    if (h_ < options_.min_step)
      throw SolverError(
          fmt::format("{}: the step fell below {} s at t = {} s (local error {:.3g} of the "
                      "tolerance, residual {:.3g}); is there an impact, or is the tolerance too tight?",
                      method_, options_.min_step, state_.t, error, last_residual_));
  }
  accept(next);
}

void ImplicitStepper::accept(State& next) {
  const double f = c_.alpha_f, m = c_.alpha_m, h = next.t - state_.t;
  a_ = ((1 - f) * next.qdd + f * state_.qdd - m * a_) / (1 - m);
  w_ = ((1 - f) * next.xd + f * state_.xd - m * w_) / (1 - m);
  last_change_ = (next.xd - state_.xd) / h;
  state_ = std::move(next);
  if (system_.update_charts(state_, &a_)) jacobian_known_ = false;
  if (m != 0 || f != 0) {
    state_.a = a_;
    state_.w = w_;
  }
  scale_ = next_scale_;
  ++statistics_.steps;
}

void ImplicitStepper::advance(double t_end, const std::function<void(const State&)>& after_each_step) {
  check_end(t_end);
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

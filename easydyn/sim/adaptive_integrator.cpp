#include "easydyn/sim/adaptive_integrator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "easydyn/sim/adaptive_backend.hpp"

namespace easydyn {

AdaptiveOptions checked(const AdaptiveOptions& options) {
  if (!(options.relative_tolerance >= 1e-15 && options.relative_tolerance < 1))
    throw ModelError(
        fmt::format("integrator: relative_tolerance = {}, must be 1e-15 to 1", options.relative_tolerance));
  if (!(options.absolute_tolerance > 0))
    throw ModelError(
        fmt::format("integrator: absolute_tolerance = {}, must be > 0", options.absolute_tolerance));
  if (!(options.first_step >= 0) || !(options.max_step >= 0))
    throw ModelError(fmt::format("integrator: first_step = {} s, max_step = {} s, must be >= 0",
                                 options.first_step, options.max_step));
  return options;
}

AdaptiveIntegrator::AdaptiveIntegrator(System& system, State state) : Integrator(system, std::move(state)) {}

AdaptiveIntegrator::~AdaptiveIntegrator() = default;

State AdaptiveIntegrator::consistent(System& system, State state) {
  AccelerationSolver solver(system);
  solver.project_velocities(state);
  solver.solve(state);
  system.update_loops(state);
  set_consistent_accelerations(system, state);  // refuses what is not finite
  return state;
}

void AdaptiveIntegrator::watch(Event event) {
  if (backend_->has_started)
    throw ModelError(fmt::format("event \"{}\": to be watched before the first step", event.name));
  if (event.direction < -1 || event.direction > 1)
    throw ModelError(
        fmt::format("event \"{}\": direction = {}, must be -1, 0 or 1", event.name, event.direction));
  backend_->watched.push_back(std::move(event));
}

void AdaptiveIntegrator::complete_state() {
  if (is_complete_) return;
  backend_->accelerations.solve(state_);
  is_complete_ = true;
}

bool AdaptiveIntegrator::take_step(double t_end, bool is_watched) {
  Backend& b = *backend_;
  if (!b.has_started) {
    if (!b.watched.empty()) {
      std::vector<int> directions;
      for (const Event& e : b.watched) directions.push_back(e.direction);
      b.set_roots(directions.data());
    }
    b.has_started = true;
  }
  if (inputs_have_changed()) {
    b.accelerations.solve(state_);
    is_complete_ = true;
    b.pack(state_, b.y);
    b.restart(state_);
    if (b.has_stop_time) b.set_stop_time(t_end);
  }
  if (b.is_empty()) return take_empty_step(t_end);
  double t = state_.t;
  const int flag = b.one_step(t_end, t);
  const std::exception_ptr thrown = std::exchange(b.thrown, nullptr);
  if (flag < 0) complete_state();  // the last good one, which the caller may look at
  if (thrown) std::rethrow_exception(thrown);
  const std::exception_ptr beyond = std::exchange(b.beyond, nullptr);
  if (flag < 0 && beyond) std::rethrow_exception(beyond);
  if (flag < 0)
    throw SolverError(
        fmt::format("{}: {} at t = {} s with step {:.3g} s; is the motion smooth, and are the "
                    "tolerances within reach?",
                    b.name(), b.flag_name(flag), t, b.last_step()));
  b.step_start = t - b.last_step();
  ++b.steps;
  b.unpack(t, b.y, state_);
  is_complete_ = false;
  const bool has_new_chart = system_.update_charts(state_);
  if (has_new_chart || is_watched || b.is_root(flag) || state_.t >= t_end) complete_state();
  system_.update_loops(state_);
  b.scratch.loops = state_.loops;
  if (has_new_chart) {
    b.scratch.charts = state_.charts;
    b.pack(state_, b.y);
    b.restart(state_);
    b.step_start = t;
  }

  bool stops = false;
  if (b.is_root(flag)) {
    std::vector<int> found(b.watched.size());
    b.get_roots(found.data());
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (found[i] == 0) continue;
      events_.push_back({b.watched[i].name, t, found[i]});
      stops = stops || b.watched[i].stops;
    }
  }
  return stops;
}

// Where everything moves as given, only the time goes on.
bool AdaptiveIntegrator::take_empty_step(double t_end) {
  const AdaptiveOptions& o = backend_->options;
  state_.t = std::min(t_end, state_.t + (o.max_step > 0 ? o.max_step : 1e-2));
  system_.evaluate(state_);
  system_.update_loops(state_);
  is_complete_ = true;
  ++backend_->steps;
  return false;
}

void AdaptiveIntegrator::step() {
  take_step(state_.t + 1e6, true);
}

void AdaptiveIntegrator::advance(double t_end, const Watcher& after_each_step) {
  check_end(t_end);
  while (state_.t < t_end) {
    backend_->set_stop_time(t_end);
    backend_->has_stop_time = true;
    const bool stops = take_step(t_end, static_cast<bool>(after_each_step));
    if (after_each_step) after_each_step(state_);
    if (stops) return;
  }
}

State AdaptiveIntegrator::interpolate(double t) {
  Backend& b = *backend_;
  const double slack = 1e-9 * (state_.t - b.step_start);
  if (b.steps == 0 || t < b.step_start - slack || t > state_.t + slack)
    throw ModelError(fmt::format("integrator: t = {} s, must be within the last step, {} to {} s", t,
                                 b.step_start, state_.t));
  State s = state_;
  N_Vector v = N_VClone(b.y);
  const int flag = b.interpolate(t, v);
  b.unpack(t, v, s);
  N_VDestroy(v);
  if (flag < 0) throw SolverError(fmt::format("{}: {} at t = {} s", b.name(), b.flag_name(flag), t));
  b.accelerations.solve(s);
  return s;
}

AdaptiveIntegrator::Statistics AdaptiveIntegrator::statistics() const {
  return {backend_->steps, backend_->evaluations};
}

}  // namespace easydyn

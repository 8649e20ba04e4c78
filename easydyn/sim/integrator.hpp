#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "easydyn/error.hpp"
#include "easydyn/mbs/system.hpp"

namespace easydyn {

/// What all time integrators do: they hold a state that satisfies the equations of motion and take it forward. Inputs may
/// be set between steps: the next step starts with the accelerations that they give.
class Integrator {
 public:
  using Watcher = std::function<void(const State&)>;

  virtual ~Integrator() = default;
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;

  const State& state() const { return state_; }
  System& system() { return system_; }

  /// One step of the integrator's own. @throws SolverError naming time, step and what to try
  virtual void step() = 0;
  /// Steps until t_end. `after_each_step` sees every accepted state.
  virtual void advance(double t_end, const Watcher& after_each_step = {}) = 0;

 protected:
  Integrator(System& system, State state)
      : system_(system), state_(std::move(state)), revision_(system.revision()), inputs_(present_inputs()) {}

  /// To be called before a step. @throws ModelError if coordinates were declared, held or released since the start
  /// @returns whether an input has changed since the last step: the accelerations jump, and memory of them is void
  bool inputs_have_changed() {
    if (system_.revision() != revision_)
      throw ModelError("integrator: coordinates of system \"" + system_.name() +
                       "\" were declared, held or released during a run; make a new integrator");
    bool has_changed = false;
    for (int i = 0; i < system_.input_size(); ++i) {
      double& seen = inputs_[static_cast<std::size_t>(i)];
      has_changed = has_changed || seen != system_.input_value(i);
      seen = system_.input_value(i);
    }
    return has_changed;
  }
  /// @throws ModelError unless the end is a time
  static void check_end(double t_end) {
    if (!std::isfinite(t_end)) throw ModelError("integrator: the end of a run must be a finite time");
  }

  System& system_;
  State state_;

 private:
  std::vector<double> present_inputs() const {
    std::vector<double> values;
    values.reserve(static_cast<std::size_t>(system_.input_size()));
    for (int i = 0; i < system_.input_size(); ++i) values.push_back(system_.input_value(i));
    return values;
  }
  int revision_;
  std::vector<double> inputs_;
};

}  // namespace easydyn

#pragma once

#include <functional>

#include "easydyn/mbs/system.hpp"

namespace easydyn {

/// What all time integrators do: they hold a state that satisfies the equations of motion and take it forward.
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
  Integrator(System& system, State state) : system_(system), state_(std::move(state)) {}

  System& system_;
  State state_;
};

}  // namespace easydyn

#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "easydyn/sim/integrator.hpp"

namespace easydyn {

/// Something that happens when a function of the state passes through zero: a contact closes, a limit is reached.
struct Event {
  std::string name;
  std::function<double(const State&)> function;  ///< of t, q, qd, x (qdd, xd and lambda are not set)
  int direction = 0;                             ///< +1: upward only, -1: downward only, 0: both
  bool stops = true;                             ///< advance() returns there
};

/// An event that happened.
struct EventRecord {
  std::string name;
  double t;
  int direction;  ///< +1 upward, -1 downward
};

struct AdaptiveOptions {
  /// Bounds of the local error of each entry y of q, qd and x per step: |e| <= relative |y| + absolute (root mean
  /// square over the entries). The error at the end is larger by what the motion makes of small differences. Measured
  /// after one wide swing of a pendulum, in relative tolerances: RungeKutta 6 to 15, Adams 30 to 330, BDF 60 to 730,
  /// Ida 50 to 160; in chaotic motion it has no bound.
  double relative_tolerance = 1e-6, absolute_tolerance = 1e-8;
  double first_step = 0;  ///< [s]; 0: chosen
  double max_step = 0;    ///< [s]; 0: no limit
};

/// Integrators with a step and an error control of their own, on SUNDIALS: they find events, and know the motion
/// between the steps. Velocity constraints hold at the accelerations exactly, at the velocities within the tolerance.
class AdaptiveIntegrator : public Integrator {
 public:
  ~AdaptiveIntegrator() override;

  /// To be called before the first step.
  void watch(Event event);
  const std::vector<EventRecord>& events() const { return events_; }

  void step() override;
  /// Ends at t_end exactly, or at an event that stops.
  void advance(double t_end, const Watcher& after_each_step = {}) override;
  /// The motion at a time within the last step (dense output; accelerations from the equations of motion).
  /// @throws ModelError if t lies outside the last step, or a free motion has changed its chart there
  State interpolate(double t);

  struct Statistics {
    long steps = 0, evaluations = 0;
  };
  Statistics statistics() const;

 protected:
  struct Backend;  // what is common to the libraries, and what differs
  struct RungeKuttaBackend;
  struct CvodeBackend;
  struct IdaBackend;
  AdaptiveIntegrator(System& system, State state);
  static State consistent(System& system, State state);
  std::unique_ptr<Backend> backend_;

 private:
  /// Accelerations, rates and constraint forces of the new state are left for later if nobody is going to look at them.
  /// True: an event stops.
  bool take_empty_step(double t_end);
  bool take_step(double t_end, bool is_watched);
  void complete_state();
  std::vector<EventRecord> events_;
  bool is_complete_ = true;  // qdd, xd and lambda belong to the state
};

/// Explicit Runge-Kutta method of Dormand and Prince, order 5 with an error estimate of order 4 (ARKODE): for smooth
/// motion without stiff parts, the fastest at moderate tolerances.
class RungeKutta : public AdaptiveIntegrator {
 public:
  explicit RungeKutta(System& system, const AdaptiveOptions& options = {})
      : RungeKutta(system, system.initial_state(), options) {}
  RungeKutta(System& system, State state, const AdaptiveOptions& options = {});
};

/// Linear multistep methods of variable order (CVODE).
class Cvode : public AdaptiveIntegrator {
 public:
  enum class Method {
    adams,  ///< orders 1 to 12, fixed-point iteration: smooth motion at tight tolerances
    bdf     ///< orders 1 to 5, Newton: stiff systems
  };
  explicit Cvode(System& system, const AdaptiveOptions& options = {}, Method method = Method::bdf)
      : Cvode(system, system.initial_state(), options, method) {}
  Cvode(System& system, State state, const AdaptiveOptions& options = {}, Method method = Method::bdf);
};

/// BDF on the residual itself (IDA): no mass matrix is inverted.
class Ida : public AdaptiveIntegrator {
 public:
  explicit Ida(System& system, const AdaptiveOptions& options = {})
      : Ida(system, system.initial_state(), options) {}
  Ida(System& system, State state, const AdaptiveOptions& options = {});
};

}  // namespace easydyn

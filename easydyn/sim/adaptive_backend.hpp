#pragma once

// Private to the adaptive integrators: what they share, and what each of SUNDIALS' libraries adds.

#include <nvector/nvector_serial.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <string>
#include <sundials/sundials_context.hpp>
#include <vector>

#include "easydyn/error.hpp"
#include "easydyn/sim/accelerations.hpp"
#include "easydyn/sim/adaptive_integrator.hpp"

namespace easydyn {

inline Eigen::Map<Eigen::VectorXd> view(N_Vector v) {
  return {N_VGetArrayPointer(v), N_VGetLength(v)};
}

/// Takes the place of SUNDIALS' own messages: flags are turned into SolverError.
inline void ignore_message(int, const char*, const char*, char*, void*) {}

/// The names of flags come in memory of the library's.
template <class Function>
std::string take_name(Function function, int flag) {
  char* text = function(flag);
  std::string result(text);
  std::free(text);
  return result;
}

/// Steps of one call are not limited.
constexpr long many_steps = 1L << 40;

/// @throws ModelError naming the option that is out of range
AdaptiveOptions checked(const AdaptiveOptions& options);

/// y = (q, qd, x), for Ida also lambda; the equations that give y' or the residual.
struct AdaptiveIntegrator::Backend {
  Backend(System& system_, const State& start, const AdaptiveOptions& options_, bool has_lambda)
      : system(system_),
        options(checked(options_)),
        accelerations(system_),
        scratch(start),
        n(system_.size()),
        nx(system_.first_order_size()),
        nc(has_lambda ? system_.constraint_size() : 0),
        y(N_VNew_Serial(std::max(1, 2 * n + nx + nc),
                        context)) {  // one entry without meaning where nothing is unknown
    N_VConst(0, y);
    pack(start, y);
  }
  virtual ~Backend() { N_VDestroy(y); }

  bool is_empty() const { return 2 * n + nx + nc == 0; }
  void pack(const State& s, N_Vector to) const {
    auto v = view(to);
    v.head(n) = s.q;
    v.segment(n, n) = s.qd;
    v.segment(2 * n, nx) = s.x;
    v.segment(2 * n + nx, nc) = s.lambda.head(nc);
  }
  void unpack(double t, N_Vector from, State& s) const {
    const auto v = view(from);
    s.t = t;
    s.q = v.head(n);
    s.qd = v.segment(n, n);
    s.x = v.segment(2 * n, nx);
    if (nc > 0) s.lambda = v.segment(2 * n + nx, nc);
  }
  /// y' = (qd, qdd, f). 0, or -1 with the exception kept.
  int rates(double t, N_Vector at, N_Vector rate) noexcept {
    try {
      unpack(t, at, scratch);
      accelerations.solve(scratch);
      auto v = view(rate);
      v.setZero();
      v.head(n) = scratch.qd;
      v.segment(n, n) = scratch.qdd;
      v.segment(2 * n, nx) = scratch.xd;
      ++evaluations;
      return v.allFinite() ? 0 : give_up_trial(rate);
    } catch (const SolverError&) {  // a trial beyond what the system can do: a smaller step may pass
      beyond = std::current_exception();
      return give_up_trial(rate);
    } catch (...) {
      thrown = std::current_exception();
      return -1;
    }
  }
  int roots(double t, N_Vector at, double* g) noexcept {
    try {
      unpack(t, at, scratch);
      for (const Event& e : watched) *g++ = e.function(scratch);
      return 0;
    } catch (...) {
      thrown = std::current_exception();
      return -1;
    }
  }

  /// Makes the library try a smaller step.
  virtual int give_up_trial(N_Vector) { return 1; }
  virtual const char* name() const = 0;
  virtual void set_stop_time(double t) = 0;
  virtual int one_step(double t_end, double& t) = 0;  // the library's flag
  virtual bool is_root(int flag) const = 0;
  virtual void get_roots(int* found) = 0;
  virtual void set_roots(int* directions) = 0;
  virtual int interpolate(double t, N_Vector into) = 0;
  virtual std::string flag_name(int flag) const = 0;
  virtual double last_step() const = 0;
  virtual void restart(const State& from) = 0;  // y has been set

  sundials::Context context;
  System& system;
  AdaptiveOptions options;
  AccelerationSolver accelerations;
  State scratch;
  int n, nx, nc;
  N_Vector y;
  std::vector<Event> watched;
  std::exception_ptr thrown, beyond;  // an error that ends the run; the last one of a trial
  long steps = 0, evaluations = 0;
  double step_start = 0;
  bool has_started = false, has_stop_time = false;
};

}  // namespace easydyn

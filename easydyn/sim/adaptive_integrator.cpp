#include "easydyn/sim/adaptive_integrator.hpp"

#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <fmt/format.h>
#include <ida/ida.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <sundials/sundials_context.hpp>
#include <utility>

#include "easydyn/error.hpp"
#include "easydyn/sim/accelerations.hpp"

namespace easydyn {

using Eigen::VectorXd;

namespace {

Eigen::Map<VectorXd> view(N_Vector v) {
  return {N_VGetArrayPointer(v), N_VGetLength(v)};
}

void ignore_message(int, const char*, const char*, char*, void*) {}  // flags are turned into SolverError

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

constexpr long many_steps = 1L << 40;

}  // namespace

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

namespace {
// The names of flags come in memory of the library's.
template <class Function>
std::string take_name(Function function, int flag) {
  char* text = function(flag);
  std::string result(text);
  free(text);
  return result;
}
}  // namespace

// --- ARKODE ----------------------------------------------------------------------------------------------

struct AdaptiveIntegrator::RungeKuttaBackend : Backend {
  RungeKuttaBackend(System& s, const State& start, const AdaptiveOptions& o) : Backend(s, start, o, false) {
    memory =
        ERKStepCreate([](double t, N_Vector y_, N_Vector rate,
                         void* self) { return static_cast<RungeKuttaBackend*>(self)->rates(t, y_, rate); },
                      start.t, y, context);
    ERKStepSetErrHandlerFn(memory, ignore_message, nullptr);
    ERKStepSetUserData(memory, this);
    ERKStepSetTableNum(memory, ARKODE_DORMAND_PRINCE_7_4_5);
    ERKStepSStolerances(memory, o.relative_tolerance, o.absolute_tolerance);
    ERKStepSetMaxNumSteps(memory, many_steps);
    if (o.first_step > 0) ERKStepSetInitStep(memory, o.first_step);
    if (o.max_step > 0) ERKStepSetMaxStep(memory, o.max_step);
  }
  ~RungeKuttaBackend() override { ERKStepFree(&memory); }
  // ERKStep takes any flag for final; an error estimate beyond all bounds makes it try again.
  int give_up_trial(N_Vector rate) override {
    constexpr double shortest = 1e-9;  // [s]: closer to an obstacle there is nothing to gain
    double h = 0;
    ERKStepGetCurrentStep(memory, &h);
    if (!has_started || std::abs(h) < shortest) return 1;
    N_VConst(1e30, rate);
    return 0;
  }
  const char* name() const override { return "RungeKutta"; }
  void set_stop_time(double t) override { ERKStepSetStopTime(memory, t); }
  int one_step(double t_end, double& t) override { return ERKStepEvolve(memory, t_end, y, &t, ARK_ONE_STEP); }
  bool is_root(int flag) const override { return flag == ARK_ROOT_RETURN; }
  void get_roots(int* found) override { ERKStepGetRootInfo(memory, found); }
  void set_roots(int* directions) override {
    ERKStepRootInit(memory, static_cast<int>(watched.size()),
                    [](double t, N_Vector y_, double* g, void* self) {
                      return static_cast<RungeKuttaBackend*>(self)->roots(t, y_, g);
                    });
    ERKStepSetRootDirection(memory, directions);
    ERKStepSetNoInactiveRootWarn(memory);
  }
  int interpolate(double t, N_Vector into) override { return ERKStepGetDky(memory, t, 0, into); }
  void restart(const State& from) override { ERKStepReset(memory, from.t, y); }
  std::string flag_name(int flag) const override {
    return take_name([](long f) { return ERKStepGetReturnFlagName(f); }, flag);
  }
  double last_step() const override {
    double h = 0;
    ERKStepGetLastStep(memory, &h);
    return h;
  }
  void* memory = nullptr;
};

// --- CVODE -----------------------------------------------------------------------------------------------

struct AdaptiveIntegrator::CvodeBackend : Backend {
  CvodeBackend(System& s, const State& start, const AdaptiveOptions& o, Cvode::Method method)
      : Backend(s, start, o, false) {
    const bool is_bdf = method == Cvode::Method::bdf;
    memory = CVodeCreate(is_bdf ? CV_BDF : CV_ADAMS, context);
    CVodeSetErrHandlerFn(memory, ignore_message, nullptr);
    CVodeInit(
        memory,
        [](double t, N_Vector y_, N_Vector rate, void* self) {
          return static_cast<CvodeBackend*>(self)->rates(t, y_, rate);
        },
        start.t, y);
    CVodeSetUserData(memory, this);
    CVodeSStolerances(memory, o.relative_tolerance, o.absolute_tolerance);
    CVodeSetMaxNumSteps(memory, many_steps);
    if (o.first_step > 0) CVodeSetInitStep(memory, o.first_step);
    if (o.max_step > 0) CVodeSetMaxStep(memory, o.max_step);
    if (is_bdf) {
      const auto size = static_cast<sunindextype>(N_VGetLength(y));
      matrix = SUNDenseMatrix(size, size, context);
      linear = SUNLinSol_Dense(y, matrix, context);
      CVodeSetLinearSolver(memory, linear, matrix);
    } else {
      nonlinear = SUNNonlinSol_FixedPoint(y, 0, context);
      CVodeSetNonlinearSolver(memory, nonlinear);
    }
  }
  ~CvodeBackend() override {
    CVodeFree(&memory);
    if (nonlinear) SUNNonlinSolFree(nonlinear);
    if (linear) SUNLinSolFree(linear);
    if (matrix) SUNMatDestroy(matrix);
  }
  const char* name() const override { return "Cvode"; }
  void set_stop_time(double t) override { CVodeSetStopTime(memory, t); }
  int one_step(double t_end, double& t) override { return CVode(memory, t_end, y, &t, CV_ONE_STEP); }
  bool is_root(int flag) const override { return flag == CV_ROOT_RETURN; }
  void get_roots(int* found) override { CVodeGetRootInfo(memory, found); }
  void set_roots(int* directions) override {
    CVodeRootInit(memory, static_cast<int>(watched.size()), [](double t, N_Vector y_, double* g, void* self) {
      return static_cast<CvodeBackend*>(self)->roots(t, y_, g);
    });
    CVodeSetRootDirection(memory, directions);
    CVodeSetNoInactiveRootWarn(memory);
  }
  int interpolate(double t, N_Vector into) override { return CVodeGetDky(memory, t, 0, into); }
  void restart(const State& from) override { CVodeReInit(memory, from.t, y); }
  std::string flag_name(int flag) const override {
    return take_name([](long f) { return CVodeGetReturnFlagName(f); }, flag);
  }
  double last_step() const override {
    double h = 0;
    CVodeGetLastStep(memory, &h);
    return h;
  }
  void* memory = nullptr;
  SUNMatrix matrix = nullptr;
  SUNLinearSolver linear = nullptr;
  SUNNonlinearSolver nonlinear = nullptr;
};

// --- IDA -------------------------------------------------------------------------------------------------

// F = (q' - v, r(q, v, v') - A^T lambda, x' - f, A v' + phi.(0)) with y = (q, v, x, lambda).
struct AdaptiveIntegrator::IdaBackend : Backend {
  IdaBackend(System& s, const State& start, const AdaptiveOptions& o) : Backend(s, start, o, true) {
    rate = N_VClone(y);
    N_VConst(0, rate);
    view(rate).head(2 * n + nx) << start.qd, start.qdd, start.xd;
    memory = IDACreate(context);
    IDASetErrHandlerFn(memory, ignore_message, nullptr);
    IDAInit(
        memory,
        [](double t, N_Vector y_, N_Vector rate_, N_Vector F, void* self) {
          return static_cast<IdaBackend*>(self)->residual(t, y_, rate_, F);
        },
        start.t, y, rate);
    IDASetUserData(memory, this);
    IDASStolerances(memory, o.relative_tolerance, o.absolute_tolerance);
    IDASetMaxNumSteps(memory, many_steps);
    if (o.first_step > 0) IDASetInitStep(memory, o.first_step);
    if (o.max_step > 0) IDASetMaxStep(memory, o.max_step);
    if (nc > 0) {  // lambda has no error of its own
      is_differential = N_VClone(y);
      N_VConst(1, is_differential);
      view(is_differential).tail(nc).setZero();
      IDASetId(memory, is_differential);
      IDASetSuppressAlg(memory, SUNTRUE);
    }
    const auto size = static_cast<sunindextype>(N_VGetLength(y));
    matrix = SUNDenseMatrix(size, size, context);
    linear = SUNLinSol_Dense(y, matrix, context);
    IDASetLinearSolver(memory, linear, matrix);
    r.resize(n);
  }
  ~IdaBackend() override {
    IDAFree(&memory);
    SUNLinSolFree(linear);
    SUNMatDestroy(matrix);
    N_VDestroy(rate);
    if (is_differential) N_VDestroy(is_differential);
  }
  int residual(double t, N_Vector at, N_Vector rate_at, N_Vector F) noexcept {
    try {
      unpack(t, at, scratch);
      const auto d = view(rate_at);
      auto f = view(F);
      scratch.qdd = d.segment(n, n);
      scratch.xd = d.segment(2 * n, nx);
      system.compute_residual(scratch, r);
      ++evaluations;
      f.head(n) = d.head(n) - scratch.qd;
      f.segment(n, n) = r;
      f.segment(2 * n, nx) = scratch.xd - system.first_order_rates();
      int row = 2 * n + nx;
      for (const VelocityConstraint& c : system.velocity_constraints()) {
        double acceleration = c.bias();
        for (const Gradient::Entry& a : c.row())
          if (a.coordinate < system.body_size()) acceleration += a.value * scratch.qdd[a.coordinate];
        f[row++] = acceleration;
      }
      return f.allFinite() ? 0 : 1;
    } catch (const SolverError&) {
      beyond = std::current_exception();
      return 1;
    } catch (...) {
      thrown = std::current_exception();
      return -1;
    }
  }
  const char* name() const override { return "Ida"; }
  void set_stop_time(double t) override { IDASetStopTime(memory, t); }
  int one_step(double t_end, double& t) override {
    return IDASolve(memory, t_end, &t, y, rate, IDA_ONE_STEP);
  }
  bool is_root(int flag) const override { return flag == IDA_ROOT_RETURN; }
  void get_roots(int* found) override { IDAGetRootInfo(memory, found); }
  void set_roots(int* directions) override {
    IDARootInit(memory, static_cast<int>(watched.size()),
                [](double t, N_Vector y_, N_Vector, double* g, void* self) {
                  return static_cast<IdaBackend*>(self)->roots(t, y_, g);
                });
    IDASetRootDirection(memory, directions);
    IDASetNoInactiveRootWarn(memory);
  }
  int interpolate(double t, N_Vector into) override { return IDAGetDky(memory, t, 0, into); }
  void restart(const State& from) override {
    N_VConst(0, rate);
    view(rate).head(2 * n + nx) << from.qd, from.qdd, from.xd;
    IDAReInit(memory, from.t, y, rate);
  }
  std::string flag_name(int flag) const override {
    return take_name([](long f) { return IDAGetReturnFlagName(f); }, flag);
  }
  double last_step() const override {
    double h = 0;
    IDAGetLastStep(memory, &h);
    return h;
  }
  void* memory = nullptr;
  N_Vector rate = nullptr, is_differential = nullptr;
  SUNMatrix matrix = nullptr;
  SUNLinearSolver linear = nullptr;
  VectorXd r;
};

RungeKutta::RungeKutta(System& system, State state, const AdaptiveOptions& options)
    : AdaptiveIntegrator(system, consistent(system, std::move(state))) {
  backend_ = std::make_unique<RungeKuttaBackend>(system, state_, options);
}

Cvode::Cvode(System& system, State state, const AdaptiveOptions& options, Method method)
    : AdaptiveIntegrator(system, consistent(system, std::move(state))) {
  backend_ = std::make_unique<CvodeBackend>(system, state_, options, method);
}

Ida::Ida(System& system, State state, const AdaptiveOptions& options)
    : AdaptiveIntegrator(system, consistent(system, std::move(state))) {
  backend_ = std::make_unique<IdaBackend>(system, state_, options);
}

}  // namespace easydyn

#include <ida/ida.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include "easydyn/sim/adaptive_backend.hpp"

namespace easydyn {

using Eigen::VectorXd;

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

Ida::Ida(System& system, State state, const AdaptiveOptions& options)
    : AdaptiveIntegrator(system, consistent(system, std::move(state))) {
  backend_ = std::make_unique<IdaBackend>(system, state_, options);
}

}  // namespace easydyn

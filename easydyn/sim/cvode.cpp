#include <cvode/cvode.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include "easydyn/sim/adaptive_backend.hpp"

namespace easydyn {

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

Cvode::Cvode(System& system, State state, const AdaptiveOptions& options, Method method)
    : AdaptiveIntegrator(system, consistent(system, std::move(state))) {
  backend_ = std::make_unique<CvodeBackend>(system, state_, options, method);
}

}  // namespace easydyn

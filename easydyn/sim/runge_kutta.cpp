#include <arkode/arkode_erkstep.h>

#include <cmath>

#include "easydyn/sim/adaptive_backend.hpp"

namespace easydyn {

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

RungeKutta::RungeKutta(System& system, State state, const AdaptiveOptions& options)
    : AdaptiveIntegrator(system, consistent(system, std::move(state))) {
  backend_ = std::make_unique<RungeKuttaBackend>(system, state_, options);
}

}  // namespace easydyn

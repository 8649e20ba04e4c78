// Speed of a passage: one Newmark step of the tram on its track, against one banded substitution of the same
// matrix in the same run.

#include <benchmark/benchmark.h>

#include "easydyn/easydyn.hpp"
#include "easydyn/sim/banded_cholesky.hpp"
#include "track/wheel_rail_contact.hpp"
#include "vehicles/planar_vehicle.hpp"
#include "vehicles/t2000_like.hpp"

using namespace easydyn;

namespace {

constexpr double step = 1e-4;

class TramOnTrack : public System {
 public:
  TramOnTrack()
      : System("tram on track"),
        track(*this, track::TrackModel(track::t2000_like_track(), 177, -88.5 * 0.72)) {
    const auto profile = std::make_shared<track::StepProfile>(0, 1e-3);
    for (const vehicles::PlanarVehicle::Wheel& w : tram.wheels())
      contacts.emplace_back(w.name, track::HertzContact(1e11, w.contacts), w.radius, w.static_load, profile);
  }
  vehicles::PlanarVehicle tram{*this, vehicles::t2000_like()};
  track::FlexibleTrack track;
  std::vector<track::WheelRailContact> contacts;
  void positions() override { tram.place(-29.7 + 8.33 * time()); }
  void forces() override {
    gravity(vehicles::gravity);
    tram.apply_suspensions();
    for (std::size_t w = 0; w < contacts.size(); ++w) contacts[w].apply(*tram.wheels()[w].body, track);
  }
};

void passage_step(benchmark::State& state) {
  TramOnTrack system;
  Newmark integrator(system, solve_quasi_static_motion(system, system.initial_state(), 2e-3), {.step = step});
  for (auto _ : state) integrator.step();
  state.counters["evaluations_per_step"] = static_cast<double>(integrator.statistics().evaluations) /
                                           static_cast<double>(integrator.statistics().steps);
}
BENCHMARK(passage_step)->Name("passage_step/tram")->Iterations(20000)->Unit(benchmark::kMicrosecond);

void banded_solve(benchmark::State& state) {
  TramOnTrack system;
  const LinearStructure& s = *system.structures().front();
  const SparseMatrix A = s.M() + 0.5 * step * s.C() + 0.25 * step * step * s.K();
  const BandedCholesky factor(A, s.half_bandwidth(), s.name());
  RightHandSides X = RightHandSides::Ones(s.size(), static_cast<int>(state.range(0)));
  for (auto _ : state) {
    X.setOnes();
    factor.solve_in_place(X);
    benchmark::DoNotOptimize(X.data());
  }
}
BENCHMARK(banded_solve)->Name("banded_solve/tram/columns")->Arg(1)->Arg(8)->Unit(benchmark::kMicrosecond);

void evaluation(benchmark::State& state) {
  TramOnTrack system;
  const State s = system.initial_state();
  Eigen::VectorXd r(system.equation_count());
  for (auto _ : state)
    system.compute_body_residual(
        System::body_state(s), [](int, const PortShape&) { return PortMotion(); }, r.data());
}
BENCHMARK(evaluation)->Name("evaluation/tram")->Unit(benchmark::kMicrosecond);

}  // namespace

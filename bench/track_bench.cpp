// Speed of a passage: steps in a travelling window against one banded back-substitution of the same matrix in the same
// run, and a second of it whole.
//
// passage_step/... has the counter `per_banded_solve`: median time of a step over that of a substitution.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>

#include "easydyn/easydyn.hpp"
#include "easydyn/sim/banded_cholesky.hpp"
#include "examples/passage_program/train_on_track.hpp"
#include "track/irregularity.hpp"
#include "vehicles/t2000_like.hpp"
#include "vehicles/thalys_like.hpp"

using namespace easydyn;

namespace {

/// Unevenness of a high-speed line everywhere, as the programs have it.
std::shared_ptr<const track::Profile> rough_rail(double track_length) {
  return std::make_shared<track::Irregularity>(
      track::braun_hellenbroich(),
      track::IrregularityOptions{.begin = -track_length, .end = track_length, .seed = 1});
}

/// A passage over a rough rail, from its quasi-static start.
struct Passage {
  Passage(const vehicles::RailVehicle& vehicle, const track::TrackData& data, double speed, double window_,
          double track_length, double step_)
      : window(window_),
        step(step_),
        system(vehicle,
               track::TrackModel(data, static_cast<int>(track_length / data.sleeper_spacing),
                                 -0.5 * track_length),
               -0.25 * track_length, speed, rough_rail(track_length)) {}
  State start() { return solve_quasi_static_motion(system, system.initial_state(), 2e-3); }
  track::PassageStepper stepper() {
    return {system, system.track, system.contacts(), start(), {.step = step, .window = window}};
  }

  double window, step;
  examples::TrainOnTrack system;
};

/// thalys_like at 300 km/h: 26 contacts, 4 elements per bay.
Passage hst(double window = 260, double track_length = 600) {
  return {vehicles::thalys_like(), track::thalys_like_track(), 300 / 3.6, window, track_length, 2e-4};
}
Passage tram() {
  return {vehicles::t2000_like(), track::t2000_like_track(), 30 / 3.6, 80, 400, 1e-4};
}

/// The matrix of a window as wide as the passage's, factorised.
BandedCholesky factorise(const Passage& passage) {
  const track::TrackModel& whole = passage.system.track.model();
  const track::TrackModel model(whole.data(),
                                static_cast<int>(std::ceil(passage.window / whole.data().sleeper_spacing)));
  const double h = passage.step;
  return {model.M() + 0.5 * h * model.C() + 0.25 * h * h * model.K(), model.half_bandwidth(), "track"};
}

template <class Prepare, class Work>
double median_time(int times, Prepare prepare, Work work) {
  std::vector<double> durations;
  for (int i = 0; i < times; ++i) {
    prepare();
    const auto begin = std::chrono::steady_clock::now();
    work();
    durations.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  std::nth_element(durations.begin(), durations.begin() + times / 2, durations.end());
  return durations[static_cast<std::size_t>(times / 2)];
}

void passage_step(benchmark::State& state, Passage (*make)()) {
  Passage passage = make();
  track::PassageStepper stepper = passage.stepper();
  for (auto _ : state) stepper.step();
  state.counters["evaluations_per_step"] =
      static_cast<double>(stepper.statistics().evaluations) / static_cast<double>(stepper.statistics().steps);
  state.counters["window_MB"] = 1e-6 * static_cast<double>(stepper.window().memory());
  const BandedCholesky factor = factorise(passage);
  Eigen::VectorXd x(factor.size());
  const double step = median_time(
                   300, [] {}, [&] { stepper.step(); }),
               solve = median_time(
                   300, [&] { x.setOnes(); },
                   [&] {
                     factor.solve_in_place(x.data());
                     benchmark::DoNotOptimize(x.data());
                   });
  state.counters["per_banded_solve"] = step / solve;
}
BENCHMARK_CAPTURE(passage_step, hst, [] { return hst(); })
    ->Name("passage_step/hst")
    ->Iterations(2000)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(passage_step, tram, tram)
    ->Name("passage_step/tram")
    ->Iterations(5000)
    ->Unit(benchmark::kMicrosecond);
// Twice the window: cost in proportion; thrice the track: the same cost.
BENCHMARK_CAPTURE(passage_step, hst_window_520, [] { return hst(520, 1800); })
    ->Name("passage_step/hst/window_520")
    ->Iterations(2000)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(passage_step, hst_track_1800, [] { return hst(260, 1800); })
    ->Name("passage_step/hst/track_1800")
    ->Iterations(2000)
    ->Unit(benchmark::kMicrosecond);

void banded_solve(benchmark::State& state, Passage (*make)()) {
  const BandedCholesky factor = factorise(make());
  Eigen::VectorXd x(factor.size());
  for (auto _ : state) {
    x.setOnes();
    factor.solve_in_place(x.data());
    benchmark::DoNotOptimize(x.data());
  }
  state.counters["unknowns"] = factor.size();
  state.counters["half_bandwidth"] = factor.half_bandwidth();
}
BENCHMARK_CAPTURE(banded_solve, hst, [] { return hst(); })
    ->Name("banded_solve/hst")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(banded_solve, tram, tram)->Name("banded_solve/tram")->Unit(benchmark::kMicrosecond);

void evaluation(benchmark::State& state, Passage (*make)()) {
  Passage passage = make();
  const State s = passage.system.initial_state();
  Eigen::VectorXd r(passage.system.equation_count());
  for (auto _ : state)
    passage.system.compute_body_residual(
        System::body_state(s), [](int, const PortShape&) { return PortMotion(); }, r.data());
}
BENCHMARK_CAPTURE(evaluation, hst, [] { return hst(); })
    ->Name("evaluation/hst")
    ->Unit(benchmark::kMicrosecond);

void one_second(benchmark::State& state) {
  double memory = 0;
  for (auto _ : state) {
    state.PauseTiming();
    Passage passage = hst();
    track::PassageStepper stepper = passage.stepper();
    state.ResumeTiming();
    for (int i = 0; i < 5000; ++i) stepper.step();
    memory = 1e-6 * static_cast<double>(stepper.window().memory());
  }
  state.counters["window_MB"] = memory;
}
BENCHMARK(one_second)->Name("passage/hst_one_second")->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace

// Cost of a time step of the ground (soil/wave_engine.hpp) against the memory bandwidth of the machine.
//
//   dof_per_second   3 x nodes x steps / s, all threads of the run
//   dof_per_cpu_second   the same per second of processor time, waiting threads included
//   bytes_per_dof    memory of the fields per degree of freedom
//   roofline_fraction  dof_per_second over what the memory allows: the bandwidth of a triad with as many threads, measured
//                    before and after each benchmark, over the bytes that a step must move (every field once in, once
//                    out); 1 would be a kernel that costs nothing but the memory's time
//   triad_bytes_per_second  that bandwidth, stores counted once
//
// On a shared machine compare roofline_fraction, not times.
//
// train_superposition: 401 sleepers, 5 receivers and 5 s of train up to 80 Hz on a layered ground, from the site and the
// loads to the ground motion (soil/layered).
//
//   cpu_seconds         processor time of all threads
//   mobility_seconds    of the time, that of the impulse responses; superposition_seconds the rest

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <thread>
#include <vector>

#include "soil/layered/layered_mobility.hpp"
#include "soil/layered/superposition.hpp"
#include "soil/relaxation.hpp"
#include "soil/wave_engine.hpp"

namespace {

using namespace easydyn::soil;

/// Processor time of all threads [s]; on a shared machine it says more than the clock on the wall.
double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// a = b + s c with arrays far larger than any cache, shared out among threads.
class Triad {
 public:
  static Triad& get() {
    static Triad triad;
    return triad;
  }
  void run(int threads) {
    std::vector<std::thread> team;
    for (int t = 0; t < threads; ++t) {
      team.emplace_back([this, t, threads] {
        for (std::size_t i = size_ * t / threads; i < size_ * (t + 1) / threads; ++i)
          a_[i] = b_[i] + 3.0f * c_[i];
      });
    }
    for (std::thread& thread : team) thread.join();
    benchmark::ClobberMemory();
  }
  double bytes() const { return 3.0 * sizeof(float) * static_cast<double>(size_); }
  /// Seconds of `rounds` rounds are added to `samples`.
  void sample(int threads, int rounds, std::vector<double>& samples) {
    for (int round = 0; round < rounds; ++round) {
      const auto start = std::chrono::steady_clock::now();
      run(threads);
      samples.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
  }

 private:
  static constexpr std::size_t size_ = std::size_t{1} << 25;
  std::vector<float> a_ = std::vector<float>(size_, 0.0f), b_ = std::vector<float>(size_, 1.0f),
                     c_ = std::vector<float>(size_, 2.0f);
};

double median(std::vector<double> samples) {
  std::nth_element(samples.begin(), samples.begin() + samples.size() / 2, samples.end());
  return samples[samples.size() / 2];
}

/// About 2 million degrees of freedom: 46 x (80 / degree) x (48 / degree) elements of 1.5 m.
Lattice make_box(int degree) {
  Lattice lattice;
  lattice.degree = degree;
  lattice.half_model = true;
  for (int i = 0; i <= 46; ++i) lattice.x.push_back(1.5 * i);
  for (int i = 0; i <= 80 / degree; ++i) lattice.y.push_back(1.5 * i);
  for (int i = 48 / degree; i >= 0; --i) lattice.z.push_back(-1.5 * i);
  lattice.z.back() = 0;
  lattice.layer.assign(lattice.nz(), 1);
  lattice.layer.back() = 0;
  return lattice;
}

template <class T>
void run_steps(benchmark::State& state, int degree, int mechanisms) {
  const int threads = static_cast<int>(state.range(0));
  const Lattice lattice = make_box(degree);
  const Relaxation body = fit_relaxation(0.03, 2, 62, 20, mechanisms);
  const std::vector<double> weights(body.weights.data(), body.weights.data() + mechanisms);
  const std::vector<double> rates(body.rates.data(), body.rates.data() + mechanisms);
  const std::vector<EngineMaterial> materials{{5.3e7, 2.3e7, 1900, 0, weights},
                                              {3.2e8, 1.4e8, 1900, 0, weights}};
  WaveEngine<T> engine(lattice, materials, rates, {}, threads);
  engine.set_time_step(1e-4);
  const int X = engine.nodes_x() / 2;
  for (int step = 0; step < 20; ++step) engine.advance({{X, 0, -1e3}}, false);
  std::vector<double> triad_seconds;
  Triad::get().sample(threads, 5, triad_seconds);
  engine.advance({{X, 0, -1e3}}, false);
  const auto begin = std::chrono::steady_clock::now();
  const double start = cpu_seconds();
  for (auto _ : state) engine.advance({{X, 0, -1e3}}, false);
  const double used = cpu_seconds() - start;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  Triad::get().sample(threads, 5, triad_seconds);
  const double bandwidth = Triad::get().bytes() / median(triad_seconds);
  state.counters["dof_per_second"] =
      benchmark::Counter(static_cast<double>(lattice.dofs()), benchmark::Counter::kIsIterationInvariantRate);
  const double steps = static_cast<double>(state.iterations());
  state.counters["dof_per_cpu_second"] = steps * static_cast<double>(lattice.dofs()) / used;
  const double moved = 2.0 * (2 + mechanisms) * sizeof(T);  // u, v and the memory variables, in and out
  state.counters["roofline_fraction"] =
      steps * static_cast<double>(lattice.dofs()) / seconds / (bandwidth / moved);
  state.counters["triad_bytes_per_second"] = bandwidth;
  state.counters["bytes_per_dof"] =
      WaveEngine<T>::compute_memory(lattice, mechanisms) / static_cast<double>(lattice.dofs());
}

void step_float(benchmark::State& state, int degree, int mechanisms) {
  run_steps<float>(state, degree, mechanisms);
}
void step_double(benchmark::State& state, int degree, int mechanisms) {
  run_steps<double>(state, degree, mechanisms);
}

void triad(benchmark::State& state) {
  const int threads = static_cast<int>(state.range(0));
  std::vector<double> seconds;
  Triad::get().sample(threads, 5, seconds);
  const auto begin = std::chrono::steady_clock::now();
  for (auto _ : state) Triad::get().run(threads);
  const double used = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  Triad::get().sample(threads, 5, seconds);
  // What the memory allows the elastic step in single precision: u and v, in and out.
  const double bytes = Triad::get().bytes(), moved = 16;
  state.counters["triad_bytes_per_second"] =
      benchmark::Counter(bytes, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["dof_per_second"] =
      benchmark::Counter(bytes / moved, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["bytes_per_dof"] = moved;
  state.counters["roofline_fraction"] =  // of itself: how even the minute was
      static_cast<double>(state.iterations()) * bytes / used / (bytes / median(seconds));
}

/// 5 m of 150 m/s on 300 m/s, receivers beside the middle of 240 m of track.
Site make_site() {
  Site site;
  site.layers = {{"soft", 5, 1800, 150, 300, 0.03, ""}, {"stiff", 0, 1900, 300, 600, 0.03, ""}};
  for (const double y : {4, 8, 16, 24, 32}) site.receivers.push_back({"", {0, y, 0}});
  site.highest_frequency = 80;
  site.damping_frequency = 30;
  site.taper_length = 0;
  site.duration = 5;
  return site;
}

/// Four axles, 50 kN each, at 40 m/s with some roughness, on 401 sleepers; 5 s at 500 Hz.
SurfaceLoads make_train() {
  SurfaceLoads loads;
  for (int j = 0; j < 401; ++j) loads.footprints.push_back({0.6 * j - 120, 0, 0.3, 2.5});
  loads.time = Eigen::VectorXd::LinSpaced(2501, 0, 5);
  loads.force.resize(2501, 401);
  for (Eigen::Index j = 0; j < 401; ++j) {
    for (Eigen::Index i = 0; i < 2501; ++i) {
      double force = 0;
      for (const double axle : {0.0, 2.5, 15.0, 17.5}) {
        const double t = loads.time(i), place = (40 * t - 100 + axle - loads.footprints[j].x) / 0.7;
        force += 2e4 * (1 + 0.2 * std::sin(150 * t + axle)) * std::exp(-place * place);
      }
      loads.force(i, j) = force;
    }
  }
  return loads;
}

void train_superposition(benchmark::State& state) {
  const int threads = static_cast<int>(state.range(0));
  const Site site = make_site();
  const SurfaceLoads loads = make_train();
  const double start = cpu_seconds();
  double mobility_seconds = 0, superposition_seconds = 0, moved = 0;
  std::vector<double> triad_seconds;
  Triad::get().sample(threads, 5, triad_seconds);
  for (auto _ : state) {
    const auto begin = std::chrono::steady_clock::now();
    Mobility mobility = list_distances(loads.footprints, site.receivers);
    update_mobility(LayeredGround(site, GroundDamping::maxwell_body), site.highest_frequency, mobility, 0,
                    threads);
    const auto middle = std::chrono::steady_clock::now();
    const GroundMotion motion = superpose(mobility, site, loads, {.threads = threads});
    mobility_seconds += std::chrono::duration<double>(middle - begin).count();
    superposition_seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - middle).count();
    moved = 8.0 *
            static_cast<double>(loads.force.size() + motion.vx.size() + motion.vy.size() + motion.vz.size() +
                                motion.footprint_displacement.size() + mobility.hx.size() +
                                mobility.hy.size() + mobility.hz.size() + mobility.mean.size());
  }
  Triad::get().sample(threads, 5, triad_seconds);
  const double runs = static_cast<double>(state.iterations());
  // A degree of freedom: a sample of one component at one receiver, or of the displacement under one footprint. Roofline:
  // loads and responses read, motion written once.
  const double dofs = 2501.0 * (3 * 5 + 401), seconds = (mobility_seconds + superposition_seconds) / runs;
  state.counters["dof_per_second"] = dofs / seconds;
  state.counters["bytes_per_dof"] = moved / dofs;
  state.counters["roofline_fraction"] = moved / seconds / (Triad::get().bytes() / median(triad_seconds));
  state.counters["cpu_seconds"] = (cpu_seconds() - start) / runs;
  state.counters["mobility_seconds"] = mobility_seconds / runs;
  state.counters["superposition_seconds"] = superposition_seconds / runs;
}

void use_threads(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgName("threads")->Arg(1);
  if (std::thread::hardware_concurrency() > 1)
    benchmark->Arg(static_cast<int>(std::thread::hardware_concurrency()));
  benchmark->UseRealTime()->Unit(benchmark::kMillisecond);
}

BENCHMARK_CAPTURE(step_float, degree4, 4, 0)->Name("elastic_step/degree4/float")->Apply(use_threads);
BENCHMARK_CAPTURE(step_float, degree5, 5, 0)->Name("elastic_step/degree5/float")->Apply(use_threads);
BENCHMARK_CAPTURE(step_float, degree6, 6, 0)->Name("elastic_step/degree6/float")->Apply(use_threads);
BENCHMARK_CAPTURE(step_double, degree4, 4, 0)->Name("elastic_step/degree4/double")->Apply(use_threads);
BENCHMARK_CAPTURE(step_float, damped4, 4, 3)->Name("damped_step/degree4/float")->Apply(use_threads);
BENCHMARK(triad)->Apply(use_threads);
BENCHMARK(train_superposition)->Apply(use_threads);

}  // namespace

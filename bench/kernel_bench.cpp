// Speed of the kernel: mass matrix and bias of serial chains, residual and steps of a chain.
// Ratios to `reference_loop` of the same run compare machines.

#include <benchmark/benchmark.h>

#include <cmath>
#include <numeric>

#include "easydyn/easydyn.hpp"

using namespace easydyn;

namespace {

// A fixed amount of dependent floating-point work.
void reference_loop(benchmark::State& state) {
  for (auto _ : state) {
    double x = 0.5;
    for (int i = 0; i < 1000; ++i) x = 3.9 * x * (1 - x);
    benchmark::DoNotOptimize(x);
  }
}
BENCHMARK(reference_loop);

// n links on revolute joints about alternating axes.
class Chain : public System {
 public:
  explicit Chain(int n) : System("chain") {
    for (int i = 0; i < n; ++i) {
      q_.push_back(coordinate("q" + std::to_string(i), 0.3 + 0.1 * i, 0.2));
      links_.push_back(&body("link " + std::to_string(i), Inertia::box(1, 0.1, 0.1, 0.5)));
    }
  }
  void positions() override {
    Frame frame;
    for (std::size_t i = 0; i < links_.size(); ++i) {
      frame = frame * (i % 2 ? rotate_x(q_[i]) : rotate_y(q_[i]));
      *links_[i] = frame * translate(0, 0, -0.25);
      frame = frame * translate(0, 0, -0.5);
    }
  }
  void forces() override { gravity(); }

 private:
  std::vector<Coordinate> q_;
  std::vector<Body*> links_;
};

void mass_matrix_and_bias(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  Chain chain(n);
  const State s = chain.initial_state();
  Eigen::MatrixXd M(n, n);
  Eigen::VectorXd bias(n);
  for (auto _ : state) {
    chain.compute_mass_and_bias(s, M, bias);
    benchmark::DoNotOptimize(M.data());
    benchmark::DoNotOptimize(bias.data());
  }
}
BENCHMARK(mass_matrix_and_bias)->Name("mass_matrix_and_bias/chain")->Arg(6)->Arg(12)->Arg(36)->Arg(72);

void residual(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  Chain chain(n);
  const State s = chain.initial_state();
  Eigen::VectorXd r(n);
  for (auto _ : state) {
    chain.compute_residual(s, r);
    benchmark::DoNotOptimize(r.data());
  }
}
BENCHMARK(residual)->Name("residual/chain")->Arg(6)->Arg(36);

void newmark_step(benchmark::State& state) {
  Chain chain(10);
  Newmark integrator(chain, {.step = 1e-3});
  for (auto _ : state) integrator.step();
}
BENCHMARK(newmark_step)->Name("newmark_step/chain/10")->Iterations(5000);

}  // namespace

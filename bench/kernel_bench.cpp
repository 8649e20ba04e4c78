// Speed of the kernel: mass matrix and bias of serial chains and of a rail vehicle, residual and steps of a chain, and
// the whole run of a pendulum. The counter `per_reference_loop`, time over that of `reference_loop` in the same
// process, compares machines; processor time is meant.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <string>
#include <vector>

#include "easydyn/easydyn.hpp"

using namespace easydyn;

namespace {

// Processor time since a call of std::clock() [s]: what other programs take does not count.
double seconds_since(std::clock_t start) {
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

// A fixed amount of dependent floating-point work.
double run_reference_loop() {
  double x = 0.5;
  benchmark::DoNotOptimize(x);
  for (int i = 0; i < 1000; ++i) x = 3.9 * x * (1 - x);
  return x;
}

// Time of the reference loop [s], now: the shortest mean of some batches.
double reference_loop_time() {
  constexpr int batches = 5, runs = 100;
  double shortest = 1;
  for (int b = 0; b < batches; ++b) {
    const std::clock_t start = std::clock();
    for (int i = 0; i < runs; ++i) benchmark::DoNotOptimize(run_reference_loop());
    shortest = std::min(shortest, seconds_since(start) / runs);
  }
  return shortest;
}

// Times what `work` does again and again, and sets it in relation to the reference loop before and after.
template <class Work>
void measure(benchmark::State& state, const Work& work) {
  const double before = reference_loop_time();
  const std::clock_t start = std::clock();
  for (auto _ : state) work();
  const double time = seconds_since(start) / static_cast<double>(state.iterations());
  state.counters["per_reference_loop"] = time / (0.5 * (before + reference_loop_time()));
}

void reference_loop(benchmark::State& state) {
  measure(state, [] { benchmark::DoNotOptimize(run_reference_loop()); });
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

// A vehicle on two bogies, three-dimensional: 20 bodies, 30 coordinates, gravity. The car body moves freely (6), each
// bogie frame against the car body (5, all but forward), each wheelset against its bogie frame (lateral, yaw, spin);
// on each axle two boxes that do not spin, above each axle a motor in the bogie frame; on the roof a pantograph with
// the angle of its arm, which carries its one body, and the pitch of the head. Bogies and wheelsets share the
// motions before them: the longest way from the ground to a body has 14.
class RailVehicle : public System {
 public:
  RailVehicle() : System("rail vehicle") {
    for (std::size_t b = 0; b < 2; ++b) {
      const std::string name = "bogie " + std::to_string(b);
      bogies_.push_back({motion(name, {"y", "z", "yaw", "pitch", "roll"}),
                         &body(name, Inertia(3000, 1500, 2500, 3500)),
                         {}});
      for (const double x : {1.25, -1.25}) {
        const std::string axle = name + (x > 0 ? " front axle" : " rear axle");
        bogies_[b].axles.push_back(
            {x,
             motion(axle, {"y", "yaw", "spin"}),
             &body(axle, Inertia::cylinder_y(1200, 0.46, 1.5)),
             {&body(axle + " left box", Inertia(120, 4)), &body(axle + " right box", Inertia(120, 4))},
             &body(axle + " motor", Inertia(800, 60, 90, 80))});
      }
    }
  }
  void positions() override {
    const Frame car = translate(car_q_[0], car_q_[1], car_q_[2]) * rotate_z(car_q_[3]) * rotate_y(car_q_[4]) *
                      rotate_x(car_q_[5]);
    car_ = car;
    for (std::size_t b = 0; b < 2; ++b) {
      const Bogie& bogie = bogies_[b];
      const auto& q = bogie.q;
      const Frame frame = car * translate(b == 0 ? 9.5 : -9.5, q[0], q[1] - 1.2) * rotate_z(q[2]) *
                          rotate_y(q[3]) * rotate_x(q[4]);
      *bogie.frame = frame;
      for (const Axle& axle : bogie.axles) {
        const Frame beam = frame * translate(axle.x, axle.q[0], -0.1) * rotate_z(axle.q[1]);
        *axle.wheelset = beam * rotate_y(axle.q[2]);
        *axle.boxes[0] = beam * translate(0, 1.0, 0);
        *axle.boxes[1] = beam * translate(0, -1.0, 0);
        *axle.motor = frame * translate(0.6 * axle.x, 0, 0.2);
      }
    }
    pantograph_ =
        car * translate(6, 0, 2) * rotate_y(panto_q_[0]) * translate(-1.5, 0, 0.8) * rotate_y(panto_q_[1]);
  }
  void forces() override { gravity(); }

 private:
  std::vector<Coordinate> motion(const std::string& of, std::initializer_list<const char*> names) {
    std::vector<Coordinate> q;
    for (const char* name : names) {
      const double value = 0.02 * (1 + size() % 5);
      q.push_back(coordinate(of + " " + name, value, 10 * value));
    }
    return q;
  }
  struct Axle {
    double x;
    std::vector<Coordinate> q;
    Body* wheelset;
    std::array<Body*, 2> boxes;
    Body* motor;
  };
  struct Bogie {
    std::vector<Coordinate> q;
    Body* frame;
    std::vector<Axle> axles;
  };
  std::vector<Coordinate> car_q_ = motion("car", {"x", "y", "z", "yaw", "pitch", "roll"});
  Body& car_ = body("car", Inertia(32000, 57000, 1.83e6, 1.8e6));
  std::vector<Bogie> bogies_;
  std::vector<Coordinate> panto_q_ = motion("pantograph", {"arm", "head"});
  Body& pantograph_ = body("pantograph", Inertia(60, 8, 12, 15));
};

void mass_matrix_and_bias(benchmark::State& state, System& system) {
  const int n = system.size();
  const State s = system.initial_state();
  Eigen::MatrixXd M(n, n);
  Eigen::VectorXd bias(n);
  measure(state, [&] {
    system.compute_mass_and_bias(s, M, bias);
    benchmark::DoNotOptimize(M.data());
    benchmark::DoNotOptimize(bias.data());
  });
}

void mass_matrix_and_bias_of_vehicle(benchmark::State& state) {
  RailVehicle vehicle;
  mass_matrix_and_bias(state, vehicle);
}
BENCHMARK(mass_matrix_and_bias_of_vehicle)->Name("mass_matrix_and_bias/rail_vehicle");

void mass_matrix_and_bias_of_chain(benchmark::State& state) {
  Chain chain(static_cast<int>(state.range(0)));
  mass_matrix_and_bias(state, chain);
}
BENCHMARK(mass_matrix_and_bias_of_chain)
    ->Name("mass_matrix_and_bias/chain")
    ->Arg(6)
    ->Arg(12)
    ->Arg(36)
    ->Arg(72);

void residual(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  Chain chain(n);
  const State s = chain.initial_state();
  Eigen::VectorXd r(n);
  measure(state, [&] {
    chain.compute_residual(s, r);
    benchmark::DoNotOptimize(r.data());
  });
}
BENCHMARK(residual)->Name("residual/chain")->Arg(6)->Arg(36);

// Ten rods of 1 m on hinges about y, in a row, released from rest at 30 degrees to the vertical.
class Pendulum : public System {
 public:
  Pendulum() : System("pendulum") {
    for (std::size_t i = 0; i < 10; ++i) {
      q_.push_back(coordinate("q" + std::to_string(i), i == 0 ? 0.5235987755982988 : 0.0));
      rods_.push_back(&body("rod " + std::to_string(i), Inertia::rod_z(1, 1)));
    }
  }
  void positions() override {
    Frame hinge;
    for (std::size_t i = 0; i < rods_.size(); ++i) {
      const Frame rod = hinge * rotate_y(q_[i]);
      *rods_[i] = rod * translate(0, 0, -0.5);
      hinge = rod * translate(0, 0, -1);
    }
  }
  void forces() override { gravity(); }

 private:
  std::vector<Coordinate> q_;
  std::vector<Body*> rods_;
};

// One iteration is the whole run: 10 s at relative and absolute tolerances of 1e-6, by the integrator that is fastest
// there (RungeKutta needs twice the evaluations).
void pendulum_10_links(benchmark::State& state) {
  Pendulum pendulum;
  long evaluations = 0;
  measure(state, [&] {
    Cvode integrator(pendulum, {.relative_tolerance = 1e-6, .absolute_tolerance = 1e-6},
                     Cvode::Method::adams);
    integrator.advance(10);
    evaluations = integrator.statistics().evaluations;
  });
  state.counters["evaluations"] = static_cast<double>(evaluations);
}
BENCHMARK(pendulum_10_links)->Unit(benchmark::kMillisecond);

void newmark_step(benchmark::State& state) {
  Chain chain(10);
  Newmark integrator(chain, {.step = 1e-3});
  measure(state, [&] { integrator.step(); });
}
BENCHMARK(newmark_step)->Name("newmark_step/chain/10")->Iterations(5000);

}  // namespace

#pragma once
// Private to soil: shared by wave_solver.cpp (how a run is set up) and wave_run.cpp (how it goes).

#include <chrono>
#include <limits>
#include <memory>
#include <vector>

#include "soil/energy_guard.hpp"
#include "soil/load_history.hpp"
#include "soil/run_identity.hpp"
#include "soil/snapshot_writer.hpp"
#include "soil/surface_interpolation.hpp"
#include "soil/wave_engine.hpp"
#include "soil/wave_solver.hpp"

namespace easydyn::soil {

inline double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

inline int component_of(LoadDirection direction) {
  return direction == LoadDirection::x ? 0 : direction == LoadDirection::y ? 1 : 2;
}

/// Where a run stands between two steps, beside its fields and records.
struct RunPosition {
  long step = 0;  // the next one
  EnergyGuard guard;
};

/// What is asked for between two steps.
struct RunWish {
  bool stop = false, save = false;
};

struct WaveSolver::Impl {
  /// @param far_frequency  see LatticeOptions
  /// @param start_         time of the first output [s]; NaN: that of the first load
  Impl(const Site& site_, const SurfaceLoads& given, const SolverOptions& options_, Ranks* ranks_,
       double far_frequency = 0, double start_ = std::numeric_limits<double>::quiet_NaN());

  void update_surface_forces(double t);
  void check_nodes_are_in_the_ground();
  void keep_nodes_of_this_rank();
  template <class Read>
  double weigh(const std::vector<NodeWeight>& nodes, Read read) const {
    double sum = 0;
    for (const NodeWeight& n : nodes) sum += n.weight * read(n);
    return sum;
  }
  template <class F>
  decltype(auto) with_engine(F&& f) {
    return double_engine ? f(*double_engine) : f(*float_engine);
  }
  template <class T>
  GroundMotion run(WaveEngine<T>& engine, const RunControl& control);
  GroundMotion run(const RunControl& control);
  double measure_step();  // [s] of wall clock
  GroundMotion make_motion() const;
  template <class T>
  void add_velocities(WaveEngine<T>& engine, Eigen::Index row, GroundMotion& motion) const;
  template <class T>
  double compute_power(const WaveEngine<T>& engine) const;  ///< of the surface forces [W]
  /// Gives the guard the work that was done on all ranks since the last time.
  void settle_work(RunPosition& position);
  void check_energy(const EnergyGuard& guard, double energy, double kinetic_energy, long step) const;
  RunWish agree_on(RunWish wish) const;
  double compute_checkpoint_size();
  template <class T>
  void save(const RunControl& control, WaveEngine<T>& engine, GroundMotion& motion,
            RunPosition position) const;
  template <class T>
  RunPosition read_checkpoint(const std::filesystem::path& path, WaveEngine<T>& engine,
                              GroundMotion& motion) const;
  template <class T>
  RunPosition load(const RunControl& control, WaveEngine<T>& engine, GroundMotion& motion) const;

  Site site;
  SolverOptions options;
  Ranks* ranks;  // nullptr: this one alone
  int rank;
  Lattice lattice;
  LoadHistory history;
  std::vector<FootprintWeights> footprints;
  std::vector<LoadDirection> directions;
  std::vector<std::vector<NodeWeight>> observed;
  bool odd_x = false, odd_y = false;
  std::vector<ReceiverWeights> receivers;
  Eigen::VectorXd taper, forces;
  std::vector<SurfaceNodeForce> node_forces;
  std::unique_ptr<WaveEngine<float>> float_engine;
  std::unique_ptr<WaveEngine<double>> double_engine;
  double dt = 0, output_step = 0, memory = 0, layer_memory = 0;
  double start = 0;  // time of the first output
  long steps_per_output = 1, outputs = 0, preload_outputs = 0;
  std::unique_ptr<Impl> low;  // what is below the crossover, if there is one
  bool is_low_part = false;   // of another one
  double seconds_per_step = 0;
  std::vector<double> unsettled_work;  // [J] of this rank's nodes, step by step
  RunIdentity identity;
  std::unique_ptr<SnapshotWriter> snapshots;

  long steps() const { return (preload_outputs + outputs - 1) * steps_per_output + 1; }
  double time_of(long step) const {
    return start - static_cast<double>(preload_outputs) * output_step + static_cast<double>(step) * dt;
  }
  /// Rows of the output that the first `step` steps have filled.
  Eigen::Index rows_before(long step) const {
    return std::max(0L, (step + steps_per_output - 1) / steps_per_output - preload_outputs);
  }
};

}  // namespace easydyn::soil

#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "soil/absorbing_boundary.hpp"
#include "soil/lattice.hpp"
#include "soil/run_control.hpp"
#include "soil/site.hpp"
#include "soil/surface_loads.hpp"

namespace easydyn::soil {

class Ranks;

/// How material damping is modelled; Layer::damping is the ratio at Site::damping_frequency in all of them.
enum class DampingModel {
  none,
  stiffness_proportional,  ///< K (u + beta v), beta = damping / (pi f): ratio grows with frequency, small
                           ///< step
  constant_ratio  ///< memory variables: ratio nearly constant from a fortieth of the highest frequency to
                  ///< it, step nearly as undamped; cs and cp hold at damping_frequency (relaxation.hpp)
};

/// What the solver may be told; the defaults suit railway vibration.
struct SolverOptions {
  int degree = 4;              ///< polynomial degree, 3..6
  bool half_model = true;      ///< only y >= 0; loads on the axis, all along y or none of them
  bool quarter_model = false;  ///< only x >= 0 and y >= 0; one load, at the origin
  double step_safety = 0.95;   ///< time step / stable limit, 0..1
  int threads = 0;             ///< 0: one per core, fewer for a small model
  /// Takes the time error of the leapfrog away, from loads and records, not from snapshots (time_error.hpp).
  bool corrects_time_error = false;
  double output_step = 0;         ///< [s]; 0: a few steps, at most 1 / (10 highest_frequency)
  bool double_precision = false;  ///< of the fields (sums are always double)
  DampingModel damping = DampingModel::constant_ratio;
  double preload_time = 0.5;  ///< [s] before the first load sample, over which loads that start non-zero
                              ///< are brought in smoothly; not part of the output
  /// What stands in the elements at the edge. A matched layer stretches the coordinates across it by s = 1 + d / (i w + alpha),
  /// d = layer_strength x c_p of the half-space / length x (distance / length)^2: the perfectly matched layer of the
  /// literature (Komatitsch and Martin 2007; Kucukcoban and Kallivokas; Fathi, Poursartip and Kallivokas 2015), here
  /// a weak one, for half the elements of the sponge (matched_layer.hpp, docs/soil_boundary.md).
  /// Not with a crossover frequency, nor on every site (matched_layer_limits.hpp); GroundMotion::energy stays empty.
  AbsorbingBoundary boundary = AbsorbingBoundary::sponge;
  double layer_strength = 5;  ///< >= 0; at 10 and more the motion can grow
  double layer_alpha = 20;    ///< [1/s] > 0
  int sponge_elements =
      -1;  ///< of the sponge or the layer, see LatticeOptions; -1: as many as make it 8 (the layer 4)
           ///< elements deep at 5.5 points per wavelength and degree 4, so that a finer mesh keeps the
           ///< depth
  double sponge_growth =
      1.1;  ///< 1.15 sends three times as much back: waves meet elements too coarse for them
  double sponge_strength =
      12;  ///< damping at the outer edge of the sponge x its length / cs of the half-space
  /// > 0: what the loads hold below about this frequency [Hz] runs on a lattice of its own, coarse away from the
  /// loads, whose sponge is longer in the same proportion; both motions are added. See docs/soil_boundary.md.
  double crossover_frequency = 0;
  bool dashpots = true;     ///< viscous dashpots (Stacey) and far-field springs on the outer faces
  double memory_limit = 0;  ///< [byte]; 0: 0.8 of the memory of the machine
  /// Footprints without a load whose mean displacement, downward, is recorded after that of the loaded ones; anywhere,
  /// all loads vertical.
  std::vector<Footprint> observed = {};
};

/// What a run will cost, known before it starts.
struct RunSummary {
  long elements = 0, nodes = 0, dofs = 0;
  double memory = 0;          ///< [byte] of fields, tables and what a crossover or a matched layer adds
  long layer_elements = 0;    ///< of a matched layer
  double layer_memory = 0;    ///< [byte] of its states
  double time_step = 0;       ///< [s]
  double output_step = 0;     ///< [s]
  double checkpoint = 0;      ///< [byte] of the file
  double snapshots = 0;       ///< [byte] of all files
  std::string snapshot_text;  ///< what they show, a line for each plane
  long steps = 0;
  int ranks_y = 1, ranks_z = 1;  ///< blocks of the lattice along y and z, one for each rank
  int threads = 1;               ///< of each rank
  double halo = 0;               ///< [byte] that the rank with the most neighbours receives in a step
  double expected_time = 0;      ///< [s] wall clock, from a short timing of the real kernel, all lattices
};

/// Result of a run: nt output times, nr receivers, nl footprints.
struct GroundMotion {
  Eigen::VectorXd time;                    ///< nt [s]
  Eigen::MatrixXd vx, vy, vz;              ///< nt x nr [m/s], z up
  Eigen::MatrixXd footprint_displacement;  ///< nt x nl [m], mean over each footprint, along its load; then
                                           ///< those of SolverOptions::observed
  Eigen::VectorXd taper;                   ///< nl: factor on each load
  Eigen::VectorXd energy;                  ///< nt [J] kinetic + u . K w / 2 (w below; strain energy where
                                           ///< undamped), of the half or the quarter model if one; empty
                                           ///< with a crossover or a matched layer
};

/// Waves in a layered half-space with blocks under surface loads: 3D spectral elements, explicit leapfrog.
///
///   M u.. + C u. + K w = sum_j F_j(t) p_j,    w = u (elastic), u + beta u. or u - sum_l y_l zeta_l (damped)
///
/// M diagonal (GLL quadrature), C sponge and dashpots, p_j uniform traction over footprint j. Loads along y on the
/// axis y = 0 move the ground antisymmetrically about it, the others symmetrically; the half model can hold one
/// kind at a time, the quarter model one load.
/// Nothing above Site::highest_frequency is claimed: outputs are decimated without a filter because the loads
/// are expected to be limited by limit_band(): unchanged up to that frequency, zero from 1.25 times it.
class WaveSolver {
 public:
  /// @throws ModelError if site, loads or options are out of range, a receiver or footprint is outside the
  ///         undamped ground or in an open block, loads of both kinds meet in the half model, the fields do not fit in memory, or
  ///         a matched layer is refused (matched_layer_limits.hpp)
  /// @param ranks  that share the ground and call every function of the solver together; nullptr: this process alone
  WaveSolver(const Site& site, const SurfaceLoads& loads, const SolverOptions& options = {},
             Ranks* ranks = nullptr);
  ~WaveSolver();
  WaveSolver(WaveSolver&&) noexcept;
  WaveSolver& operator=(WaveSolver&&) noexcept;

  const Lattice& lattice() const;
  const Lattice* low_lattice() const;  ///< that of the motion below the crossover; none: nullptr
  const SolverOptions& options() const;
  double time_step() const;  ///< [s]
  long steps() const;
  /// Sizes and the expected time; times the real kernel for a fraction of a second at the first call.
  RunSummary compute_summary();

  /// Runs from rest. `progress` gets the fraction done, 0..1, at most a few times per second.
  /// @throws SolverError if the motion grows without bound (time, step and what to try)
  GroundMotion run(const std::function<void(double fraction)>& progress = {});
  /// The same with checkpoints and an end before the end. A run that goes on from a checkpoint gives the same
  /// bits as one that was never stopped.
  /// @throws RunStopped if asked to stop: the checkpoint has been written, if there is to be one
  /// @throws InputError if the checkpoint to go on from is missing, damaged or of another run, or the last one
  ///         cannot be written
  GroundMotion run(const RunControl& control);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace easydyn::soil

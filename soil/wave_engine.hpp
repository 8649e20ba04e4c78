#pragma once

#include <array>
#include <memory>
#include <vector>

#include "soil/axis_tables.hpp"
#include "soil/block_tables.hpp"
#include "soil/boundary_tables.hpp"
#include "soil/element_operator.hpp"
#include "soil/engine_material.hpp"
#include "soil/lattice.hpp"
#include "soil/matched_layer.hpp"
#include "soil/partition.hpp"
#include "soil/ranks.hpp"
#include "soil/region_plan.hpp"
#include "soil/simd.hpp"
#include "soil/thread_team.hpp"
#include "soil/tile_operator.hpp"

namespace easydyn::soil {

/// Force on a node of the surface [N], along x, y or z (upward).
struct SurfaceNodeForce {
  int X = 0, Y = 0;
  double force = 0;
  int component = 2;
};

/// Leapfrog for the waves in a lattice of layers and blocks: fields, operator, boundaries.
///
///   M (v+ - v-) / dt + C (v+ + v-) / 2 = F - K w,  u+ = u + dt v+
///   w = u + beta v-,  or  w = u - sum_l y_l zeta_l  with zeta_l. = omega_l (u - zeta_l), or w = u
///
/// C = M d (sponge, d >= 0 given per axis: the factors 1 +- d dt / 2 of the axes are multiplied) + dashpots.
/// Outer faces: dashpots rho c_p (normal) and rho c_s (tangential) per area, and springs 6 mu / ((3 - 2 nu)
/// R) and mu / R, R the distance of the face from the loads: on the axis of a point load on a half-space
/// (Boussinesq) sigma_z / u_z = 6 mu / ((3 - 2 nu) z). Without springs a static load makes the model drift.
///
/// One sweep per step, row of elements by row of elements (tile_operator.hpp): a line of nodes is advanced as
/// soon as its last row is done, so the force never reaches the memory. Threads take regions of rows; lines of
/// nodes between regions wait for all of them (region_plan.hpp).
///
/// Ranks: each holds the fields of its part of the lattice (partition.hpp); nodes are numbered as in the whole
/// lattice. A line that ranks share is advanced by each of them from the same sum of forces, so that all have the
/// same bits. One exchange per step, while the elements that do not touch it are computed.
///
/// Blocks: the sweep treats all elements of a row as of the layer's material; rows with blocks then get the
/// difference, element by element (element_operator.hpp), and their lines the ratio of the true mass to the
/// layer's. Nodes inside open blocks have no mass and stay at rest. Sponge, dashpots and springs are the layer's
/// where a block reaches the edge of the model; they take energy away or conserve it whatever the block is.
///
/// A matched layer instead of the sponge (matched_layer.hpp): rows that it fills are computed by it alone, the ends along x of
/// the others get the difference from plain elements. No block may reach into it. Estimates of the stable step and
/// compute_internal_force() leave it out: its elements are plain ones there.
template <class T>
class WaveEngine {
 public:
  WaveEngine(const Lattice& lattice, const std::vector<EngineMaterial>& materials,
             const std::vector<double>& relaxation_rates, const EngineBoundary& boundary, int threads,
             Ranks* ranks = nullptr);

  static double compute_memory(const Lattice& lattice, int memory_variables);  ///< [byte] of the fields
  static double compute_memory(const Lattice& lattice, int memory_variables,
                               const ElementBlock& part);  ///< [byte] of the fields of a rank
  /// [byte] of what a rank holds beside them: blocks, seams, what threads compute in, surface forces.
  static double compute_table_memory(const Lattice& lattice, const Partition& partition, int rank,
                                     int threads);
  double table_memory() const;  ///< [byte] the same, counted
  /// [byte] of the states of a matched layer, and of what threads compute its rows in.
  static double compute_layer_memory(const Lattice& lattice, const ElementBlock& part, int threads);
  const Partition& partition() const { return partition_; }
  const ElementBlock& part() const { return part_; }  ///< of this rank
  /// Whether this rank holds the nodes of a line; only then its functions may be asked about them.
  bool has_line(int Y, int Z) const { return first_.Y <= Y && Y <= last_.Y && first_.Z <= Z && Z <= last_.Z; }
  /// Whether the line counts as this rank's: of those that hold it, the lowest.
  bool owns_line(int Y, int Z) const {
    return has_line(Y, Z) && (Y > first_.Y || Y == 0) && (Z > first_.Z || Z == 0);
  }
  int threads() const { return team_.size(); }
  /// [byte] that this rank receives in a step.
  double halo_size() const { return static_cast<double>(received_.size() * sizeof(T)); }

  /// Largest eigenvalue of M^-1 K [1/s2] by power iteration; of M^-1 K_beta [1/s] (each layer times its beta)
  /// where `weighted`.
  double compute_largest_eigenvalue(bool weighted, int iterations = 80);
  /// Stable step [s]: dt^2 omega^2 / 4 + dt lambda_beta / 2 = 1.
  double compute_stable_step();
  void set_time_step(double dt);  ///< to be called before advance()
  double time_step() const { return dt_; }

  /// One step under the given surface forces; energies are summed if `account`.
  void advance(const std::vector<SurfaceNodeForce>& forces, bool account);
  /// Kinetic + strain energy half a step after the last step with `account` [J], of the lines that this rank owns; NaN
  /// or inf if unstable. With a matched layer only the kinetic energy outside it: the rest is not known.
  double energy() const { return energy_; }
  /// The kinetic part of it. An unstable step keeps the sum, with a strain energy below zero, but not its parts.
  double kinetic_energy() const { return kinetic_energy_; }
  /// Work of the surface forces over the last step with `account` [J].
  double step_work() const { return step_work_; }

  double displacement(int component, int X, int Y, int Z) const { return u_[index(component, X, Y, Z)]; }
  double velocity(int component, int X, int Y, int Z) const { return v_[index(component, X, Y, Z)]; }
  void set_displacement(int component, int X, int Y, int Z, double value) {
    u_[index(component, X, Y, Z)] = static_cast<T>(value);
  }
  void set_to_rest();
  /// Calls use(data, bytes) for each field that a step takes over from the one before it.
  template <class Use>
  void visit_state(const Use& use) {
    const auto visit = [&](AlignedVector<T>& field) { use(field.data(), field.size() * sizeof(T)); };
    visit(u_);
    visit(v_);
    for (AlignedVector<T>& zeta : zeta_) visit(zeta);
    if (layer_) layer_->visit_state(use);
  }
  /// f = K u with the present displacement, springs included, ordered [component][Z][Y][X]; zero on other ranks' lines.
  std::vector<double> compute_internal_force();
  double mass(int X, int Y, int Z) const;  ///< nodal [kg]; zero inside open blocks

  int nodes_x() const { return nX_; }
  int nodes_y() const { return nY_; }
  int nodes_z() const { return nZ_; }

 private:
  enum class Field { plain, weighted, viscous, memory };  ///< how w comes from u
  struct Slab {                                           // a layer of elements
    int layer;
    double hz;
    bool below_same, above_same;  // material
  };
  struct Sums {
    double energy = 0, kinetic = 0, work = 0, xkx = 0, xmx = 0;
  };
  struct Scratch {  // of one thread
    AlignedVector<T> w, f, plane[2];
    AlignedVector<T> row, ends;  // lines of one row that has elements of the matched layer; of its ends
    Sums sums, sums_of_others;   // of the lines that this rank owns, that another one does
  };

  std::size_t line_size() const { return static_cast<std::size_t>(3) * N_ * stride_; }
  std::size_t line_offset(int Y, int Z) const {
    return guard + (static_cast<std::size_t>(Z - first_.Z) * lines_y() + (Y - first_.Y)) * line_size();
  }
  std::size_t index(int c, int X, int Y, int Z) const {
    return line_offset(Y, Z) + static_cast<std::size_t>(c * N_ + X % N_) * stride_ + X / N_;
  }
  int lines_y() const { return last_.Y - first_.Y + 1; }
  int lines_z() const { return last_.Z - first_.Z + 1; }
  bool has_surface() const { return last_.Z == nZ_ - 1; }
  void make_seams();
  void set_random_displacement();
  void add_blocks(const Tile<T>& tile, Field field, int ey, int ez) const;
  T y_factor(int component, int Y) const {
    return lattice_.half_model && Y == 0 && (component == 1) != boundary_.odd_y ? T(0) : T(1);
  }
  /// Held at rest at X = 0.
  bool is_held_at_start(int component) const {
    return lattice_.quarter_model && (component == 0) != boundary_.odd_x;
  }
  template <class Finish>
  void sweep(int thread, const Region& region, Field field, MatchedLayer<T>* layer, const Finish& finish);
  void apply_row(Tile<T>& tile, Field field, MatchedLayer<T>* layer, int ey, int ez, Scratch& scratch) const;
  template <class Finish>
  void finish_seams(int thread, const Finish& finish);
  /// @param layer  nullptr: all elements are plain
  template <class Finish>
  void run_sweep(Field field, MatchedLayer<T>* layer, const Finish& finish);
  void form_line(Field field, int layer, int Y, int Z, T* out) const;
  void add_springs(int Y, int Z, T* f) const;
  template <bool account>
  void advance_line(Sums& sums, int Y, int Z, T* f);

  static constexpr int guard = 64;

  Lattice lattice_;
  std::vector<EngineMaterial> materials_;
  std::vector<double> rates_;
  EngineBoundary boundary_;
  Ranks* ranks_;
  int rank_;
  Partition partition_;
  ElementBlock part_;
  ThreadTeam team_;
  RegionPlan plan_;
  TileFunction<T> tile_function_;
  ElementFunction<T> element_function_;
  int N_, stride_, nX_, nY_, nZ_;
  LinePlace first_, last_;  // of this rank's lines
  std::vector<Slab> slabs_;
  Field step_field_ = Field::plain;

  AxisTables<T> axes_;
  BoundaryTables edge_;
  BlockTables<T> blocks_;
  std::unique_ptr<MatchedLayer<T>> layer_;  // nullptr: a sponge
  AlignedVector<T> decay_x_, gain_x_;       // sponge factors along x [N][stride]
  SpongeFactors sponge_y_, sponge_z_;

  // Parts of the forces on the lines of the seams; where the line of each slot lies.
  AlignedVector<T> seam_, sent_, received_;
  std::vector<T*> slot_line_;
  std::unique_ptr<Halo> halo_;
  bool is_exchanging_ = false;

  AlignedVector<T> u_, v_;
  std::vector<AlignedVector<T>> zeta_;
  std::vector<Scratch> scratch_;
  std::vector<T> keep_;  // exp(-omega_l dt)
  double dt_ = 0;

  // Surface forces of the step: lines of the top plane [Y][component][N][stride], divided by m_x;
  // none where another rank has the surface.
  AlignedVector<T> load_;
  std::vector<char> loaded_row_;
  double energy_ = 0, kinetic_energy_ = 0, step_work_ = 0;
};

}  // namespace easydyn::soil

#pragma once

#include <array>
#include <vector>

#include "soil/element_operator.hpp"
#include "soil/lattice.hpp"
#include "soil/simd.hpp"
#include "soil/thread_team.hpp"
#include "soil/tile_operator.hpp"

namespace easydyn::soil {

/// Material of one layer or block as the engine needs it.
struct EngineMaterial {
  double lambda = 0, mu = 0, density = 0;  ///< [Pa], [kg/m3]; unrelaxed moduli where there is memory
  double beta = 0;                         ///< [s] stiffness-proportional damping
  std::vector<double> memory_weights;      ///< y_l of the memory variables, see relaxation.hpp
};

/// What absorbs waves at the sides and the bottom.
struct EngineBoundary {
  /// Damping at the outer edge of a sponge [1/s] = strength x speed / length of the sponge, rising from its inner
  /// edge as the square of the distance: a wave of that speed loses strength / 6 nepers on its way out.
  double sponge_strength = 10;
  double sponge_speed = 0;  ///< [m/s] shear wave speed of the half-space; 0: no sponge
  /// The motion at the plane x = 0 of a quarter model, y = 0 of a half model, is antisymmetric: components along
  /// the plane are zero there, else the one across it.
  bool odd_x = false, odd_y = false;
  bool dashpots = true;            ///< viscous dashpots and far-field springs on the outer faces
  std::array<double, 2> origin{};  ///< x, y [m] of the middle of the loads: the springs know their distance
};

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
/// soon as its last row is done, so the force never reaches the memory. Threads take ranges of rows in y; the
/// line of nodes between two ranges waits for both.
///
/// Blocks: the sweep treats all elements of a row as of the layer's material; rows with blocks then get the
/// difference, element by element (element_operator.hpp), and their lines the ratio of the true mass to the
/// layer's. Nodes inside open blocks have no mass and stay at rest. Sponge, dashpots and springs are the layer's
/// where a block reaches the edge of the model; they take energy away or conserve it whatever the block is.
template <class T>
class WaveEngine {
 public:
  WaveEngine(const Lattice& lattice, const std::vector<EngineMaterial>& materials,
             const std::vector<double>& relaxation_rates, const EngineBoundary& boundary, int threads);

  static double compute_memory(const Lattice& lattice, int memory_variables);  ///< [byte] of the fields

  /// Largest eigenvalue of M^-1 K [1/s2] by power iteration; of M^-1 K_beta [1/s] (each layer times its beta)
  /// where `weighted`.
  double compute_largest_eigenvalue(bool weighted, int iterations = 80);
  /// Stable step [s]: dt^2 omega^2 / 4 + dt lambda_beta / 2 = 1.
  double compute_stable_step();
  void set_time_step(double dt);  ///< to be called before advance()
  double time_step() const { return dt_; }

  /// One step under the given surface forces; energies are summed if `account`.
  void advance(const std::vector<SurfaceNodeForce>& forces, bool account);
  /// Kinetic + strain energy half a step after the last step with `account` [J]; NaN or inf if unstable.
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
  }
  /// f = K u with the present displacement, springs included, ordered [component][Z][Y][X].
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
  struct BlockRow {  // a row of elements with blocks in it; tables [stride] per element
    int first, last;
    AlignedVector<T> lambda, mu;              // zero outside blocks and where open
    AlignedVector<T> minus_lambda, minus_mu;  // those of the layer, where a block is
    AlignedVector<T> lambda_change, mu_change;
    AlignedVector<T> beta;
    std::array<AlignedVector<T>, 3> minus_weight;  // of the memory variables
  };
  struct MassLine {                   // a line of nodes whose masses are not the layers'; tables [N][stride]
    AlignedVector<T> ratio, inverse;  // true mass / that of the layers; inverse 0 where there is none
  };
  struct Scratch {  // of one thread
    AlignedVector<T> w, f, plane[2], seam_low, seam_high;
    double energy = 0, kinetic = 0, work = 0, sum_xkx = 0, sum_xmx = 0;
  };

  std::size_t line_size() const { return static_cast<std::size_t>(3) * N_ * stride_; }
  std::size_t line_offset(int Y, int Z) const {
    return guard + (static_cast<std::size_t>(Z) * nY_ + Y) * line_size();
  }
  std::size_t index(int c, int X, int Y, int Z) const {
    return line_offset(Y, Z) + static_cast<std::size_t>(c * N_ + X % N_) * stride_ + X / N_;
  }
  void make_line_tables();
  void make_boundary_tables();
  void make_block_tables();
  int find_material(int ex, int ey, int ez) const;
  double mass_of_layers(int X, int Y, int Z) const { return mx_[X] * my_[Y] * mz_density_[Z]; }
  const MassLine* find_mass_line(int Y, int Z) const {
    if (mass_line_.empty()) return nullptr;
    const int line = mass_line_[static_cast<std::size_t>(Z) * nY_ + Y];
    return line < 0 ? nullptr : &mass_lines_[line];
  }
  void add_blocks(const Tile<T>& tile, Field field, int ey, int ez) const;
  T y_factor(int component, int Y) const {
    return lattice_.half_model && Y == 0 && (component == 1) != boundary_.odd_y ? T(0) : T(1);
  }
  /// Held at rest at X = 0.
  bool is_held_at_start(int component) const {
    return lattice_.quarter_model && (component == 0) != boundary_.odd_x;
  }
  template <class Finish>
  void sweep(int thread, Field field, const Finish& finish);
  template <class Finish>
  void finish_seam(int thread, const Finish& finish);
  template <class Finish>
  void run_sweep(Field field, const Finish& finish);
  void form_line(Field field, int layer, int Y, int Z, T* out) const;
  void add_springs(int Y, int Z, T* f) const;
  template <bool account>
  void advance_line(Scratch& scratch, int Y, int Z, T* f);

  static constexpr int guard = 64;

  Lattice lattice_;
  std::vector<EngineMaterial> materials_;
  std::vector<double> rates_;
  EngineBoundary boundary_;
  ThreadTeam team_;
  TileFunction<T> tile_function_;
  ElementFunction<T> element_function_;
  int N_, stride_, nX_, nY_, nZ_;
  std::vector<Slab> slabs_;
  std::vector<int> first_row_;  // per thread, and the end
  Field step_field_ = Field::plain;

  // Masses of the line operators: node mass = mx my mz_density.
  std::vector<double> mx_, my_, mz_density_;
  // Per node along z: spring and dashpot integrals (sum over elements of modulus times weight).
  std::vector<double> spring_normal_z_, spring_shear_z_, dash_p_z_, dash_s_z_;
  double spring_normal_bottom_ = 0, spring_shear_bottom_ = 0, dash_p_bottom_ = 0, dash_s_bottom_ = 0;
  std::array<double, 2> distance_x_{}, distance_y_{};

  // Tables along x [N][stride].
  AlignedVector<T> rmx_, kx_, kx_left_, x_end_, mx_table_;
  AlignedVector<T> decay_x_, gain_x_;  // sponge factors (1 - a) / (1 + a) and 1 / (1 + a)
  std::vector<double> decay_y_, gain_y_, decay_z_, gain_z_;

  // Blocks: index of each row of elements and of each line of nodes, -1: none; empty without blocks.
  std::vector<int> block_row_, mass_line_;
  std::vector<BlockRow> block_rows_;
  std::vector<MassLine> mass_lines_;
  AlignedVector<T> hx_, slope_x_, ones_;

  AlignedVector<T> u_, v_;
  std::vector<AlignedVector<T>> zeta_;
  std::vector<Scratch> scratch_;
  std::vector<T> keep_;  // exp(-omega_l dt)
  double dt_ = 0;

  // Surface forces of the step: lines of the top plane [Y][component][N][stride], divided by m_x.
  AlignedVector<T> load_;
  std::vector<char> loaded_row_;
  double energy_ = 0, kinetic_energy_ = 0, step_work_ = 0;
};

}  // namespace easydyn::soil

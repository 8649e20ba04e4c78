#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "easydyn/math/expr.hpp"
#include "easydyn/math/expr_vector.hpp"
#include "easydyn/math/inertia.hpp"
#include "easydyn/math/spatial.hpp"
#include "easydyn/mbs/deformable_inertia.hpp"

namespace easydyn {

/// Energy accounts that the force elements keep during an evaluation.
struct EnergyAccounts {
  double potential = 0;   ///< [J]
  double dissipated = 0;  ///< power turned into heat [W]
  double supplied = 0;    ///< power brought in by external forces and drives [W]
};

/// The varying motions of a system at one instant, and the sweeps over them.
///
/// Motion k leads from the frame of its parent by a scalar e_k(q, t) along the screw S_k (world axes, about
/// the common point O). A forward sweep gives the twists and bias accelerations
///
///   V_k = V_p + S_k e_k.          A_k = A_p + S_k e_k.. + V_k x S_k e_k.
///
/// and a backward sweep of the wrenches gives, with the gradients g_k = de_k/dq, the residual and mass matrix
///
///   f_k = sum over the bodies carried (I A + V x* I V - applied wrench)        tau_k = S_k . f_k
///   r = sum_k g_k tau_k           M = sum_k sum_j g_k g_j^T (S_j . Ic_k S_k),  j = k and its ancestors.
///
/// Coordinates that are shared, geared or hidden in functions are exact, since only the projection with g_k
/// knows about them. Reference: Featherstone 2008 (RNEA ch. 5, CRBA ch. 6), projected.
///
/// Every pair (k, j) enters the mass matrix once, M = W + W^T. Consecutive motions of a path that have one
/// coordinate each, in sequence, form a run: their part of a column of W is a dense product with the momentum
/// Ic_k S_k, several motions at a time. Any other motion is a run of its own.
class MotionTree {
 public:
  /// The tree that frames attach to while positions() runs in this thread.
  static MotionTree* current() { return current_; }
  /// Makes a tree current for the lifetime of the object.
  class Scope {
   public:
    explicit Scope(MotionTree& tree);
    ~Scope();
    Scope(const Scope&) = delete;

   private:
    MotionTree* previous_;
  };

  /// While a loop tries its unknowns, bodies must not be placed: motions of a trial do not stay.
  class Trial {
   public:
    explicit Trial(MotionTree* tree) : tree_(tree) {
      if (tree_) ++tree_->trials_;
    }
    ~Trial() {
      if (tree_) --tree_->trials_;
    }
    Trial(const Trial&) = delete;

   private:
    MotionTree* tree_;
  };
  bool is_in_trial() const { return trials_ > 0; }

  void clear(double t = 0);
  double time() const { return t_; }  ///< [s] of the evaluation
  int add_rotation(int parent, const spatial::Vector& axis_0, const spatial::Vector& p_0, const Expr& angle);
  int add_translation(int parent, const spatial::Vector& axis_0, const Expr& displacement);
  /// @param inertia  about the centre of mass, body axes
  /// @param R, p     R_0G, p_0G
  /// @param motion   that carries it, -1: fixed to the ground
  void add_body(const Inertia& inertia, const Eigen::Matrix3d& R, const Eigen::Vector3d& p, int motion);

  /// To be added before compute_velocities(); it must live until the next clear().
  void add_deformable(DeformableInertia& inertia) { deformable_.push_back(&inertia); }

  /// The point that is now at p_0P (world axes) and moves with motion k, as expressions; in positions(), too.
  ExprVector express_point(int motion, const Eigen::Vector3d& p_0P) const;
  /// The direction d (world axes) turned by motion k, as expressions.
  ExprVector express_direction(int motion, const Eigen::Vector3d& d) const;

  /// Number of motions so far, and the way back to it: motions made in a trial do not stay.
  int size() const { return size_; }
  void shrink_to(int size);

  /// Screws and twists, once all motions and bodies are known. Forces may then be applied until close_forces().
  void compute_velocities();
  void close_forces() { forces_open_ = false; }
  /// Accelerations A_k for given qdd (null: bias only).
  void compute_accelerations(const double* qdd);
  /// r += M qdd + h - Q from the accelerations last computed; drive_power: power of imposed motions [W].
  /// Once per evaluation.
  void add_residual(const double* qd, double* r, double* drive_power);
  /// M (n x n, symmetric) = the mass matrix.
  void compute_mass_matrix(Eigen::Ref<Eigen::MatrixXd> M);
  double kinetic_energy() const;

  Eigen::Vector3d angular_velocity(int motion) const;
  Eigen::Vector3d velocity_at(int motion, const Eigen::Vector3d& p) const;
  Eigen::Vector3d acceleration_at(int motion, const Eigen::Vector3d& p) const;
  void add_wrench(int motion, const Eigen::Vector3d& force, const Eigen::Vector3d& p) {
    check_forces_open();
    Moving& k = moving_[static_cast<std::size_t>(motion)];
    const spatial::Vector f(force);
    k.f -= {cross(spatial::Vector(p) - O_, f), f};
  }
  void add_moment(int motion, const Eigen::Vector3d& moment) {
    check_forces_open();
    moving_[static_cast<std::size_t>(motion)].f.moment -= spatial::Vector(moment);
  }
  /// Weight of all bodies in the uniform field g [m/s^2]; potential energy -m g . p (zero at the origin).
  void add_gravity(const Eigen::Vector3d& g) {
    check_forces_open();
    gravity_ += spatial::Vector(g);
    energy_.potential -= dot(spatial::Vector(g), mass_moment_);
  }

  EnergyAccounts& energy() { return energy_; }
  const EnergyAccounts& energy() const { return energy_; }

 private:
  // A motion as positions() gives it.
  struct Joint {
    int parent;
    int coordinate;  // of its gradient, if this has one entry; else -1
    int run;         // first motion of the run that this one continues
    bool is_rotation;
    std::uint32_t first_entry, last_entry;  // of the gradient, in entries_
    double rate, bias;
    spatial::Vector axis, point;
  };
  // What the sweeps make of it.
  struct Moving {
    spatial::Twist S, V, A;      // screw, twist, acceleration (bias, or with qdd)
    spatial::Wrench f;           // less the applied ones; the bodies' are added in the backward sweep
    spatial::Inertia composite;  // backward sweep of the mass matrix
  };
  struct Carried {
    double mass;
    spatial::Symmetric J;  // about the centre of mass, world axes
    spatial::Vector p;     // p_0G
    int motion;
  };
  // Of all motions, coordinate by coordinate of the vector, so that a product takes several motions at a time.
  static constexpr int lanes = 4;
  struct Screws {
    std::vector<double> c[6];
  };

  int add_joint(int parent, bool is_rotation, const spatial::Vector& axis_0, const spatial::Vector& p_0,
                const Expr& e);
  Gradient::Entries entries(const Joint& k) const {
    return {entries_.data() + k.first_entry, k.last_entry - k.first_entry};
  }
  void check_velocities() const {
    if (!velocities_known_) throw_velocities_unknown();
  }
  void check_forces_open() const {
    if (!forces_open_) throw_forces_closed();
  }
  [[noreturn]] static void throw_velocities_unknown();
  [[noreturn]] static void throw_forces_closed();
  /// Twist and bias acceleration of motion k about the point P; the motions on the way go to `path`, root first.
  void follow(int motion, const spatial::Vector& P, std::vector<int>& path, spatial::Twist& V,
              spatial::Twist& A) const;
  static spatial::Twist screw_about(const Joint& k, const spatial::Vector& P) {
    if (!k.is_rotation) return {{}, k.axis};
    return {k.axis, cross(k.axis, P - k.point)};
  }
  /// Of the point at p (world axes) that moves with motion k.
  spatial::Vector acceleration_of(int k, const spatial::Vector& p) const {
    const Moving& m = moving_[static_cast<std::size_t>(k)];
    const spatial::Vector d = p - O_;
    // The spatial acceleration is that of the field at a fixed point: add w x v for the material point.
    return m.A.v + cross(m.A.w, d) + cross(m.V.w, m.V.v + cross(m.V.w, d));
  }
  void collect_composites();
  DeformableInertia::FrameMotion frame_motion_of(const DeformableInertia& d) const;
  void add_deformable_forces(const double* qd, double* r, double* drive_power);
  void add_deformable_mass(Eigen::Ref<Eigen::MatrixXd> M);
  void project_momentum(int k, const spatial::Wrench& momentum);

  static constinit thread_local MotionTree* current_;
  double t_ = 0;
  int size_ = 0;  // motions in use; the others keep their memory
  std::vector<Joint> joints_;
  std::vector<Moving> moving_;
  std::vector<Gradient::Entry> entries_;  // gradients of all motions, one after the other
  std::vector<Carried> bodies_;
  Screws screws_;          // times the gradient, where it has one entry
  std::vector<double> H_;  // screws_ . momentum, in the mass matrix
  spatial::Vector gravity_;
  spatial::Vector mass_moment_;  // sum of m p_0G
  spatial::Vector O_;
  std::vector<DeformableInertia*> deformable_;
  const double* qdd_ = nullptr;                         // of the last accelerations
  Eigen::VectorXd shape_accelerations_, shape_forces_;  // scratch
  Eigen::MatrixXd jacobian_, mass_jacobian_;            // scratch
  int trials_ = 0;
  bool velocities_known_ = false, forces_open_ = false, accelerations_known_ = false;
  EnergyAccounts energy_;
};

}  // namespace easydyn

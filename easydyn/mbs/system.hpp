#pragma once

#include <Eigen/Core>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "easydyn/mbs/body.hpp"
#include "easydyn/mbs/coordinate.hpp"
#include "easydyn/mbs/frame.hpp"
#include "easydyn/mbs/linear_structure.hpp"
#include "easydyn/mbs/motion_tree.hpp"
#include "easydyn/mbs/state.hpp"

namespace easydyn {

class Port;

/// A mechanical system in independent coordinates q. The user derives from it, declares coordinates and
/// bodies as members and gives the **positions** of the bodies and the forces; the equations of motion
///
///   r(q, qd, qdd, t) = M(q, t) qdd + h(q, qd, t) - Q(q, qd, t) = 0
///
/// follow by virtual power with exact velocities, accelerations and partial velocities:
///
///     class Pendulum : public System {
///       Coordinate a = coordinate("a", 1.0);
///       Body& rod = body("rod", Inertia::rod_z(2.0, 1.0));
///       void positions() override { rod = rotate_y(a) * translate(0, 0, -0.5); }
///       void forces() override { gravity(); }
///     };
///
/// Axes: z up; SI units. One instance is used by one thread at a time.
class System {
 public:
  explicit System(std::string name = "system");
  virtual ~System();
  System(const System&) = delete;
  System& operator=(const System&) = delete;

  // ---- description: by the user's class, or by an assembly (a vehicle, a track) that is built into it ----

  /// Declares a coordinate with its value and rate at the start.
  Coordinate coordinate(std::string name, double initial = 0, double initial_rate = 0);
  Body& body(std::string name, const Inertia& inertia);
  LinearStructure& structure(std::string name, SparseMatrix M, SparseMatrix C, SparseMatrix K);
  /// Touches a structure at a place, inside forces(), in the same order at each evaluation. The port holds during
  /// this evaluation. @throws ModelError outside forces(), or if a coordinate of the shape is out of range
  Port touch(const LinearStructure& structure, const PortShape& shape);

  // ---- what the system is, and its equations ----

  const std::string& name() const { return name_; }
  int size() const;                                                        ///< all coordinates
  int body_size() const { return static_cast<int>(coordinates_.size()); }  ///< those of the bodies
  /// Name of coordinate i; of a structure's: "structure[k]".
  std::string coordinate_name(int i) const;
  const std::deque<Body>& bodies() const { return bodies_; }
  const std::vector<std::unique_ptr<LinearStructure>>& structures() const { return structures_; }
  int structure_offset(int k) const;  ///< index of the first coordinate of structure k in q

  /// The state that the declarations describe: t = 0, given q and qd, qdd = 0, structures at rest.
  State initial_state() const;

  /// r(q, qd, qdd, t), size() entries [N, N m]. @throws ModelError if a body is not placed by positions()
  void compute_residual(const State& state, Eigen::Ref<Eigen::VectorXd> r);
  Eigen::VectorXd compute_residual(const State& state);
  /// M(q, t), size() x size(), symmetric (dense: for small systems).
  Eigen::MatrixXd compute_mass_matrix(const State& state);
  /// h - Q: the residual at qdd = 0.
  Eigen::VectorXd compute_bias(const State& state);
  /// M and h - Q of the bodies' coordinates in one evaluation (no structures); sizes body_size().
  void compute_mass_and_bias(const State& state, Eigen::Ref<Eigen::MatrixXd> M,
                             Eigen::Ref<Eigen::VectorXd> bias);
  EnergyBalance compute_energy(const State& state);
  /// Places bodies and computes velocities, forces and accelerations at a state, so that `bodies()` answer.
  void evaluate(const State& state);

  // ---- for solvers that treat structures through their ports ----

  /// How a structure moves where it is touched, answered by the solver.
  using PortMotionFunction = std::function<PortMotion(int structure, const PortShape& shape)>;
  /// A port as used in the last evaluation: where, how it moved, and the force that it received.
  struct PortRecord {
    int structure;
    PortShape shape;
    PortMotion motion;
    double force;
  };
  /// Residual of the bodies' coordinates alone (body_size() entries), with port motions given by `motion`.
  void compute_body_residual(double t, const double* q, const double* qd, const double* qdd,
                             const PortMotionFunction& motion, double* r);
  /// Ports touched in the last evaluation, in order.
  const std::vector<PortRecord>& ports() const { return ports_; }

 protected:
  /// Places every body: `rod = rotate_y(a) * translate(0, 0, -l / 2);`. Called at each evaluation.
  virtual void positions() = 0;
  /// Applies forces; velocities are known. Called at each evaluation.
  virtual void forces() {}

  // ---- inside positions() and forces() ----

  Expr time() const { return Expr::of_time(t_, 1, 0); }
  /// Weight of all bodies: uniform field [m/s^2], downward along z by default.
  void gravity(double g = 9.81) { gravity(Eigen::Vector3d(0, 0, -g)); }
  void gravity(const Eigen::Vector3d& field);
  /// Energy accounts, for force elements of one's own.
  EnergyAccounts& energy() { return tree_.energy(); }

 private:
  friend class Coordinate;
  friend class Port;
  struct CoordinateData {
    std::string name;
    double initial, initial_rate;
  };
  void place(double t, const double* q, const double* qd, const PortMotionFunction& motion);
  PortMotionFunction motion_of(const State& state) const;
  void check_size(const State& state) const;

  std::string name_;
  std::vector<CoordinateData> coordinates_;
  std::deque<Body> bodies_;
  std::vector<std::unique_ptr<LinearStructure>> structures_;
  MotionTree tree_;
  std::vector<PortRecord> ports_;
  double t_ = 0;
  const double* q_ = nullptr;  // during an evaluation
  const double* qd_ = nullptr;
  const PortMotionFunction* port_motion_ = nullptr;
};

/// A place where a linear structure is touched, within forces().
class Port {
 public:
  double displacement() const { return record().motion.displacement; }  ///< N q [m]
  double velocity() const { return record().motion.velocity; }          ///< N qd, material point [m/s]
  double slope() const { return record().motion.slope; }                ///< N' q [1]
  /// Adds the force F [N] along the structure's coordinate direction: N^T F.
  void add_force(double F) { system_->ports_[index_].force += F; }

 private:
  friend class System;
  Port(System& system, std::size_t index) : system_(&system), index_(index) {}
  const System::PortRecord& record() const { return system_->ports_[index_]; }
  System* system_;
  std::size_t index_;
};

}  // namespace easydyn

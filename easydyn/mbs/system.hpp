#pragma once

#include <Eigen/Core>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "easydyn/mbs/body.hpp"
#include "easydyn/mbs/coordinate.hpp"
#include "easydyn/mbs/flexible_body.hpp"
#include "easydyn/mbs/frame.hpp"
#include "easydyn/mbs/free_motion.hpp"
#include "easydyn/mbs/linear_structure.hpp"
#include "easydyn/mbs/loop.hpp"
#include "easydyn/mbs/motion_tree.hpp"
#include "easydyn/mbs/reaction.hpp"
#include "easydyn/mbs/signals.hpp"
#include "easydyn/mbs/state.hpp"
#include "easydyn/mbs/velocity_constraint.hpp"

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
  /// Declares an elastic body and its shape coordinates, named "body.0", "body.1" ...
  /// @param damping_ratio  of its own modes, the rest of the system at rest, >= 0
  FlexibleBody& flexible_body(std::string name, const FlexibleModel& model, const ShapeOptions& shapes,
                              double damping_ratio = 0);
  VelocityConstraint& velocity_constraint(std::string name);
  FirstOrderState first_order_state(std::string name, double initial = 0);
  Input input(std::string name, double value = 0);
  /// @param value  given: evaluated after the accelerations; else forces() sets the output
  Output output(std::string name, std::function<double()> value = {});
  Reaction reaction(std::string name);
  /// Declares the motion of a free body with its origin and orientation at the start.
  FreeMotion free_motion(const std::string& name, const Eigen::Vector3d& origin = Eigen::Vector3d::Zero(),
                         const Eigen::Matrix3d& orientation = Eigen::Matrix3d::Identity());
  /// Declares a closed loop with N unknowns and a guess of them.
  template <int N>
  Loop<N> loop(const std::string& name, const std::array<double, N>& guess) {
    return Loop<N>(add_loop(name, guess));
  }
  LinearStructure& structure(std::string name, SparseMatrix M, SparseMatrix C, SparseMatrix K);
  /// Touches a structure at a place, inside forces(), in the same order at each evaluation. The port holds during
  /// this evaluation. @throws ModelError outside forces(), or if a coordinate of the shape is out of range
  Port touch(const LinearStructure& structure, const PortShape& shape);

  // ---- what the system is, and its equations ----

  const std::string& name() const { return name_; }
  int size() const;                              ///< coordinates of State::q
  int body_size() const { return free_count_; }  ///< those of the bodies, without the held ones
  int first_order_size() const { return static_cast<int>(first_order_.size()); }
  int constraint_size() const { return static_cast<int>(constraints_.size()); }
  /// Equations of everything but structures: body_size() + first_order_size() + constraint_size().
  int equation_count() const { return body_size() + first_order_size() + constraint_size(); }
  /// Name of coordinate i; of a structure's: "structure[k]".
  std::string coordinate_name(int i) const;
  /// Name of equation i: of the coordinate, the first-order state or the constraint.
  std::string equation_name(int i) const;
  const std::deque<Body>& bodies() const { return bodies_; }
  const std::vector<std::unique_ptr<FlexibleBody>>& flexible_bodies() const { return flexible_bodies_; }
  const std::deque<VelocityConstraint>& velocity_constraints() const { return constraints_; }
  const std::string& input_name(int i) const { return inputs_[static_cast<std::size_t>(i)].name; }
  double input_value(int i) const { return inputs_[static_cast<std::size_t>(i)].value; }
  void set_input(int i, double value);  ///< @throws ModelError if the value is not finite
  int input_size() const { return static_cast<int>(inputs_.size()); }
  const std::string& output_name(int i) const { return outputs_[static_cast<std::size_t>(i)].name; }
  /// At the last evaluation.
  double output_value(int i) const { return outputs_[static_cast<std::size_t>(i)].value; }
  int output_size() const { return static_cast<int>(outputs_.size()); }
  const std::vector<std::unique_ptr<LinearStructure>>& structures() const { return structures_; }
  int structure_offset(int k) const;  ///< index of the first coordinate of structure k in q

  /// The state that the declarations describe: t = 0, given q and qd, qdd = 0, structures at rest.
  State initial_state() const;

  /// r(q, qd, qdd, t) - A^T lambda, size() entries [N, N m]. @throws ModelError if a body is not placed by positions()
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
  /// The same without the structures, at the last evaluation (with port forces as they were).
  EnergyBalance body_energy() const;
  /// f of the first-order states x. = f at the last evaluation.
  Eigen::Map<const Eigen::VectorXd> first_order_rates() const { return {rates_.data(), first_order_size()}; }
  /// Generalised force that holds a held coordinate, at the last evaluation [N, N m].
  double holding_force(const Coordinate& coordinate) const;
  /// Fills the reactions at a state with its accelerations (and lambda).
  /// @throws ModelError naming a reaction that positions() does not cut exactly once
  void compute_reactions(const State& state);
  /// Places bodies and computes velocities, forces and accelerations at a state, so that `bodies()` answer.
  void evaluate(const State& state);
  /// The same for who moves a mechanism by hand, state by state: the solution of the loops is kept in the state, and the
  /// next evaluation of it starts from there, on the same branch.
  void evaluate(State& state) {
    evaluate(std::as_const(state));
    update_loops(state);
  }

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
  /// State of everything but structures; pointers to so many numbers as there are of each.
  struct BodyState {
    double t;
    const double *q, *qd, *qdd;
    const double *x = nullptr, *xd = nullptr, *lambda = nullptr;
    const Eigen::Matrix3d* charts = nullptr;  // null: those of the start
    const double* loops = nullptr;            // null: from the last solution
  };
  static BodyState body_state(const State& s) {
    return {s.t,         s.q.data(),      s.qd.data(),     s.qdd.data(),  s.x.data(),
            s.xd.data(), s.lambda.data(), s.charts.data(), s.loops.data()};
  }
  /// The equation_count() equations of everything but structures, with port motions given by `motion`:
  /// residual r - A^T lambda of the bodies' coordinates, x. - f, velocities phi of the constraints.
  void compute_body_residual(const BodyState& state, const PortMotionFunction& motion, double* r);
  /// For integrators, after a step: gives free motions that have turned far a new chart and converts the state to
  /// it. @param pseudo_accelerations  converted as qdd is; may be null
  /// @returns whether a chart has changed
  bool update_charts(State& state, Eigen::VectorXd* pseudo_accelerations = nullptr) const;
  /// After an evaluation near the state: the next solution of its loops starts from the last one. Integrators do it with
  /// every step.
  void update_loops(State& state) const;
  /// For solvers: changes when coordinates, first-order states, constraints or structures are declared, held or released.
  int revision() const { return revision_; }
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
  friend class FirstOrderState;
  friend class FreeMotion;
  friend class Output;
  friend class Reaction;
  friend class Port;
  struct CoordinateData {
    std::string name;
    double initial, initial_rate;
    int slot = 0;  // free ones: index in q; held ones behind them, for their forces
    bool is_held = false;
    std::function<ImposedMotion(double)> imposed = {};
    ImposedMotion now = {};  // of a held one, in this evaluation
  };
  struct NamedValue {
    std::string name;
    double value;
  };
  struct ReactionData {
    std::string name;
    int slot;      // of the first of six held coordinates
    int cuts = 0;  // in the present evaluation
    Eigen::Vector3d force, moment;
    bool is_known = false;
  };
  const CoordinateData& data_of(const Coordinate& c) const {
    return coordinates_[static_cast<std::size_t>(c.number_)];
  }
  void assign_slots();
  template <class Things>
  void require_new_name(const Things& things, const char* kind, const std::string& name) const;
  void place(const BodyState& state, const PortMotionFunction& motion);
  void fill_held(const BodyState& state);
  PortMotionFunction motion_of(const State& state) const;
  void check_size(const State& state) const;
  void compute_body_mass_matrix(Eigen::Ref<Eigen::MatrixXd> M);
  void subtract_generalized_forces(double* r) const;
  std::shared_ptr<LoopClosure> add_loop(const std::string& name, std::span<const double> guess);

  std::string name_;
  std::vector<CoordinateData> coordinates_;
  std::vector<int> free_;  // numbers of the free coordinates, by slot
  int free_count_ = 0, slot_count_ = 0;
  std::vector<NamedValue> first_order_, inputs_, outputs_;
  std::vector<std::function<double()>> output_functions_;
  int revision_ = 0;
  struct GeneralizedForce {
    int slot;
    double Q;
  };
  std::vector<GeneralizedForce> generalized_forces_;  // of the present evaluation
  std::deque<VelocityConstraint> constraints_;
  std::vector<ReactionData> reactions_;
  std::vector<FreeMotion> free_motions_;
  std::vector<Eigen::Matrix3d> initial_charts_;
  const Eigen::Matrix3d* chart_pointer_ = nullptr;  // during an evaluation
  bool cuts_open_ = false;
  std::vector<double> rates_;                     // of the first-order states
  std::vector<double> qd_all_, qdd_all_, r_all_;  // by slot, where there are held ones
  std::deque<Body> bodies_;
  std::vector<std::unique_ptr<FlexibleBody>> flexible_bodies_;
  std::vector<std::unique_ptr<LinearStructure>> structures_;
  std::vector<std::shared_ptr<LoopClosure>> loops_;
  int loop_unknowns_ = 0;
  MotionTree tree_;
  std::vector<PortRecord> ports_;
  Eigen::VectorXd scratch_;  // equations
  Eigen::MatrixXd M_all_;    // by slot, where there are held coordinates
  double t_ = 0;
  const double* q_ = nullptr;  // during an evaluation
  const double* qd_ = nullptr;
  const double* x_ = nullptr;
  bool in_forces_ = false;
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

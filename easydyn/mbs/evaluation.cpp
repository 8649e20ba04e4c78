// The evaluation of a system at a state: positions, velocities, forces, equations.

#include <fmt/format.h>

#include "easydyn/error.hpp"
#include "easydyn/mbs/system.hpp"

namespace easydyn {

using Eigen::MatrixXd;
using Eigen::VectorXd;

void System::place(const BodyState& state, const PortMotionFunction& motion) {
  if (q_)
    throw ModelError(fmt::format("system \"{}\" is evaluated inside its own positions() or forces()", name_));
  // Coordinates and ports answer during the evaluation only, however it ends.
  struct Reset {
    System& s;
    ~Reset() {
      s.q_ = s.qd_ = s.x_ = nullptr;
      s.port_motion_ = nullptr;
      s.chart_pointer_ = nullptr;
      s.in_forces_ = false;
      s.tree_.close_forces();
    }
  } reset{*this};
  t_ = state.t;
  static const double none = 0;  // where there are no coordinates, vectors have no address
  q_ = state.q ? state.q : &none;
  qd_ = state.qd ? state.qd : &none;
  x_ = state.x ? state.x : &none;
  port_motion_ = &motion;
  chart_pointer_ = state.charts ? state.charts : initial_charts_.data();
  if (slot_count_ > free_count_) fill_held(state);
  if (state.loops) {
    const double* memory = state.loops;
    for (const auto& loop : loops_) {
      loop->read_memory(memory);
      memory += loop->memory_size();
    }
  }

  // Positions: the user's program builds the tree of motions.
  tree_.clear(t_);
  ports_.clear();
  for (Body& b : bodies_) b.is_placed_ = false;
  for (const auto& b : flexible_bodies_) b->is_placed_ = false;
  for (VelocityConstraint& c : constraints_) c.is_given_ = false;
  {
    MotionTree::Scope scope(tree_);
    positions();
  }
  for (const VelocityConstraint& c : constraints_)
    if (!c.is_given_)
      throw ModelError(fmt::format("velocity constraint \"{}\" of system \"{}\" is not given by positions()",
                                   c.name(), name_));
  for (const Body& b : bodies_) {
    if (!b.is_placed_)
      throw ModelError(
          fmt::format("body \"{}\" of system \"{}\" is not placed by positions()", b.name(), name_));
    tree_.add_body(b.inertia_, b.frame_.rotation(), b.frame_.origin(), b.frame_.motion_index());
  }

  for (const auto& b : flexible_bodies_) {
    if (!b->is_placed_)
      throw ModelError(fmt::format("flexible body \"{}\" of system \"{}\" is not placed by positions()",
                                   b->name(), name_));
    tree_.add_deformable(*b);
  }

  // Velocities, then the user's forces, which may use them.
  tree_.compute_velocities();
  generalized_forces_.clear();
  std::fill(rates_.begin(), rates_.end(), 0.0);
  in_forces_ = true;
  for (const auto& b : flexible_bodies_) b->apply_elastic_forces(tree_.energy());
  forces();
}

// Held coordinates move as given; to the sweeps they have no rate or acceleration of their own.
void System::fill_held(const BodyState& state) {
  for (CoordinateData& c : coordinates_) {
    if (!c.is_held) continue;
    c.now = c.imposed(state.t);
    if (!std::isfinite(c.now.value) || !std::isfinite(c.now.rate) || !std::isfinite(c.now.acceleration))
      throw ModelError(
          fmt::format("coordinate \"{}\": its imposed motion at t = {} s is not finite", c.name, state.t));
  }
  const auto n = static_cast<std::size_t>(free_count_);
  std::fill(qd_all_.begin() + free_count_, qd_all_.end(), 0.0);
  std::copy_n(state.qd, n, qd_all_.begin());
  std::fill(qdd_all_.begin() + free_count_, qdd_all_.end(), 0.0);
  if (state.qdd) std::copy_n(state.qdd, n, qdd_all_.begin());
}

void System::compute_body_residual(const BodyState& state, const PortMotionFunction& motion, double* r) {
  place(state, motion);
  const bool has_held = slot_count_ > free_count_;
  double* const all = has_held ? r_all_.data() : r;
  tree_.compute_accelerations(has_held ? qdd_all_.data() : state.qdd);
  std::fill(all, all + slot_count_, 0.0);
  double drive_power = 0;
  tree_.add_residual(has_held ? qd_all_.data() : state.qd, all, &drive_power);
  tree_.energy().supplied += drive_power;
  subtract_generalized_forces(all);

  double* rest = r + body_size();
  for (int i = 0; i < first_order_size(); ++i)
    *rest++ = (state.xd ? state.xd[i] : 0.0) - rates_[static_cast<std::size_t>(i)];
  for (std::size_t i = 0; i < constraints_.size(); ++i) {
    VelocityConstraint& c = constraints_[i];
    c.lambda_ = state.lambda ? state.lambda[i] : 0.0;
    double imposed = c.velocity();  // what of phi comes from time and held coordinates: there lambda works
    for (const Gradient::Entry& a : c.row()) {
      all[a.coordinate] -= a.value * c.lambda_;
      if (a.coordinate < free_count_) imposed -= a.value * state.qd[a.coordinate];
    }
    tree_.energy().supplied -= c.lambda_ * imposed;
    *rest++ = c.velocity();
  }
  for (std::size_t i = 0; i < outputs_.size(); ++i)
    if (output_functions_[i]) outputs_[i].value = output_functions_[i]();
  if (has_held) std::copy_n(all, body_size(), r);
}

double System::holding_force(const Coordinate& coordinate) const {
  const CoordinateData& c = data_of(coordinate);
  if (!c.is_held) throw ModelError(fmt::format("coordinate \"{}\" is not held: no force holds it", c.name));
  return r_all_[static_cast<std::size_t>(c.slot)];
}

void System::compute_reactions(const State& state) {
  struct Open {
    bool& flag;
    explicit Open(bool& f) : flag(f) { flag = true; }
    ~Open() { flag = false; }
  } open(cuts_open_);
  for (ReactionData& r : reactions_) r.cuts = 0;
  evaluate(state);
  for (ReactionData& r : reactions_) {
    if (r.cuts != 1)
      throw ModelError(
          fmt::format("reaction \"{}\" of system \"{}\" is cut {} times in positions(), must be once", r.name,
                      name_, r.cuts));
    r.is_known = true;
    const auto slot = static_cast<std::size_t>(r.slot);
    r.force = Eigen::Vector3d::Map(&r_all_[slot]);
    r.moment = Eigen::Vector3d::Map(&r_all_[slot + 3]);
  }
}

System::PortMotionFunction System::motion_of(const State& state) const {
  return [this, &state](int k, const PortShape& shape) {
    const double* q = state.q.data() + structure_offset(k);
    const double* qd = state.qd.data() + structure_offset(k);
    PortMotion motion;
    for (std::size_t i = 0; i < static_cast<std::size_t>(shape.count); ++i) {
      motion.displacement += shape.value[i] * q[shape.index[i]];
      motion.velocity += shape.value[i] * qd[shape.index[i]];
      motion.slope += shape.gradient[i] * q[shape.index[i]];
    }
    return motion;
  };
}

void System::check_size(const State& state) const {
  if (state.q.size() != size() || state.qd.size() != size() || state.qdd.size() != size())
    throw ModelError(fmt::format("system \"{}\" has {} coordinates, the state has q {}, qd {}, qdd {}", name_,
                                 size(), state.q.size(), state.qd.size(), state.qdd.size()));
  if (state.x.size() != first_order_size() || state.xd.size() != first_order_size())
    throw ModelError(fmt::format("system \"{}\" has {} first-order states, the state has x {}, xd {}", name_,
                                 first_order_size(), state.x.size(), state.xd.size()));
  if (state.lambda.size() != constraint_size())
    throw ModelError(fmt::format("system \"{}\" has {} velocity constraints, the state has lambda {}", name_,
                                 constraint_size(), state.lambda.size()));
  if (state.loops.size() != loop_unknowns_ + static_cast<int>(loops_.size()))
    throw ModelError(fmt::format("system \"{}\" has {} unknowns of loops with their signs, the state has {}",
                                 name_, loop_unknowns_ + static_cast<int>(loops_.size()),
                                 state.loops.size()));
  if (state.charts.size() != initial_charts_.size())
    throw ModelError(fmt::format("system \"{}\" has {} free motions, the state has {} charts", name_,
                                 initial_charts_.size(), state.charts.size()));
}

void System::compute_residual(const State& state, Eigen::Ref<VectorXd> r) {
  check_size(state);
  scratch_.resize(equation_count());
  compute_body_residual(body_state(state), motion_of(state), scratch_.data());
  r.head(body_size()) = scratch_.head(body_size());

  // Structures: inertia, damping and stiffness less the port forces.
  for (int k = 0; k < static_cast<int>(structures_.size()); ++k) {
    const LinearStructure& s = *structures_[static_cast<std::size_t>(k)];
    const int at = structure_offset(k);
    auto r_s = r.segment(at, s.size());
    r_s.noalias() = s.M() * state.qdd.segment(at, s.size());
    r_s.noalias() += s.C() * state.qd.segment(at, s.size());
    r_s.noalias() += s.K() * state.q.segment(at, s.size());
  }
  for (const PortRecord& p : ports_) {
    const int at = structure_offset(p.structure);
    for (std::size_t i = 0; i < static_cast<std::size_t>(p.shape.count); ++i)
      r[at + p.shape.index[i]] -= p.shape.value[i] * p.force;
  }
}

VectorXd System::compute_residual(const State& state) {
  VectorXd r(size());
  compute_residual(state, r);
  return r;
}

MatrixXd System::compute_mass_matrix(const State& state) {
  check_size(state);
  place(body_state(state), motion_of(state));
  MatrixXd M = MatrixXd::Zero(size(), size());
  compute_body_mass_matrix(M.topLeftCorner(body_size(), body_size()));
  for (int k = 0; k < static_cast<int>(structures_.size()); ++k) {
    const LinearStructure& s = *structures_[static_cast<std::size_t>(k)];
    M.block(structure_offset(k), structure_offset(k), s.size(), s.size()) = MatrixXd(s.M());
  }
  return M;
}

VectorXd System::compute_bias(const State& state) {
  State without_acceleration = state;
  without_acceleration.qdd.setZero();
  without_acceleration.lambda.setZero();
  return compute_residual(without_acceleration);
}

void System::compute_mass_and_bias(const State& state, Eigen::Ref<MatrixXd> M, Eigen::Ref<VectorXd> bias) {
  check_size(state);
  place(body_state(state), motion_of(state));
  tree_.compute_accelerations(nullptr);
  if (slot_count_ > free_count_) {
    std::fill(r_all_.begin(), r_all_.end(), 0.0);
    tree_.add_residual(qd_all_.data(), r_all_.data(), nullptr);
    subtract_generalized_forces(r_all_.data());
    bias = VectorXd::Map(r_all_.data(), body_size());
  } else {
    bias.setZero();
    tree_.add_residual(state.qd.data(), bias.data(), nullptr);
    subtract_generalized_forces(bias.data());
  }
  compute_body_mass_matrix(M);
}

void System::subtract_generalized_forces(double* r) const {
  for (const GeneralizedForce& f : generalized_forces_) r[f.slot] -= f.Q;
}

void System::compute_body_mass_matrix(Eigen::Ref<MatrixXd> M) {
  if (slot_count_ == free_count_) {
    tree_.compute_mass_matrix(M);
    return;
  }
  M_all_.resize(slot_count_, slot_count_);
  tree_.compute_mass_matrix(M_all_);
  M = M_all_.topLeftCorner(free_count_, free_count_);
}

EnergyBalance System::body_energy() const {
  const EnergyAccounts& accounts = tree_.energy();
  return {tree_.kinetic_energy(), accounts.potential, accounts.dissipated, accounts.supplied};
}

EnergyBalance System::compute_energy(const State& state) {
  evaluate(state);
  EnergyBalance e = body_energy();
  for (int k = 0; k < static_cast<int>(structures_.size()); ++k) {
    const LinearStructure& s = *structures_[static_cast<std::size_t>(k)];
    const auto q = state.q.segment(structure_offset(k), s.size());
    const auto qd = state.qd.segment(structure_offset(k), s.size());
    e.kinetic += 0.5 * qd.dot(s.M() * qd);
    e.potential += 0.5 * q.dot(s.K() * q);
    e.dissipated += qd.dot(s.C() * qd);
  }
  return e;
}

void System::evaluate(const State& state) {
  check_size(state);
  scratch_.resize(equation_count());
  compute_body_residual(body_state(state), motion_of(state), scratch_.data());
}

Port System::touch(const LinearStructure& structure, const PortShape& shape) {
  if (!port_motion_)
    throw ModelError(fmt::format("structure \"{}\" can be touched inside forces() only", structure.name()));
  for (std::size_t i = 0; i < static_cast<std::size_t>(shape.count); ++i)
    if (shape.index[i] < 0 || shape.index[i] >= structure.size())
      throw ModelError(fmt::format("structure \"{}\" is touched at coordinate {}, must be 0 to {}",
                                   structure.name(), shape.index[i], structure.size() - 1));
  for (std::size_t k = 0; k < structures_.size(); ++k) {
    if (structures_[k].get() != &structure) continue;
    ports_.push_back({static_cast<int>(k), shape, (*port_motion_)(static_cast<int>(k), shape), 0.0});
    return Port(*this, ports_.size() - 1);
  }
  throw ModelError(fmt::format("structure \"{}\" does not belong to system \"{}\"", structure.name(), name_));
}

void System::update_loops(State& state) const {
  double* memory = state.loops.data();
  for (const auto& loop : loops_) {
    loop->write_memory(memory);
    memory += loop->memory_size();
  }
}

}  // namespace easydyn

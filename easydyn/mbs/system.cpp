#include "easydyn/mbs/system.hpp"

#include <fmt/format.h>

#include "easydyn/error.hpp"

namespace easydyn {

using Eigen::MatrixXd;
using Eigen::VectorXd;

System::System(std::string name) : name_(std::move(name)) {}
System::~System() = default;

Coordinate System::coordinate(std::string name, double initial, double initial_rate) {
  require_new_name(coordinates_, "coordinates", name);
  if (!std::isfinite(initial) || !std::isfinite(initial_rate))
    throw ModelError(fmt::format("coordinate \"{}\": initial value {} and rate {} must be finite", name,
                                 initial, initial_rate));
  coordinates_.push_back({.name = std::move(name), .initial = initial, .initial_rate = initial_rate});
  assign_slots();
  return Coordinate(*this, static_cast<int>(coordinates_.size()) - 1);
}

namespace {
template <class Thing>
const std::string& name_of(const Thing& thing) {
  if constexpr (requires { thing.name(); }) {
    return thing.name();
  } else if constexpr (requires { thing->name(); }) {
    return thing->name();
  } else {
    return thing.name;
  }
}
}  // namespace

template <class Things>
void System::require_new_name(const Things& things, const char* kind, const std::string& name) const {
  for (const auto& thing : things)
    if (name_of(thing) == name)
      throw ModelError(fmt::format("system \"{}\": there are two {} named \"{}\"", name_, kind, name));
}

void System::assign_slots() {
  ++revision_;
  free_.clear();
  for (std::size_t i = 0; i < coordinates_.size(); ++i)
    if (!coordinates_[i].is_held) {
      coordinates_[i].slot = static_cast<int>(free_.size());
      free_.push_back(static_cast<int>(i));
    }
  free_count_ = slot_count_ = static_cast<int>(free_.size());
  for (CoordinateData& c : coordinates_)
    if (c.is_held) c.slot = slot_count_++;
  for (ReactionData& r : reactions_) {
    r.slot = slot_count_;
    slot_count_ += 6;
  }
  const std::size_t n = slot_count_ > free_count_ ? static_cast<std::size_t>(slot_count_) : 0;
  qd_all_.resize(n);
  qdd_all_.resize(n);
  r_all_.resize(n);
}

VelocityConstraint& System::velocity_constraint(std::string name) {
  require_new_name(constraints_, "velocity constraints", name);
  ++revision_;
  return constraints_.emplace_back(std::move(name));
}

FirstOrderState System::first_order_state(std::string name, double initial) {
  require_new_name(first_order_, "first-order states", name);
  ++revision_;
  if (!std::isfinite(initial))
    throw ModelError(fmt::format("first-order state \"{}\": initial value {} must be finite", name, initial));
  first_order_.push_back({std::move(name), initial});
  rates_.push_back(0);
  return FirstOrderState(*this, first_order_size() - 1);
}

Input System::input(std::string name, double value) {
  require_new_name(inputs_, "inputs", name);
  inputs_.push_back({std::move(name), 0});
  const Input input(*this, input_size() - 1);
  input.set(value);
  return input;
}

Output System::output(std::string name, std::function<double()> value) {
  require_new_name(outputs_, "outputs", name);
  outputs_.push_back({std::move(name), 0});
  output_functions_.push_back(std::move(value));
  return Output(*this, output_size() - 1);
}

void System::set_input(int i, double value) {
  NamedValue& input = inputs_[static_cast<std::size_t>(i)];
  if (!std::isfinite(value))
    throw ModelError(fmt::format("input \"{}\" = {}, must be finite", input.name, value));
  input.value = value;
}

Reaction System::reaction(std::string name) {
  require_new_name(reactions_, "reactions", name);
  reactions_.push_back({.name = std::move(name),
                        .slot = 0,
                        .force = Eigen::Vector3d::Zero(),
                        .moment = Eigen::Vector3d::Zero()});
  assign_slots();
  return Reaction(*this, static_cast<int>(reactions_.size()) - 1);
}

Body& System::body(std::string name, const Inertia& inertia) {
  require_new_name(bodies_, "bodies", name);
  return bodies_.emplace_back(std::move(name), inertia);
}

FlexibleBody& System::flexible_body(std::string name, const FlexibleModel& model, const ShapeOptions& shapes,
                                    double damping_ratio) {
  require_new_name(flexible_bodies_, "flexible bodies", name);
  flexible_bodies_.push_back(
      std::unique_ptr<FlexibleBody>(new FlexibleBody(*this, std::move(name), model, shapes, damping_ratio)));
  return *flexible_bodies_.back();
}

std::shared_ptr<LoopClosure> System::add_loop(const std::string& name, std::span<const double> guess) {
  require_new_name(loops_, "loops", name);
  constexpr int first_unknown = 1 << 24;  // in gradients, beyond all coordinates
  loops_.push_back(std::make_shared<LoopClosure>(name_, name, guess, first_unknown + loop_unknowns_));
  loop_unknowns_ += static_cast<int>(guess.size());
  return loops_.back();
}

LinearStructure& System::structure(std::string name, SparseMatrix M, SparseMatrix C, SparseMatrix K) {
  require_new_name(structures_, "structures", name);
  ++revision_;
  structures_.push_back(
      std::make_unique<LinearStructure>(std::move(name), std::move(M), std::move(C), std::move(K)));
  return *structures_.back();
}

int System::size() const {
  return structure_offset(static_cast<int>(structures_.size()));
}

int System::structure_offset(int k) const {
  int offset = body_size();
  for (int i = 0; i < k; ++i) offset += structures_[static_cast<std::size_t>(i)]->size();
  return offset;
}

std::string System::coordinate_name(int i) const {
  if (i < body_size()) return coordinates_[static_cast<std::size_t>(free_[static_cast<std::size_t>(i)])].name;
  i -= body_size();
  for (const auto& s : structures_) {
    if (i < s->size()) return fmt::format("{}[{}]", s->name(), i);
    i -= s->size();
  }
  return "?";
}

std::string System::equation_name(int i) const {
  if (i < body_size()) return coordinate_name(i);
  i -= body_size();
  if (i < first_order_size()) return first_order_[static_cast<std::size_t>(i)].name;
  return constraints_[static_cast<std::size_t>(i - first_order_size())].name();
}

State System::initial_state() const {
  State state;
  state.q = state.qd = state.qdd = VectorXd::Zero(size());
  for (const CoordinateData& c : coordinates_) {
    if (c.is_held) continue;
    state.q[c.slot] = c.initial;
    state.qd[c.slot] = c.initial_rate;
  }
  state.x = state.xd = VectorXd::Zero(first_order_size());
  for (int i = 0; i < first_order_size(); ++i) state.x[i] = first_order_[static_cast<std::size_t>(i)].value;
  state.lambda = VectorXd::Zero(constraint_size());
  state.charts = initial_charts_;
  state.loops.resize(loop_unknowns_ + static_cast<int>(loops_.size()));
  double* memory = state.loops.data();
  for (const auto& loop : loops_) {
    loop->write_guess(memory);
    memory += loop->memory_size();
  }
  return state;
}

void System::update_loops(State& state) const {
  double* memory = state.loops.data();
  for (const auto& loop : loops_) {
    loop->write_memory(memory);
    memory += loop->memory_size();
  }
}

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

EnergyBalance System::compute_energy(const State& state) {
  evaluate(state);
  EnergyBalance e{tree_.kinetic_energy(), tree_.energy().potential, tree_.energy().dissipated,
                  tree_.energy().supplied};
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

}  // namespace easydyn

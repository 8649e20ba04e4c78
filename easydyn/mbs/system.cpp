#include "easydyn/mbs/system.hpp"

#include <fmt/format.h>

#include "easydyn/error.hpp"

namespace easydyn {

using Eigen::MatrixXd;
using Eigen::VectorXd;

Coordinate::operator Expr() const {
  return Expr::coordinate(index_, value(), rate());
}

double Coordinate::value() const {
  if (!system_->q_) throw ModelError("a coordinate has a value in positions() and forces() only");
  return system_->q_[index_];
}

double Coordinate::rate() const {
  if (!system_->qd_) throw ModelError("a coordinate has a rate in positions() and forces() only");
  return system_->qd_[index_];
}

System::System(std::string name) : name_(std::move(name)) {}
System::~System() = default;

Coordinate System::coordinate(std::string name, double initial, double initial_rate) {
  for (const CoordinateData& c : coordinates_)
    if (c.name == name)
      throw ModelError(fmt::format("system \"{}\": there are two coordinates named \"{}\"", name_, name));
  if (!std::isfinite(initial) || !std::isfinite(initial_rate))
    throw ModelError(fmt::format("coordinate \"{}\": initial value {} and rate {} must be finite", name,
                                 initial, initial_rate));
  coordinates_.push_back({std::move(name), initial, initial_rate});
  return Coordinate(*this, static_cast<int>(coordinates_.size()) - 1);
}

Body& System::body(std::string name, const Inertia& inertia) {
  return bodies_.emplace_back(std::move(name), inertia);
}

LinearStructure& System::structure(std::string name, SparseMatrix M, SparseMatrix C, SparseMatrix K) {
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
  if (i < body_size()) return coordinates_[static_cast<std::size_t>(i)].name;
  i -= body_size();
  for (const auto& s : structures_) {
    if (i < s->size()) return fmt::format("{}[{}]", s->name(), i);
    i -= s->size();
  }
  return "?";
}

State System::initial_state() const {
  State state;
  state.q = state.qd = state.qdd = VectorXd::Zero(size());
  for (int i = 0; i < body_size(); ++i) {
    state.q[i] = coordinates_[static_cast<std::size_t>(i)].initial;
    state.qd[i] = coordinates_[static_cast<std::size_t>(i)].initial_rate;
  }
  return state;
}

void System::place(double t, const double* q, const double* qd, const PortMotionFunction& motion) {
  // Coordinates and ports answer during the evaluation only, however it ends.
  struct Reset {
    System& s;
    ~Reset() { s.q_ = s.qd_ = nullptr, s.port_motion_ = nullptr; }
  } reset{*this};
  t_ = t;
  q_ = q;
  qd_ = qd;
  port_motion_ = &motion;

  // Positions: the user's program builds the tree of motions.
  tree_.clear();
  ports_.clear();
  for (Body& b : bodies_) b.is_placed_ = false;
  {
    MotionTree::Scope scope(tree_);
    positions();
  }
  for (const Body& b : bodies_) {
    if (!b.is_placed_)
      throw ModelError(
          fmt::format("body \"{}\" of system \"{}\" is not placed by positions()", b.name(), name_));
    tree_.add_body(b.inertia_, b.frame_.rotation(), b.frame_.origin(), b.frame_.motion_index());
  }

  // Velocities, then the user's forces, which may use them.
  tree_.compute_velocities();
  forces();
}

void System::compute_body_residual(double t, const double* q, const double* qd, const double* qdd,
                                   const PortMotionFunction& motion, double* r) {
  place(t, q, qd, motion);
  tree_.compute_accelerations(qdd);
  std::fill(r, r + body_size(), 0.0);
  double drive_power = 0;
  tree_.add_residual(qd, r, &drive_power);
  tree_.energy().supplied += drive_power;
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
}

void System::compute_residual(const State& state, Eigen::Ref<VectorXd> r) {
  check_size(state);
  r.setZero();
  compute_body_residual(state.t, state.q.data(), state.qd.data(), state.qdd.data(), motion_of(state),
                        r.data());

  // Structures: inertia, damping and stiffness less the port forces.
  for (int k = 0; k < static_cast<int>(structures_.size()); ++k) {
    const LinearStructure& s = *structures_[static_cast<std::size_t>(k)];
    const int at = structure_offset(k);
    r.segment(at, s.size()) = s.M() * state.qdd.segment(at, s.size()) +
                              s.C() * state.qd.segment(at, s.size()) + s.K() * state.q.segment(at, s.size());
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
  place(state.t, state.q.data(), state.qd.data(), motion_of(state));
  MatrixXd M = MatrixXd::Zero(size(), size());
  tree_.add_mass_matrix(M.topLeftCorner(body_size(), body_size()));
  for (int k = 0; k < static_cast<int>(structures_.size()); ++k) {
    const LinearStructure& s = *structures_[static_cast<std::size_t>(k)];
    M.block(structure_offset(k), structure_offset(k), s.size(), s.size()) = MatrixXd(s.M());
  }
  return M;
}

VectorXd System::compute_bias(const State& state) {
  State without_acceleration = state;
  without_acceleration.qdd.setZero();
  return compute_residual(without_acceleration);
}

void System::compute_mass_and_bias(const State& state, Eigen::Ref<MatrixXd> M, Eigen::Ref<VectorXd> bias) {
  place(state.t, state.q.data(), state.qd.data(), motion_of(state));
  tree_.compute_accelerations(nullptr);
  bias.setZero();
  tree_.add_residual(state.qd.data(), bias.data(), nullptr);
  M.setZero();
  tree_.add_mass_matrix(M);
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
  VectorXd r(body_size());
  compute_body_residual(state.t, state.q.data(), state.qd.data(), state.qdd.data(), motion_of(state),
                        r.data());
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

#include "easydyn/mbs/system.hpp"

#include <fmt/format.h>

#include "easydyn/error.hpp"

namespace easydyn {

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

}  // namespace easydyn

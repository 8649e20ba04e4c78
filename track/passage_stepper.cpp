#include "track/passage_stepper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "easydyn/require.hpp"

namespace easydyn::track {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// Magnitudes below which an unknown counts as zero: m/s^2 or rad/s^2, N. Forces of 1e5 N at lever arms of a train's length,
// 200 m, leave a bogie's pitch to 2e-11 rad/s^2.
constexpr double acceleration_floor = 1, force_floor = 1;

int bays_of(const TrackModel& model, double length) {
  require_not_negative(model.data().label(), "window", length, "m");
  return static_cast<int>(std::ceil(length / model.data().sleeper_spacing));
}

}  // namespace

PassageStepper::PassageStepper(System& system, const FlexibleTrack& track,
                               std::vector<const TrackContact*> contacts, const State& start,
                               const PassageStepperOptions& options)
    : system_(system),
      track_(track),
      options_(options),
      window_(track.model(), bays_of(track.model(), options.window), options.step),
      start_(start.t),
      t_(start.t) {
  const char* const passage = "passage";
  require_positive(passage, "tolerance", options.tolerance, "");
  if (system.first_order_size() > 0 || system.constraint_size() > 0 || system.structures().size() != 1)
    throw ModelError(fmt::format(
        "passage: system \"{}\" has {} first-order states, {} velocity constraints and {} structures, must "
        "have none, none and one; use the integrators of the kernel",
        system.name(), system.first_order_size(), system.constraint_size(), system.structures().size()));
  const int n = system.body_size();
  q_ = start.q.head(n);
  qd_ = start.qd.head(n);
  qdd_ = start.qdd.head(n);

  // The first evaluation tells where the track is touched, and the forces.
  system_.evaluate(start);
  const auto& ports = system_.ports();
  const TrackModel& model = track.model();
  const std::vector<int>& hanging = model.hanging_sleepers();
  std::map<int, int> sleeper_at;  // by the first coordinate that its ballast touches
  for (const int j : hanging) sleeper_at[model.ballast_shape(j).index[0]] = j;
  std::size_t next_contact = 0;
  for (const System::PortRecord& port : ports) {
    const auto sleeper = sleeper_at.find(port.shape.index[0]);
    if (sleeper != sleeper_at.end())
      partners_.push_back({nullptr, model.unilateral_ballast(sleeper->second), -1});
    else if (next_contact++ < contacts.size())
      partners_.push_back({contacts[next_contact - 1], {}, 1});
  }
  if (ports.size() != contacts.size() + hanging.size() || next_contact != contacts.size())
    throw ModelError(fmt::format(
        "passage: system \"{}\" touches the track in {} places, {} contacts are given and {} sleepers hang",
        system.name(), ports.size(), contacts.size(), hanging.size()));
  const auto n_ports = static_cast<Eigen::Index>(ports.size());
  F_.resize(n_ports);
  for (std::size_t p = 0; p < ports.size(); ++p) {
    shapes_.push_back(ports[p].shape);
    F_[static_cast<Eigen::Index>(p)] = ports[p].force;
  }
  free_.resize(ports.size());
  F_evaluated_ = F_;
  residual_.resize(n);
  track_response_.setZero(n_ports, n_ports);
  slope_response_.setZero(n_ports, n_ports);

  window_.set_state(window_.is_whole_track() ? 0 : wanted_first_bay(), track.coordinates(start.q),
                    track.coordinates(start.qd), track.coordinates(start.qdd));
  motion_ = [this](int, const PortShape& shape) {
    const std::size_t p = port_++;
    shapes_[p] = shape;
    free_[p] = window_.free_motion(shape);
    PortMotion motion = free_[p];
    if (!knows_responses_) return motion;
    const double h = options_.step;
    const auto i = static_cast<Eigen::Index>(p);
    for (Eigen::Index j = 0; j < F_.size(); ++j) {
      const double y = track_response_(i, j) * F_[j];
      if (y == 0) continue;
      motion.displacement += 0.25 * h * h * y;
      motion.velocity += 0.5 * h * y;
      motion.slope += 0.25 * h * h * slope_response_(i, j) * F_[j];
    }
    return motion;
  };
}

// The contacts in the middle; a bay is left behind when the middle has moved by one.
int PassageStepper::wanted_first_bay() const {
  int least = std::numeric_limits<int>::max(), largest = 0;
  const int per_bay = track_.model().dofs_per_bay();
  for (std::size_t p = 0; p < shapes_.size(); ++p) {
    if (!partners_[p].contact) continue;
    least = std::min(least, shapes_[p].index[0] / per_bay);
    largest = std::max(largest, shapes_[p].index[0] / per_bay);
  }
  const int room = track_.model().data().ends.bays + window_.reach() + 1;
  require(
      window_.bays() >= largest - least + 2 * room, track_.model().data().label(), "window",
      window_.bays() * track_.model().data().sleeper_spacing, "m",
      fmt::format(
          ">= {:.1f}: the train, on each side {} absorbing bays and {} that its contacts move within a step",
          (largest - least + 2 * room) * track_.model().data().sleeper_spacing.value,
          track_.model().data().ends.bays, window_.reach() + 1));
  return (least + largest) / 2 - window_.bays() / 2;
}

// At the trial q_, qd_, qdd_ and F_: the bodies' residual without contacts, and the forces that the contacts apply.
void PassageStepper::evaluate() {
  const double h = options_.step;
  q_ = q_star_ + 0.25 * h * h * qdd_;
  qd_ = qd_star_ + 0.5 * h * qdd_;
  port_ = 0;
  system_.compute_body_residual({.t = t_, .q = q_.data(), .qd = qd_.data(), .qdd = qdd_.data()}, motion_,
                                residual_.data());
  ++statistics_.evaluations;
  for (Eigen::Index p = 0; p < F_.size(); ++p)
    F_evaluated_[p] = system_.ports()[static_cast<std::size_t>(p)].force;
  if (B_.size() > 0) residual_.noalias() += B_.transpose() * F_evaluated_;
}

// J of the bodies without contacts, by differences, and what follows from it. Leaves the system evaluated at the trial.
void PassageStepper::compute_jacobian() {
  const int n = system_.body_size();
  B_.setZero(F_.size(), n);
  for (Eigen::Index p = 0; p < F_.size(); ++p) {
    const Body* const body = partners_[static_cast<std::size_t>(p)].body();
    if (!body) continue;
    const ExprVector at = body->frame().express_point(Eigen::Vector3d::Zero());
    for (const Gradient::Entry& g : at[2].gradient())
      if (g.coordinate < n) B_(p, g.coordinate) = g.value;
  }
  evaluate();
  const VectorXd residual = residual_, trial = qdd_;
  MatrixXd J(n, n);
  for (int i = 0; i < n; ++i) {
    const double delta = 100;  // [m/s^2]: the bodies are nearly linear, and rounding stays small
    qdd_[i] = trial[i] + delta;
    evaluate();
    J.col(i) = (residual_ - residual) / delta;
    qdd_[i] = trial[i];
  }
  evaluate();
  inverse_ = n > 0 ? MatrixXd(J.partialPivLu().inverse()) : J;
  body_response_ = B_ * inverse_ * B_.transpose();
  jacobian_known_ = true;
  ++statistics_.jacobians;
}

void PassageStepper::update_responses() {
  for (Eigen::Index i = 0; i < F_.size(); ++i)
    for (Eigen::Index j = 0; j < F_.size(); ++j) {
      const PortShape &at = shapes_[static_cast<std::size_t>(i)], &of = shapes_[static_cast<std::size_t>(j)];
      const TrackWindow::Response r = window_.response(at, of);
      track_response_(i, j) = r.acceleration;
      slope_response_(i, j) = r.slope;
    }
  const double h = options_.step;
  response_ = 0.25 * h * h * (track_response_ + body_response_);
  knows_responses_ = true;
}

TrackContact::Force PassageStepper::force_after(std::size_t port, double change, double rate_change) const {
  const Partner& partner = partners_[port];
  if (partner.contact) return partner.contact->force_after(change, rate_change);
  const PortMotion& motion = system_.ports()[port].motion;
  const double compression = motion.displacement + change, rate = motion.velocity + rate_change;
  const UnilateralBallast& ballast = partner.ballast;
  const double F = ballast.force(compression, rate);
  if (F == 0) return {};
  return {F, ballast.stiffness,
          std::min(1.0, (compression - ballast.gap) / (0.1 * ballast.gap)) * ballast.damping};
}

// Forces that agree with the approaches that they leave, from the forces of the last evaluation. correction_ holds the
// bodies' accelerations without contact forces, less those of the trial.
void PassageStepper::find_contact_forces() {
  const double h = options_.step;
  const Eigen::Index n = F_.size();
  // Change of each approach, from the one evaluated to the one without any force; it falls as the port moves in the
  // direction of its force.
  approach_.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto p = static_cast<std::size_t>(i);
    approach_[i] = partners_[p].direction * (system_.ports()[p].motion.displacement - free_[p].displacement);
  }
  approach_.noalias() -= 0.25 * h * h * (B_ * correction_);

  constexpr int most_sweeps = 200, most_iterations = 100;
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    double largest_change = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      // d + p F(a + d) = free, monotone in the change d of the approach: Newton within brackets.
      const auto port = static_cast<std::size_t>(i);
      const double direction = partners_[port].direction, p = response_(i, i);
      const double free = approach_[i] - direction * (response_.col(i).dot(F_) - p * F_[i]);
      double d = free - p * direction * F_[i], low = -std::numeric_limits<double>::infinity(), high = free;
      for (int k = 0; k < most_iterations; ++k) {
        const TrackContact::Force law = force_after(port, d, 2 / h * d);
        const double miss = d + p * law.F - free;
        (miss > 0 ? high : low) = d;
        double next = d - miss / (1 + p * (law.stiffness + 2 / h * law.damping));
        if (!(next >= low && next <= high)) next = std::isfinite(low) ? 0.5 * (low + high) : high;
        const bool is_done = std::abs(next - d) <= 1e-15 * (std::abs(free) + std::abs(d));
        d = next;
        if (is_done) break;
      }
      const double F = direction * force_after(port, d, 2 / h * d).F;
      largest_change = std::max(largest_change, std::abs(F - F_[i]) / std::max(std::abs(F), force_floor));
      F_[i] = F;
    }
    if (largest_change <= 0.01 * options_.tolerance) break;
  }
}

void PassageStepper::step() {
  const double h = options_.step;
  if (!window_.is_whole_track()) {
    const int wanted = wanted_first_bay();
    if (wanted != window_.first_bay()) {
      window_.move_to(wanted);
      ++statistics_.moves;
    }
  }
  window_.predict();
  t_ = start_ + static_cast<double>(statistics_.steps + 1) * h;
  q_star_ = q_ + h * qd_ + 0.25 * h * h * qdd_;
  qd_star_ = qd_ + 0.5 * h * qdd_;
  knows_responses_ = false;
  if (jacobian_known_)
    evaluate();
  else
    compute_jacobian();
  update_responses();

  double previous = std::numeric_limits<double>::infinity();
  for (int iteration = 0;; ++iteration) {
    // Contact forces, then the accelerations that they give to the bodies.
    correction_.noalias() = -(inverse_ * residual_);
    find_contact_forces();
    lift_.noalias() = B_.transpose() * F_;
    correction_.noalias() += inverse_ * lift_;
    qdd_ += correction_;
    evaluate();

    // The true residual at the new trial.
    lift_ -= residual_;
    correction_.noalias() = inverse_ * lift_;
    double error = 0;
    for (Eigen::Index i = 0; i < correction_.size(); ++i)
      error = std::max(error, std::abs(correction_[i]) / std::max(std::abs(qdd_[i]), acceleration_floor));
    for (Eigen::Index p = 0; p < F_.size(); ++p)
      error = std::max(error, std::abs(F_evaluated_[p] - F_[p]) / std::max(std::abs(F_[p]), force_floor));
    // Smaller than that, and no longer falling: the last digits of the displacements.
    const bool is_rounding = error <= 1e-3 * std::sqrt(options_.tolerance) && error >= 0.5 * previous;
    if (error <= options_.tolerance || is_rounding) break;
    if (!std::isfinite(error) || iteration >= options_.max_iterations)
      throw SolverError(
          fmt::format("passage: no convergence at t = {} s with step {} s after {} iterations, last "
                      "relative correction {:.3g}; try a smaller step",
                      t_, h, iteration, error));
    if (error > 0.1 * previous && error > 1e-6) {
      compute_jacobian();
      update_responses();
    }
    previous = error;
  }
  window_.accept(shapes_, F_);
  ++statistics_.steps;
}

EnergyBalance PassageStepper::energy() const {
  EnergyBalance e = system_.body_energy();
  e.kinetic += window_.kinetic_energy();
  e.potential += window_.potential_energy();
  return e;
}

}  // namespace easydyn::track

#include "track/passage.hpp"

#include <cmath>
#include <limits>

#include "easydyn/require.hpp"
#include "easydyn/sim/implicit_stepper.hpp"
#include "easydyn/sim/static_equilibrium.hpp"
#include "track/contact_loss_counter.hpp"

namespace easydyn::track {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

// Fills the rows of a Passage from states.
class PassageRecorder {
 public:
  PassageRecorder(System& system, const FlexibleTrack& track,
                  const std::vector<const TrackContact*>& contacts, const PassageOptions& options, Index rows)
      : system_(system), track_(track), contacts_(contacts) {
    const TrackModel& model = track.model();
    for (int j = 0; j < model.sleepers(); ++j)
      if (model.sleeper_x(j) >= options.first_sleeper_x - 1e-9 &&
          model.sleeper_x(j) <= options.last_sleeper_x + 1e-9)
        sleepers_.push_back(j);
    if (sleepers_.empty())
      throw ModelError(
          fmt::format("passage: no sleeper stands from {} m to {} m (first_sleeper_x, last_sleeper_x); "
                      "the track has them from {} m to {} m",
                      options.first_sleeper_x, options.last_sleeper_x, model.begin(), model.end()));
    const auto ns = static_cast<Index>(sleepers_.size());
    const auto nw = static_cast<Index>(contacts.size()), nb = static_cast<Index>(system.bodies().size());
    p_.time.resize(rows);
    p_.sleeper_x.resize(ns);
    for (Index s = 0; s < ns; ++s) p_.sleeper_x[s] = model.sleeper_x(sleepers_[static_cast<std::size_t>(s)]);
    for (auto* matrix : {&p_.rail_deflection, &p_.sleeper_displacement, &p_.ballast_reaction})
      matrix->resize(rows, ns);
    has_foundation_ = model.foundation_dof(0) >= 0;
    if (has_foundation_) p_.foundation_displacement.resize(rows, ns);
    p_.contact_force.resize(rows, nw);
    p_.contact_position.resize(rows, nw);
    p_.foundation = kind_of(track.model().data().foundation);
    p_.largest_contact_force.setZero(nw);
    p_.smallest_contact_force.setConstant(nw, std::numeric_limits<double>::infinity());
    p_.contact_losses.setZero(nw);
    p_.contact_loss_time.setZero(nw);
    p_.longest_contact_loss.setZero(nw);
    losses_.resize(contacts.size());
    for (const TrackContact* c : contacts) p_.contact_names.push_back(c->name());
    p_.coordinates.resize(rows, system.body_size());
    for (int i = 0; i < system.body_size(); ++i) p_.coordinate_names.push_back(system.coordinate_name(i));
    p_.body_acceleration.resize(rows, nb);
    p_.body_height.resize(rows, nb);
    p_.body_pitch.resize(rows, nb);
    for (const Body& b : system.bodies()) p_.body_names.push_back(b.name());
    for (auto* energy :
         {&p_.kinetic_energy, &p_.potential_energy, &p_.dissipated_energy, &p_.supplied_energy})
      energy->setZero(rows);
  }

  /// What must see every step, whether it is recorded or not: contact forces, and powers (trapezoidal rule).
  /// @param now               the system has just been evaluated there
  /// @param track_dissipated  energy that the track has turned into heat since the last call, if not in `now` [J]
  void watch(double t, const EnergyBalance& now, double track_dissipated) {
    const double h = t - last_time_;
    for (std::size_t w = 0; w < contacts_.size(); ++w) {
      double& largest = p_.largest_contact_force[static_cast<Index>(w)];
      double& smallest = p_.smallest_contact_force[static_cast<Index>(w)];
      largest = std::max(largest, contacts_[w]->force());
      smallest = std::min(smallest, contacts_[w]->force());
      ContactLossCounter& losses = losses_[w];
      losses.update(t, contacts_[w]->is_closed());
      p_.contact_losses[static_cast<Index>(w)] = losses.count();
      p_.contact_loss_time[static_cast<Index>(w)] = losses.total_duration();
      p_.longest_contact_loss[static_cast<Index>(w)] = losses.longest_duration();
    }
    if (has_last_) {
      dissipated_ += 0.5 * h * (last_.dissipated + now.dissipated) + track_dissipated;
      supplied_ += 0.5 * h * (last_.supplied + now.supplied);
    }
    last_ = now;
    last_time_ = t;
    has_last_ = true;
  }

  /// After watch(), at the same time.
  /// @param q_bodies   coordinates of the bodies
  /// @param q, qd      coordinate i of the track, and its rate
  template <class Coordinate>
  void record(const Eigen::Ref<const VectorXd>& q_bodies, double kinetic, double potential, Coordinate q,
              Coordinate qd) {
    const TrackModel& model = track_.model();
    p_.time[row_] = last_time_;
    for (Index s = 0; s < p_.sleeper_x.size(); ++s) {
      const int j = sleepers_[static_cast<std::size_t>(s)];
      p_.rail_deflection(row_, s) = q(model.rail_dof(j * model.data().elements_per_bay));
      p_.sleeper_displacement(row_, s) = q(model.sleeper_dof(j));
      if (has_foundation_) p_.foundation_displacement(row_, s) = q(model.foundation_dof(j));
      p_.ballast_reaction(row_, s) = model.ballast_reaction(j, q, qd);
    }
    for (std::size_t w = 0; w < contacts_.size(); ++w) {
      p_.contact_force(row_, static_cast<Index>(w)) = contacts_[w]->force();
      p_.contact_position(row_, static_cast<Index>(w)) = contacts_[w]->x();
    }
    p_.coordinates.row(row_) = q_bodies.transpose();
    Index b = 0;
    for (const Body& body : system_.bodies()) {
      p_.body_acceleration(row_, b) = body.acceleration().z();
      p_.body_height(row_, b) = body.position().z();
      p_.body_pitch(row_, b) = std::atan2(body.frame().rotation()(0, 2), body.frame().rotation()(2, 2));
      ++b;
    }
    p_.kinetic_energy[row_] = kinetic;
    p_.potential_energy[row_] = potential;
    p_.dissipated_energy[row_] = dissipated_;
    p_.supplied_energy[row_] = supplied_;
    ++row_;
  }

  std::size_t memory() const {
    const Index doubles = p_.rail_deflection.size() + p_.sleeper_displacement.size() +
                          p_.foundation_displacement.size() + p_.ballast_reaction.size() +
                          p_.contact_force.size() + p_.contact_position.size() + p_.coordinates.size() +
                          p_.body_acceleration.size() + p_.body_height.size() + p_.body_pitch.size();
    return 8 * static_cast<std::size_t>(doubles);
  }

  Passage& passage() { return p_; }

 private:
  System& system_;
  const FlexibleTrack& track_;
  const std::vector<const TrackContact*>& contacts_;
  std::vector<int> sleepers_;
  std::vector<ContactLossCounter> losses_;
  bool has_foundation_ = false, has_last_ = false;
  EnergyBalance last_;
  double last_time_ = 0, dissipated_ = 0, supplied_ = 0;
  Index row_ = 0;
  Passage p_;
};

// The ballast is linear and holds less pull than the weight above it.
void warn_of_uplift(Passage& p, const TrackData& data) {
  constexpr double g = 9.81;
  // What lies above the springs whose force is the reaction.
  p.track_weight = g * (data.sleeper_mass + data.rails * data.rail.mass_per_length * data.sleeper_spacing +
                        (data.slab ? data.slab->mass_per_length * data.sleeper_spacing : 0.0) +
                        (data.ballast_mass ? double(data.ballast_mass->mass) : 0.0));
  Index row = 0, sleeper = 0;
  const double least = p.ballast_reaction.minCoeff(&row, &sleeper);
  if (least >= -p.track_weight) return;
  p.warnings.push_back(
      fmt::format("uplift: the ballast at x = {:.2f} m pulls with {:.2f} kN at t = {:.3f} s, more than the "
                  "weight of track above "
                  "it ({:.2f} kN); a real sleeper would lift off, the linear ballast does not",
                  p.sleeper_x[sleeper], -1e-3 * least, p.time[row], 1e-3 * p.track_weight));
}

using Report = std::function<void(long steps)>;  // steps done since the start of the run-in

template <class Run>
void run_with_kernel(System& system, const FlexibleTrack& track, const State& start, long run_in,
                     const PassageOptions& options, const Report& report, PassageRecorder& recorder,
                     Passage& passage, Run run) {
  Newmark integrator(system, start, {.step = options.step});
  for (long i = 1; i <= run_in; ++i) {
    integrator.step();
    report(i);
  }
  EnergyBalance energy;
  const auto watch = [&] {
    energy = system.compute_energy(integrator.state());
    recorder.watch(integrator.state().t, energy, 0);
  };
  watch();
  run(
      [&] {
        integrator.step();
        watch();
      },
      [&] {
        const VectorXd q = track.coordinates(integrator.state().q),
                       qd = track.coordinates(integrator.state().qd);
        const std::function<double(int)> q_of = [&](int i) { return q[i]; },
                                         qd_of = [&](int i) { return qd[i]; };
        recorder.record(integrator.state().q.head(system.body_size()), energy.kinetic, energy.potential, q_of,
                        qd_of);
      });
  passage.statistics = {.steps = integrator.statistics().steps,
                        .evaluations = integrator.statistics().evaluations};
  passage.memory = recorder.memory();
}

template <class Run>
void run_with_window(System& system, const FlexibleTrack& track,
                     const std::vector<const TrackContact*>& contacts, const State& start, long run_in,
                     const PassageOptions& options, const Report& report, PassageRecorder& recorder,
                     Passage& passage, Run run) {
  PassageStepper stepper(system, track, {contacts.begin(), contacts.end()}, start,
                         {.step = options.step, .window = options.window});
  for (long i = 1; i <= run_in; ++i) {
    stepper.step();
    report(i);
  }
  recorder.watch(stepper.t(), system.body_energy(), 0);
  const TrackWindow& window = stepper.window();
  run(
      [&] {
        stepper.step();
        recorder.watch(stepper.t(), system.body_energy(), window.dissipated_in_step());
      },
      [&] {
        const EnergyBalance energy = stepper.energy();
        const std::function<double(int)> q = [&](int i) { return window.q(i); },
                                         qd = [&](int i) { return window.qd(i); };
        recorder.record(stepper.q(), energy.kinetic, energy.potential, q, qd);
      });
  passage.statistics = stepper.statistics();
  passage.memory = recorder.memory() + window.memory();
}

}  // namespace

Passage compute_passage(System& system, const FlexibleTrack& track,
                        const std::vector<const TrackContact*>& contacts, const PassageOptions& options,
                        const std::function<void(double)>& progress) {
  require_positive("passage", "duration", options.duration, "s");
  require_positive("passage", "time step", options.step, "s");
  require_positive("passage", "output step", options.output_step, "s");
  const double ratio = options.output_step / options.step;
  const auto every = static_cast<Index>(std::lround(ratio));
  require(every >= 1 && std::abs(ratio - static_cast<double>(every)) < 1e-6 * ratio, "passage", "output step",
          options.output_step, "s", fmt::format("a multiple of the time step {} s", options.step));

  require_not_negative("passage", "run-in", options.run_in, "s");
  const long run_in = std::lround(std::ceil(options.run_in / options.step - 1e-9));
  State guess = system.initial_state();
  guess.t = -static_cast<double>(run_in) * options.step;
  const State start = solve_quasi_static_motion(system, guess, options.start_difference);
  const auto outputs = static_cast<Index>(std::ceil(options.duration / options.output_step - 1e-9));
  PassageRecorder recorder(system, track, contacts, options, outputs + 1);
  const State at_rest = solve_static_equilibrium(system, guess);
  recorder.passage().static_ballast_reaction =
      track.model().ballast_reactions(track.coordinates(at_rest.q), track.coordinates(at_rest.qd)).sum();

  const double steps = static_cast<double>(run_in + outputs * every);
  const Report report = [&](long done) {
    if (progress && done % every == 0) progress(static_cast<double>(done) / steps);
  };
  const auto run = [&](auto step_and_watch, auto record) {
    record();
    for (Index i = 1; i <= outputs; ++i) {
      for (Index k = 0; k < every; ++k) step_and_watch();
      record();
      report(run_in + i * every);
    }
  };
  Passage& passage = recorder.passage();
  if (options.use_kernel)
    run_with_kernel(system, track, start, run_in, options, report, recorder, passage, run);
  else
    run_with_window(system, track, contacts, start, run_in, options, report, recorder, passage, run);
  warn_of_uplift(passage, track.model().data());
  return std::move(passage);
}

}  // namespace easydyn::track

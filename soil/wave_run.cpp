// How a run of the wave solver goes: steps, outputs, checkpoints, its end.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "easydyn/error.hpp"
#include "soil/agreement.hpp"
#include "soil/checkpoint.hpp"
#include "soil/time_error.hpp"
#include "soil/wave_solver_impl.hpp"

namespace easydyn::soil {
namespace {

// A few hundredths of a second; less often than after every step, because all ranks wait for it.
constexpr long steps_between_agreements = 16;

}  // namespace

void WaveSolver::Impl::update_surface_forces(double t) {
  history.update_forces(t, forces);
  node_forces.clear();
  for (std::size_t f = 0; f < footprints.size(); ++f) {
    const double force = forces(static_cast<Eigen::Index>(f)) * taper(static_cast<Eigen::Index>(f));
    if (force == 0) continue;
    const int component = component_of(directions[f]);
    const double sign = component == 2 ? -1 : 1;  // z is upward
    for (const NodeWeight& n : footprints[f].force)
      node_forces.push_back({n.X, n.Y, sign * force * n.weight, component});
  }
}

GroundMotion WaveSolver::Impl::make_motion() const {
  const Eigen::Index nt = outputs, nr = static_cast<Eigen::Index>(receivers.size()),
                     nl = static_cast<Eigen::Index>(footprints.size() + observed.size());
  GroundMotion motion;
  motion.taper = taper;
  motion.time = Eigen::VectorXd::Zero(nt);
  motion.energy = Eigen::VectorXd::Zero(nt);
  for (Eigen::MatrixXd* v : {&motion.vx, &motion.vy, &motion.vz}) *v = Eigen::MatrixXd::Zero(nt, nr);
  motion.footprint_displacement = Eigen::MatrixXd::Zero(nt, nl);
  return motion;
}

/// Velocity at an output time: mean of the half steps before and after it.
template <class T>
void WaveSolver::Impl::add_velocities(WaveEngine<T>& engine, Eigen::Index row, GroundMotion& motion) const {
  Eigen::MatrixXd* const velocity[3] = {&motion.vx, &motion.vy, &motion.vz};
  for (std::size_t r = 0; r < receivers.size(); ++r) {
    const ReceiverWeights& receiver = receivers[r];
    for (int c = 0; c < 3; ++c) {
      const double sign = (receiver.mirrored_x && (c == 0) != odd_x ? -1 : 1) *
                          (receiver.mirrored_y && (c == 1) != odd_y ? -1 : 1);
      (*velocity[c])(row, static_cast<Eigen::Index>(r)) +=
          0.5 * sign *
          weigh(receiver.nodes, [&](const NodeWeight& n) { return engine.velocity(c, n.X, n.Y, n.Z); });
    }
  }
}

template <class T>
double WaveSolver::Impl::compute_power(const WaveEngine<T>& engine) const {
  const int top = engine.nodes_z() - 1;
  double power = 0;
  for (const SurfaceNodeForce& n : node_forces)
    if (engine.owns_line(n.Y, top)) power += n.force * engine.velocity(n.component, n.X, n.Y, top);
  return power;
}

void WaveSolver::Impl::settle_work(RunPosition& position) {
  if (ranks) ranks->sum(unsettled_work.data(), unsettled_work.size());
  for (const double work : unsettled_work) position.guard.add_work(work);
  unsettled_work.clear();
}

void WaveSolver::Impl::check_energy(const EnergyGuard& guard, double energy, double kinetic_energy,
                                    long step) const {
  const auto fail = [&](const std::string& what) {
    throw SolverError(fmt::format(
        "wave solver: {} at t = {:.6g} s, step {} of {} (dt = {:.4g} s): lower step_safety (now {}) or use "
        "double_precision",
        what, time_of(step), step, steps(), dt, options.step_safety));
  };
  if (!guard.is_finite(energy)) fail("the motion is no longer finite");
  if (!guard.is_explained(kinetic_energy))
    fail(
        fmt::format("the motion grows by itself: its kinetic energy of {:.3g} J is more than {} times the "
                    "work of the loads, {:.3g} J,",
                    kinetic_energy, EnergyGuard::tolerance, guard.most_work()));
}

/// A wish of one rank is a wish of all.
RunWish WaveSolver::Impl::agree_on(RunWish wish) const {
  if (!ranks) return wish;
  double wishes[2] = {wish.stop ? 1.0 : 0.0, wish.save ? 1.0 : 0.0};
  ranks->maximise(wishes, 2);
  return {wishes[0] > 0, wishes[1] > 0};
}

/// Calls use(data, bytes) for the records of the first `rows` output times.
template <class Use>
void visit_records(GroundMotion& motion, Eigen::Index rows, const Use& use) {
  const auto bytes = static_cast<std::size_t>(rows) * sizeof(double);
  use(motion.time.data(), bytes);
  use(motion.energy.data(), bytes);
  for (Eigen::MatrixXd* record : {&motion.vx, &motion.vy, &motion.vz, &motion.footprint_displacement})
    for (Eigen::Index j = 0; j < record->cols(); ++j) use(record->col(j).data(), bytes);
}

double WaveSolver::Impl::compute_checkpoint_size() {
  double bytes = 2048;  // identity
  with_engine([&](auto& engine) {
    engine.visit_state([&](const void*, std::size_t field) { bytes += static_cast<double>(field); });
  });
  return bytes + 8.0 * static_cast<double>(outputs) *
                     static_cast<double>(2 + 3 * receivers.size() + footprints.size() + observed.size());
}

/// Of several ranks the first one's file is the checkpoint; it names the step whose files of the other ranks belong to
/// it. They are complete before it appears, and those of the step before it go after it: a whole set is always there.
template <class T>
void WaveSolver::Impl::save(const RunControl& control, WaveEngine<T>& engine, GroundMotion& motion,
                            RunPosition position) const {
  const std::filesystem::path path = rank_checkpoint_of(control.checkpoint, rank, position.step);
  const auto write_file = [&] {
    CheckpointWriter file(path, identity);
    const auto write = [&](const void* data, std::size_t bytes) { file.write(data, bytes); };
    file.write_value(position);
    visit_records(motion, rows_before(position.step), write);
    engine.visit_state(write);
    file.commit();
  };
  try {
    act_together(ranks, [&] {
      if (rank > 0) write_file();
    });
  } catch (const Error&) {  // no set: what this rank has written of it goes
    std::error_code ignored;
    if (rank > 0) std::filesystem::remove(path, ignored);
    throw;
  }
  act_on_first(ranks, write_file);
  if (rank > 0) remove_rank_checkpoints(control.checkpoint, rank, path);
}

template <class T>
RunPosition WaveSolver::Impl::read_checkpoint(const std::filesystem::path& path, WaveEngine<T>& engine,
                                              GroundMotion& motion) const {
  CheckpointReader file(path, identity);
  const auto read = [&](void* data, std::size_t bytes) { file.read(data, bytes); };
  RunPosition position;
  file.read_value(position);
  if (position.step < 0 || position.step > steps())
    throw InputError(fmt::format("{}: is damaged: step {} of {}", path.string(), position.step, steps()));
  visit_records(motion, rows_before(position.step), read);
  engine.visit_state(read);
  file.finish();
  return position;
}

template <class T>
RunPosition WaveSolver::Impl::load(const RunControl& control, WaveEngine<T>& engine,
                                   GroundMotion& motion) const {
  RunPosition position;
  act_on_first(ranks, [&] { position = read_checkpoint(control.checkpoint, engine, motion); });
  if (!ranks) return position;
  ranks->broadcast(&position.step, sizeof position.step, 0);
  act_together(ranks, [&] {
    if (rank > 0)
      position = read_checkpoint(rank_checkpoint_of(control.checkpoint, rank, position.step), engine, motion);
  });
  return position;
}

template <class T>
GroundMotion WaveSolver::Impl::run(WaveEngine<T>& engine, const RunControl& control) {
  engine.set_to_rest();
  unsettled_work.clear();
  GroundMotion motion = make_motion();
  RunPosition position = control.restart ? load(control, engine, motion) : RunPosition{};
  const long total = steps();
  snapshots->set_folder(control.snapshots);
  const bool takes_snapshots = !control.snapshots.empty();
  const auto displacement = [&](int c, int X, int Y, int Z) { return engine.displacement(c, X, Y, Z); };
  const auto velocity = [&](int c, int X, int Y, int Z) { return engine.velocity(c, X, Y, Z); };
  const auto tell = [&] {
    if (control.progress) control.progress(static_cast<double>(position.step) / static_cast<double>(total));
  };
  tell();
  auto told = std::chrono::steady_clock::now(), saved = told;
  while (position.step < total) {
    const long step = position.step;
    const bool output = step % steps_per_output == 0;
    const Eigen::Index row = output ? step / steps_per_output - preload_outputs : -1;
    if (row >= 0) {
      motion.time(row) = rank == 0 ? time_of(step) : 0;
      add_velocities(engine, row, motion);
      for (std::size_t f = 0; f < footprints.size(); ++f) {
        const int component = component_of(directions[f]);
        motion.footprint_displacement(row, static_cast<Eigen::Index>(f)) =
            (component == 2 ? -1 : 1) * weigh(footprints[f].mean, [&](const NodeWeight& n) {
              return engine.displacement(component, n.X, n.Y, n.Z);
            });
      }
      for (std::size_t f = 0; f < observed.size(); ++f)
        motion.footprint_displacement(row, static_cast<Eigen::Index>(footprints.size() + f)) =
            -weigh(observed[f], [&](const NodeWeight& n) { return engine.displacement(2, n.X, n.Y, n.Z); });
    }
    if (row >= 0 && takes_snapshots) snapshots->begin(row, displacement, velocity);
    update_surface_forces(time_of(step));
    const double power = compute_power(engine);
    engine.advance(node_forces, output);
    unsettled_work.push_back(0.5 * dt * (power + compute_power(engine)));
    if (output) {
      settle_work(position);
      std::array<double, 2> energy{engine.energy(), engine.kinetic_energy()};
      if (ranks) ranks->sum(energy.data(), energy.size());
      check_energy(position.guard, energy[0], energy[1], step);
    }
    if (row >= 0) {
      motion.energy(row) = engine.energy();
      add_velocities(engine, row, motion);
      if (takes_snapshots) snapshots->finish(row, velocity);
    }
    ++position.step;

    if (seconds_since(told) > 0.25 || position.step == total) {
      told = std::chrono::steady_clock::now();
      tell();
    }
    if (position.step == total) break;
    if (ranks && !output && position.step % steps_between_agreements != 0) continue;
    const RunWish wish = agree_on({control.is_stop_wanted && control.is_stop_wanted(),
                                   !control.checkpoint.empty() && control.checkpoint_interval > 0 &&
                                       rank == 0 && seconds_since(saved) >= control.checkpoint_interval});
    if (wish.stop) {
      settle_work(position);
      if (!control.checkpoint.empty()) save(control, engine, motion, position);
      throw RunStopped(
          fmt::format("stopped at t = {:.6g} s, after step {} of {}", time_of(step), position.step, total),
          position.step, total);
    }
    if (wish.save) {
      settle_work(position);
      try {
        save(control, engine, motion, position);
      } catch (const InputError& error) {  // no reason to lose what has been computed
        if (control.warn) control.warn(fmt::format("{}; the run goes on", error.what()));
      }
      saved = std::chrono::steady_clock::now();
    }
  }
  settle_work(position);
  // A state of the layer has no energy that is known.
  if (options.boundary == AbsorbingBoundary::matched_layer) motion.energy.resize(0);
  if (is_low_part && !control.checkpoint.empty()) save(control, engine, motion, position);
  if (ranks) {
    for (Eigen::VectorXd* record : {&motion.time, &motion.energy})
      ranks->sum(record->data(), static_cast<std::size_t>(record->size()));
    for (Eigen::MatrixXd* record : {&motion.vx, &motion.vy, &motion.vz, &motion.footprint_displacement})
      ranks->sum(record->data(), static_cast<std::size_t>(record->size()));
  }
  if (options.corrects_time_error) {
    const auto correct = [&](Eigen::MatrixXd& records, LeapfrogRecord kind) {
      records = remove_time_error(records, start - history.first_time(), output_step, dt,
                                  site.highest_frequency, kind);
    };
    for (Eigen::MatrixXd* v : {&motion.vx, &motion.vy, &motion.vz}) correct(*v, LeapfrogRecord::velocity);
    correct(motion.footprint_displacement, LeapfrogRecord::displacement);
  }
  return motion;
}

double WaveSolver::Impl::measure_step() {
  if (seconds_per_step == 0)
    with_engine([&](auto& engine) {
      update_surface_forces(history.first_time());
      engine.set_to_rest();
      engine.advance(node_forces, false);
      const auto time_steps = [&](int count) {
        const auto begin = std::chrono::steady_clock::now();
        for (int step = 0; step < count; ++step) engine.advance(node_forces, false);
        double seconds = seconds_since(begin) / count;
        if (ranks) ranks->maximise(&seconds, 1);
        return seconds;
      };
      const double first = time_steps(5);  // then as many as take 0.3 s: as many on all ranks
      seconds_per_step = time_steps(static_cast<int>(std::clamp(0.3 / std::max(first, 1e-9), 5.0, 1000.0)));
      engine.set_to_rest();
    });
  return seconds_per_step;
}

GroundMotion WaveSolver::Impl::run(const RunControl& control) {
  const auto run_one = [](Impl& impl, const RunControl& with) {
    return impl.with_engine([&](auto& engine) { return impl.run(engine, with); });
  };
  if (!low) return run_one(*this, control);
  const double work = static_cast<double>(lattice.dofs()) * static_cast<double>(steps());
  const double low_work = static_cast<double>(low->lattice.dofs()) * static_cast<double>(low->steps());
  const double low_share = low_work / (work + low_work);
  // Both parts one after the other, each with a checkpoint of its own; that of the part below is kept when it is complete.
  const auto part = [&](double from, double share) {
    RunControl of_part = control;
    if (control.progress)
      of_part.progress = [&control, from, share](double fraction) {
        control.progress(from + share * fraction);
      };
    return of_part;
  };
  RunControl low_control = part(0, low_share), high_control = part(low_share, 1 - low_share);
  low_control.checkpoint = low_checkpoint_of(control.checkpoint);
  low_control.snapshots.clear();
  act_on_first(ranks, [&] {
    high_control.restart = high_control.restart && std::filesystem::exists(control.checkpoint);
  });
  if (ranks) ranks->broadcast(&high_control.restart, sizeof high_control.restart, 0);
  const GroundMotion below = run_one(*low, low_control);
  GroundMotion motion = run_one(*this, high_control);
  motion.vx += below.vx;
  motion.vy += below.vy;
  motion.vz += below.vz;
  motion.footprint_displacement += below.footprint_displacement;
  motion.energy.resize(0);  // not the sum of the parts'
  return motion;
}

}  // namespace easydyn::soil

#include "soil/wave_solver.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <variant>

#include "easydyn/error.hpp"
#include "soil/checkpoint.hpp"
#include "soil/energy_guard.hpp"
#include "soil/load_history.hpp"
#include "soil/relaxation.hpp"
#include "soil/snapshot_writer.hpp"
#include "soil/surface_interpolation.hpp"
#include "soil/wave_engine.hpp"

namespace easydyn::soil {

namespace {

// Two mechanisms over a decade below the highest frequency: 3 % becomes 2.96 to 3.15 %. A wider band takes three.
int count_mechanisms(double lowest, double highest) {
  return highest <= 10.001 * lowest ? 2 : 3;
}

void check_options(const SolverOptions& options) {
  const auto require = [](bool condition, const std::string& message) {
    if (!condition) throw ModelError("solver: " + message);
  };
  require(options.step_safety > 0 && options.step_safety <= 1,
          fmt::format("step_safety = {}, must be in 0..1", options.step_safety));
  require(
      options.threads >= 0,
      fmt::format("threads = {}, must be >= 0 (0: one per core, fewer for a small model)", options.threads));
  require(options.output_step >= 0, fmt::format("output_step = {} s, must be >= 0", options.output_step));
  require(options.sponge_elements >= -1,
          fmt::format("sponge_elements = {}, must be >= 0, or -1 (chosen)", options.sponge_elements));
  require(options.sponge_strength >= 0 && std::isfinite(options.sponge_strength),
          fmt::format("sponge_strength = {}, must be >= 0", options.sponge_strength));
  require(options.memory_limit >= 0,
          fmt::format("memory_limit = {} byte, must be >= 0", options.memory_limit));
}

struct Rheology {
  std::vector<EngineMaterial> materials;
  std::vector<double> rates;
};

// The fit spans the band of the site and the frequency at which the ratio is given.
Relaxation fit_constant_ratio(const Site& site, const Layer& layer) {
  const double low = site.highest_frequency / 10, high = site.highest_frequency,
               reference = site.damping_frequency;
  const double lowest = std::min(low, reference), highest = std::max(high, reference);
  const Relaxation body =
      fit_relaxation(layer.damping, lowest, highest, reference, count_mechanisms(lowest, highest));
  bool is_sound = body.weights.allFinite() && body.weights.sum() < 1;
  for (double f = low; f <= 1.001 * high; f *= 1.2)
    is_sound = is_sound && std::abs(body.compute_damping_ratio(f) - layer.damping) <= 0.25 * layer.damping;
  if (!is_sound)
    throw ModelError(
        fmt::format("layer \"{}\": damping = {} at damping_frequency = {} Hz cannot be held over {} to {} Hz "
                    "within a quarter; "
                    "damping_frequency must be nearer to that band, or the damping lower",
                    layer.name, layer.damping, reference, low, high));
  return body;
}

Rheology make_rheology(const Site& site, DampingModel model) {
  Rheology rheology;
  const bool damped =
      std::any_of(site.layers.begin(), site.layers.end(), [](const Layer& l) { return l.damping > 0; });
  for (const Layer& layer : site.layers) {
    EngineMaterial material{layer.lame_lambda(), layer.shear_modulus(), layer.density, 0, {}};
    if (damped && model == DampingModel::stiffness_proportional)
      material.beta = layer.damping / (M_PI * site.damping_frequency);
    if (damped && model == DampingModel::constant_ratio) {
      const Relaxation body = fit_constant_ratio(site, layer);
      material.lambda *= body.unrelaxed;
      material.mu *= body.unrelaxed;
      material.memory_weights.assign(body.weights.data(), body.weights.data() + body.weights.size());
      rheology.rates.assign(body.rates.data(), body.rates.data() + body.rates.size());
    }
    rheology.materials.push_back(material);
  }
  return rheology;
}

double physical_memory() {
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
}

/// To three digits: the estimate of the stable step differs in the last ones from machine to machine.
double round_down(double step) {
  const double unit = std::pow(10, std::floor(std::log10(step)) - 2);
  return std::floor(step / unit) * unit;
}

/// One thread per core, but each with enough work to be worth the two meetings of a step.
int choose_threads(const Lattice& lattice) {
  const long smallest_share = 30000;  // degrees of freedom: some tenths of a millisecond
  const long cores = std::max(1L, static_cast<long>(std::thread::hardware_concurrency()));
  return static_cast<int>(std::clamp(lattice.dofs() / smallest_share, 1L, cores));
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

/// Where a run stands between two steps, beside its fields and records.
struct RunPosition {
  long step = 0;  // the next one
  EnergyGuard guard;
};

struct WaveSolver::Impl {
  Impl(const Site& site_, const SurfaceLoads& loads, const SolverOptions& options_);

  void update_surface_forces(double t);
  template <class Read>
  double weigh(const std::vector<NodeWeight>& nodes, Read read) const {
    double sum = 0;
    for (const NodeWeight& n : nodes) sum += n.weight * read(n);
    return sum;
  }
  template <class F>
  decltype(auto) with_engine(F&& f) {
    return double_engine ? f(*double_engine) : f(*float_engine);
  }
  template <class T>
  GroundMotion run(WaveEngine<T>& engine, const RunControl& control);
  GroundMotion make_motion() const;
  template <class T>
  void add_velocities(WaveEngine<T>& engine, Eigen::Index row, GroundMotion& motion) const;
  template <class T>
  double compute_power(const WaveEngine<T>& engine) const;  ///< of the surface forces [W]
  template <class T>
  void check_energy(const WaveEngine<T>& engine, const EnergyGuard& guard, long step) const;
  double compute_checkpoint_size();
  template <class T>
  void save(const RunControl& control, WaveEngine<T>& engine, GroundMotion& motion,
            RunPosition position) const;
  template <class T>
  RunPosition load(const RunControl& control, WaveEngine<T>& engine, GroundMotion& motion) const;

  Site site;
  SolverOptions options;
  Lattice lattice;
  LoadHistory history;
  std::vector<FootprintWeights> footprints;
  std::vector<ReceiverWeights> receivers;
  Eigen::VectorXd taper, forces;
  std::vector<SurfaceNodeForce> node_forces;
  std::unique_ptr<WaveEngine<float>> float_engine;
  std::unique_ptr<WaveEngine<double>> double_engine;
  double dt = 0, output_step = 0, memory = 0;
  long steps_per_output = 1, outputs = 0, preload_outputs = 0;
  double seconds_per_step = 0;
  RunIdentity identity;
  std::unique_ptr<SnapshotWriter> snapshots;

  long steps() const { return (preload_outputs + outputs - 1) * steps_per_output + 1; }
  double time_of(long step) const {
    return history.first_time() - static_cast<double>(preload_outputs) * output_step +
           static_cast<double>(step) * dt;
  }
  /// Rows of the output that the first `step` steps have filled.
  Eigen::Index rows_before(long step) const {
    return std::max(0L, (step + steps_per_output - 1) / steps_per_output - preload_outputs);
  }
};

WaveSolver::Impl::Impl(const Site& site_, const SurfaceLoads& loads, const SolverOptions& options_)
    : site(site_), options(options_), history(loads, options_.preload_time) {
  check_options(options);
  LatticeOptions lattice_options;
  lattice_options.degree = options.degree;
  lattice_options.half_model = options.half_model;
  // A wave must find the same length of sponge whatever the size of the elements.
  lattice_options.sponge_elements =
      options.sponge_elements >= 0
          ? options.sponge_elements
          : static_cast<int>(std::lround(8 * site.points_per_wavelength / 5.5 * 4 / options.degree));
  lattice_options.sponge_growth = options.sponge_growth;
  lattice = make_lattice(site, loads.footprints, lattice_options);
  for (std::size_t f = 0; f < loads.footprints.size(); ++f)
    footprints.push_back(compute_footprint_weights(lattice, loads.footprints[f], f + 1));
  for (const Receiver& receiver : site.receivers)
    receivers.push_back(compute_receiver_weights(lattice, receiver));
  taper = compute_taper(loads.footprints, site.taper_length);

  const Rheology rheology = make_rheology(site, options.damping);
  const int memories = static_cast<int>(rheology.rates.size());
  memory = options.double_precision ? WaveEngine<double>::compute_memory(lattice, memories)
                                    : WaveEngine<float>::compute_memory(lattice, memories);
  const double limit = options.memory_limit > 0 ? options.memory_limit : 0.8 * physical_memory();
  if (!(memory <= limit))
    throw ModelError(fmt::format(
        "solver: {:.3g} million degrees of freedom need {:.3g} GB of memory, must be at most "
        "{:.3g} GB: lower highest_frequency, points_per_wavelength or margin, or bring the farthest "
        "receiver nearer ({}), or look at {}",
        static_cast<double>(lattice.dofs()) * 1e-6, memory * 1e-9, limit * 1e-9,
        describe_farthest_receiver(site), describe_slowest_layer(site)));

  EngineBoundary boundary;
  boundary.sponge_strength = options.sponge_strength;
  boundary.sponge_speed = site.layers.back().cs;
  boundary.dashpots = options.dashpots;
  for (const Footprint& f : loads.footprints) {
    boundary.origin[0] += f.x / static_cast<double>(loads.footprints.size());
    boundary.origin[1] += f.y / static_cast<double>(loads.footprints.size());
  }
  const int threads = options.threads > 0 ? options.threads : choose_threads(lattice);
  if (options.double_precision)
    double_engine =
        std::make_unique<WaveEngine<double>>(lattice, rheology.materials, rheology.rates, boundary, threads);
  else
    float_engine =
        std::make_unique<WaveEngine<float>>(lattice, rheology.materials, rheology.rates, boundary, threads);

  // The output step is a whole number of time steps.
  const double largest =
      with_engine([&](auto& engine) { return options.step_safety * engine.compute_stable_step(); });
  if (!(largest > 0) || !std::isfinite(largest)) {
    const auto thinnest = std::min_element(
        site.layers.begin(), site.layers.end() - 1,
        [](const Layer& a, const Layer& b) { return a.thickness / a.cp < b.thickness / b.cp; });
    throw SolverError(
        fmt::format("wave solver: no stable time step found (limit {} s); layer \"{}\" of {} m asks for "
                    "the smallest: is it too thin?",
                    largest, thinnest->name, thinnest->thickness));
  }
  if (options.output_step > 0) {
    output_step = options.output_step;
    steps_per_output = static_cast<long>(std::ceil(output_step / largest));
    dt = output_step / static_cast<double>(steps_per_output);
  } else {  // the time step decides; output as often as ten times per shortest period asks for
    dt = round_down(largest);
    steps_per_output = std::max(1L, static_cast<long>(1 / (10 * site.highest_frequency) / dt));
    output_step = dt * static_cast<double>(steps_per_output);
  }
  with_engine([&](auto& engine) { engine.set_time_step(dt); });

  const double duration =
      site.duration > 0 ? site.duration : history.last_time() - history.first_time() + site.decay_time;
  if (!(duration > 0) || !std::isfinite(duration))
    throw ModelError(fmt::format("site: duration = {} s, must be > 0", duration));
  if (!(duration >= 10 * output_step))
    throw ModelError(fmt::format("site: duration = {} s, must be at least ten output steps of {} s", duration,
                                 output_step));
  // Histories of receivers and footprints, held twice while they are written.
  const double histories = 2 * 8 * duration / output_step *
                           static_cast<double>(3 * site.receivers.size() + loads.footprints.size());
  if (!(memory + histories <= limit))
    throw ModelError(
        fmt::format("site: duration = {} s gives histories of {:.3g} GB, fields and histories must be at "
                    "most {:.3g} GB",
                    duration, histories * 1e-9, limit * 1e-9));
  outputs = static_cast<long>(std::floor(duration / output_step + 1e-9)) + 1;
  Eigen::VectorXd start;
  history.update_forces(history.first_time() + 1e-12 * output_step, start);
  // A start below 1/1000 of the largest force does no harm as it is.
  const bool preloaded =
      start.cwiseProduct(taper).cwiseAbs().maxCoeff() > 1e-3 * loads.force.cwiseAbs().maxCoeff();
  preload_outputs = preloaded ? static_cast<long>(std::ceil(options.preload_time / output_step)) : 0;

  snapshots = std::make_unique<SnapshotWriter>(site.snapshots, lattice,
                                               OutputTimes{history.first_time(), output_step, outputs});

  identity = describe_run(site, loads, options);
  identity.push_back({"option threads", fmt::format("{}", threads)});  // sums differ in the last bits
  identity.push_back({"number of degrees of freedom", fmt::format("{}", lattice.dofs())});
  identity.push_back({"time step", fmt::format("{} s", dt)});
}

void WaveSolver::Impl::update_surface_forces(double t) {
  history.update_forces(t, forces);
  node_forces.clear();
  for (std::size_t f = 0; f < footprints.size(); ++f) {
    const double force = forces(static_cast<Eigen::Index>(f)) * taper(static_cast<Eigen::Index>(f));
    if (force == 0) continue;
    for (const NodeWeight& n : footprints[f].force) node_forces.push_back({n.X, n.Y, -force * n.weight});
  }
}

GroundMotion WaveSolver::Impl::make_motion() const {
  const Eigen::Index nt = outputs, nr = static_cast<Eigen::Index>(receivers.size()),
                     nl = static_cast<Eigen::Index>(footprints.size());
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
      const double sign = c == 1 && receiver.mirrored ? -1 : 1;
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
  for (const SurfaceNodeForce& n : node_forces) power += n.force * engine.velocity(2, n.X, n.Y, top);
  return power;
}

template <class T>
void WaveSolver::Impl::check_energy(const WaveEngine<T>& engine, const EnergyGuard& guard, long step) const {
  const auto fail = [&](const std::string& what) {
    throw SolverError(fmt::format(
        "wave solver: {} at t = {:.6g} s, step {} of {} (dt = {:.4g} s): lower step_safety (now {}) or use "
        "double_precision",
        what, time_of(step), step, steps(), dt, options.step_safety));
  };
  if (!guard.is_finite(engine.energy())) fail("the motion is no longer finite");
  if (!guard.is_explained(engine.kinetic_energy()))
    fail(
        fmt::format("the motion grows by itself: its kinetic energy of {:.3g} J is more than {} times the "
                    "work of the loads, {:.3g} J,",
                    engine.kinetic_energy(), EnergyGuard::tolerance, guard.most_work()));
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
                     static_cast<double>(2 + 3 * receivers.size() + footprints.size());
}

template <class T>
void WaveSolver::Impl::save(const RunControl& control, WaveEngine<T>& engine, GroundMotion& motion,
                            RunPosition position) const {
  CheckpointWriter file(control.checkpoint, identity);
  const auto write = [&](const void* data, std::size_t bytes) { file.write(data, bytes); };
  file.write_value(position);
  visit_records(motion, rows_before(position.step), write);
  engine.visit_state(write);
  file.commit();
}

template <class T>
RunPosition WaveSolver::Impl::load(const RunControl& control, WaveEngine<T>& engine,
                                   GroundMotion& motion) const {
  CheckpointReader file(control.checkpoint, identity);
  const auto read = [&](void* data, std::size_t bytes) { file.read(data, bytes); };
  RunPosition position;
  file.read_value(position);
  if (position.step < 0 || position.step > steps())
    throw InputError(
        fmt::format("{}: is damaged: step {} of {}", control.checkpoint.string(), position.step, steps()));
  visit_records(motion, rows_before(position.step), read);
  engine.visit_state(read);
  file.finish();
  return position;
}

template <class T>
GroundMotion WaveSolver::Impl::run(WaveEngine<T>& engine, const RunControl& control) {
  engine.set_to_rest();
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
      motion.time(row) = time_of(step);
      add_velocities(engine, row, motion);
      for (std::size_t f = 0; f < footprints.size(); ++f)
        motion.footprint_displacement(row, static_cast<Eigen::Index>(f)) = -weigh(
            footprints[f].mean, [&](const NodeWeight& n) { return engine.displacement(2, n.X, n.Y, n.Z); });
    }
    if (row >= 0 && takes_snapshots) snapshots->begin(row, displacement, velocity);
    update_surface_forces(time_of(step));
    const double power = compute_power(engine);
    engine.advance(node_forces, output);
    position.guard.add_work(0.5 * dt * (power + compute_power(engine)));
    if (output) check_energy(engine, position.guard, step);
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
    if (control.is_stop_wanted && control.is_stop_wanted()) {
      if (!control.checkpoint.empty()) save(control, engine, motion, position);
      throw RunStopped(
          fmt::format("stopped at t = {:.6g} s, after step {} of {}", time_of(step), position.step, total),
          position.step, total);
    }
    if (!control.checkpoint.empty() && control.checkpoint_interval > 0 &&
        seconds_since(saved) >= control.checkpoint_interval) {
      try {
        save(control, engine, motion, position);
      } catch (const InputError& error) {  // no reason to lose what has been computed
        if (control.warn) control.warn(fmt::format("{}; the run goes on", error.what()));
      }
      saved = std::chrono::steady_clock::now();
    }
  }
  return motion;
}

WaveSolver::WaveSolver(const Site& site, const SurfaceLoads& loads, const SolverOptions& options)
    : impl_(std::make_unique<Impl>(site, loads, options)) {}
WaveSolver::~WaveSolver() = default;
WaveSolver::WaveSolver(WaveSolver&&) noexcept = default;
WaveSolver& WaveSolver::operator=(WaveSolver&&) noexcept = default;

const Lattice& WaveSolver::lattice() const {
  return impl_->lattice;
}
const SolverOptions& WaveSolver::options() const {
  return impl_->options;
}
double WaveSolver::time_step() const {
  return impl_->dt;
}
long WaveSolver::steps() const {
  return impl_->steps();
}

RunSummary WaveSolver::compute_summary() {
  Impl& impl = *impl_;
  if (impl.seconds_per_step == 0)
    impl.with_engine([&](auto& engine) {
      impl.update_surface_forces(impl.history.first_time());
      engine.set_to_rest();
      engine.advance(impl.node_forces, false);
      const auto start = std::chrono::steady_clock::now();
      int count = 0;
      for (; count < 5 || (seconds_since(start) < 0.3 && count < 1000); ++count)
        engine.advance(impl.node_forces, false);
      impl.seconds_per_step = seconds_since(start) / count;
      engine.set_to_rest();
    });
  RunSummary summary;
  summary.elements = impl.lattice.elements();
  summary.nodes = impl.lattice.nodes();
  summary.dofs = impl.lattice.dofs();
  summary.memory = impl.memory;
  summary.time_step = impl.dt;
  summary.output_step = impl.output_step;
  summary.checkpoint = impl.compute_checkpoint_size();
  summary.snapshots = impl.snapshots->size();
  summary.snapshot_text = impl.snapshots->description();
  summary.steps = impl.steps();
  summary.expected_time = impl.seconds_per_step * static_cast<double>(summary.steps);
  return summary;
}

GroundMotion WaveSolver::run(const std::function<void(double)>& progress) {
  RunControl control;
  control.progress = progress;
  return run(control);
}

GroundMotion WaveSolver::run(const RunControl& control) {
  return impl_->with_engine([&](auto& engine) { return impl_->run(engine, control); });
}

}  // namespace easydyn::soil

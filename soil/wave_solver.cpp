#include "soil/wave_solver.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>
#include <tuple>
#include <utility>

#include "easydyn/error.hpp"
#include "soil/checkpoint.hpp"
#include "soil/energy_guard.hpp"
#include "soil/frequency_filter.hpp"
#include "soil/load_history.hpp"
#include "soil/relaxation.hpp"
#include "soil/snapshot_writer.hpp"
#include "soil/surface_interpolation.hpp"
#include "soil/wave_engine.hpp"

namespace easydyn::soil {

namespace {

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
  require(options.crossover_frequency >= 0 && std::isfinite(options.crossover_frequency),
          fmt::format("crossover_frequency = {} Hz, must be >= 0 (0: none)", options.crossover_frequency));
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
  const Relaxation body = fit_relaxation_of_band(layer.damping, high, reference);
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
      std::any_of(site.layers.begin(), site.layers.end(), [](const Layer& l) { return l.damping > 0; }) ||
      std::any_of(site.blocks.begin(), site.blocks.end(),
                  [](const Block& b) { return !b.open && b.material.damping > 0; });
  // Layers, then blocks; what is open has no material but keeps its place.
  std::vector<const Layer*> all;
  for (const Layer& layer : site.layers) all.push_back(&layer);
  for (const Block& block : site.blocks) all.push_back(block.open ? &site.layers.front() : &block.material);
  for (const Layer* const each : all) {
    const Layer& layer = *each;
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

/// Whether the loads are antisymmetric about x = 0, y = 0 (`axis` 0, 1), where the model ends there.
bool is_odd(const std::vector<Footprint>& footprints, const SolverOptions& options, int axis) {
  if (!(axis == 0 ? options.quarter_model : options.half_model || options.quarter_model)) return false;
  const LoadDirection across = axis == 0 ? LoadDirection::x : LoadDirection::y;
  const auto crosses = [&](const Footprint& f) { return f.direction == across; };
  const bool odd = crosses(footprints.front());
  for (std::size_t f = 0; f < footprints.size(); ++f)
    if (crosses(footprints[f]) != odd)
      throw ModelError(
          fmt::format("footprint {}: its direction is {}along {} unlike that of footprint 1, must be all or "
                      "none in the {} "
                      "model (both kinds need the full model, option --full-model)",
                      f + 1, odd ? "not " : "", axis == 0 ? "x" : "y", axis == 0 ? "quarter" : "half"));
  return odd;
}

int component_of(LoadDirection direction) {
  return direction == LoadDirection::x ? 0 : direction == LoadDirection::y ? 1 : 2;
}

constexpr double crossover_width = 1.4142;  // both parts hold something between crossover / width and x width
// Frequency up to which the lattice of the low part resolves, over the crossover. At the upper end of its band a sponge sends
// back more, from elements too coarse; the low part must stay below that (docs/soil_boundary.md).
constexpr double low_resolution = 1.6;

/// Loads that add up to the given ones: what lies below the crossover, and what lies above it. Both begin earlier,
/// because a part of a band begins before the whole does.
std::pair<SurfaceLoads, SurfaceLoads> split_band(const SurfaceLoads& loads, double crossover) {
  const Eigen::Index nt = loads.time.size();
  const double step = (loads.time(nt - 1) - loads.time(0)) / static_cast<double>(nt - 1);
  const auto lead = static_cast<Eigen::Index>(std::ceil(3 / crossover / step));
  SurfaceLoads low = loads;
  low.time = loads.time(0) + step * Eigen::VectorXd::LinSpaced(nt + lead, -static_cast<double>(lead),
                                                               static_cast<double>(nt - 1))
                                        .array();
  low.force.resize(nt + lead, loads.force.cols());
  low.force.topRows(lead).rowwise() = loads.force.row(0);
  low.force.bottomRows(nt) = loads.force;
  SurfaceLoads high = low;
  // Half a cosine over the logarithm of the frequency.
  const auto response = [&](double f) -> std::complex<double> {
    const double place = f > 0 ? std::log(f / crossover) / std::log(crossover_width) : -1;
    return place <= -1 ? 1.0 : place >= 1 ? 0.0 : 0.5 * (1 - std::sin(M_PI / 2 * place));
  };
  for (Eigen::Index j = 0; j < low.force.cols(); ++j)
    low.force.col(j) = apply_filter(high.force.col(j), step, response, RecordEnds::mirrored);
  high.force -= low.force;
  return {low, high};
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
  /// @param far_frequency  see LatticeOptions
  /// @param start_         time of the first output [s]; NaN: that of the first load
  Impl(const Site& site_, const SurfaceLoads& given, const SolverOptions& options_, double far_frequency = 0,
       double start_ = std::numeric_limits<double>::quiet_NaN());

  void update_surface_forces(double t);
  void check_nodes_are_in_the_ground();
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
  GroundMotion run(const RunControl& control);
  double measure_step();  // [s] of wall clock
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
  std::vector<LoadDirection> directions;
  std::vector<std::vector<NodeWeight>> observed;
  bool odd_x = false, odd_y = false;
  std::vector<ReceiverWeights> receivers;
  Eigen::VectorXd taper, forces;
  std::vector<SurfaceNodeForce> node_forces;
  std::unique_ptr<WaveEngine<float>> float_engine;
  std::unique_ptr<WaveEngine<double>> double_engine;
  double dt = 0, output_step = 0, memory = 0;
  double start = 0;  // time of the first output
  long steps_per_output = 1, outputs = 0, preload_outputs = 0;
  std::unique_ptr<Impl> low;  // what is below the crossover, if there is one
  bool is_low_part = false;   // of another one
  double seconds_per_step = 0;
  RunIdentity identity;
  std::unique_ptr<SnapshotWriter> snapshots;

  long steps() const { return (preload_outputs + outputs - 1) * steps_per_output + 1; }
  double time_of(long step) const {
    return start - static_cast<double>(preload_outputs) * output_step + static_cast<double>(step) * dt;
  }
  /// Rows of the output that the first `step` steps have filled.
  Eigen::Index rows_before(long step) const {
    return std::max(0L, (step + steps_per_output - 1) / steps_per_output - preload_outputs);
  }
};

WaveSolver::Impl::Impl(const Site& site_, const SurfaceLoads& given, const SolverOptions& options_,
                       double far_frequency, double start_)
    : site(site_),
      options(options_),
      history(given, options_.preload_time),
      start(std::isnan(start_) ? history.first_time() : start_) {
  check_options(options);
  SurfaceLoads loads = given, low_loads;
  if (options.crossover_frequency > 0) {
    if (!(crossover_width * options.crossover_frequency <= site.highest_frequency))
      throw ModelError(fmt::format(
          "solver: crossover_frequency = {} Hz, must be at most {:.4g} Hz, {:.2g} of the "
          "highest_frequency",
          options.crossover_frequency, site.highest_frequency / crossover_width, 1 / crossover_width));
    std::tie(low_loads, loads) = split_band(given, options.crossover_frequency);
    history = LoadHistory(loads, options.preload_time);
  }
  LatticeOptions lattice_options;
  lattice_options.degree = options.degree;
  if (options.quarter_model) options.half_model = true;
  lattice_options.half_model = options.half_model;
  lattice_options.quarter_model = options.quarter_model;
  // A wave must find the same length of sponge whatever the size of the elements.
  lattice_options.sponge_elements =
      options.sponge_elements >= 0
          ? options.sponge_elements
          : static_cast<int>(std::lround(8 * site.points_per_wavelength / 5.5 * 4 / options.degree));
  lattice_options.far_frequency = far_frequency;
  lattice_options.sponge_growth = options.sponge_growth;
  Site extended = site;  // to the farthest corner of what is observed
  for (const Footprint& f : options.observed) {
    const double sx = f.x < 0 ? -1 : 1, sy = f.y < 0 ? -1 : 1;
    extended.receivers.push_back(
        {"observed footprint", {f.x + sx * f.length / 2, f.y + sy * f.width / 2, 0}});
  }
  lattice = make_lattice(extended, loads.footprints, lattice_options);
  for (std::size_t f = 0; f < loads.footprints.size(); ++f) {
    footprints.push_back(compute_footprint_weights(lattice, loads.footprints[f], f + 1));
    directions.push_back(loads.footprints[f].direction);
  }
  for (const Receiver& receiver : site.receivers)
    receivers.push_back(compute_receiver_weights(lattice, receiver));
  taper = compute_taper(loads.footprints, site.taper_length);

  odd_x = is_odd(loads.footprints, options, 0);
  odd_y = is_odd(loads.footprints, options, 1);
  if (!options.observed.empty() && (odd_x || odd_y))
    throw ModelError("solver: footprints are observed under a horizontal load, must be under vertical ones");
  for (const Footprint& f : options.observed)
    if (!(f.length > 0 && f.width > 0))
      throw ModelError(fmt::format("solver: an observed footprint is {} m x {} m, must be a rectangle",
                                   f.length, f.width));
  for (std::size_t f = 0; f < options.observed.size(); ++f)
    observed.push_back(compute_mean_weights(lattice, options.observed[f], loads.footprints.size() + f + 1));

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
  boundary.odd_x = odd_x;
  boundary.odd_y = odd_y;
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

  if (!lattice.blocks.empty()) check_nodes_are_in_the_ground();

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

  const double duration = site.duration > 0 ? site.duration : history.last_time() - start + site.decay_time;
  if (!(duration > 0) || !std::isfinite(duration))
    throw ModelError(fmt::format("site: duration = {} s, must be > 0", duration));
  if (!(duration >= 10 * output_step))
    throw ModelError(fmt::format("site: duration = {} s, must be at least ten output steps of {} s", duration,
                                 output_step));
  // Histories of receivers and footprints, held twice while they are written.
  const double histories =
      2 * 8 * duration / output_step *
      static_cast<double>(3 * site.receivers.size() + loads.footprints.size() + observed.size());
  if (!(memory + histories <= limit))
    throw ModelError(
        fmt::format("site: duration = {} s gives histories of {:.3g} GB, fields and histories must be at "
                    "most {:.3g} GB",
                    duration, histories * 1e-9, limit * 1e-9));
  outputs = static_cast<long>(std::floor(duration / output_step + 1e-9)) + 1;
  Eigen::VectorXd first;
  history.update_forces(history.first_time() + 1e-12 * output_step, first);
  // A start below 1/1000 of the largest force does no harm as it is.
  const bool preloaded =
      first.cwiseProduct(taper).cwiseAbs().maxCoeff() > 1e-3 * loads.force.cwiseAbs().maxCoeff();
  const double before = start - history.first_time() + (preloaded ? options.preload_time : 0.0);
  preload_outputs = static_cast<long>(std::ceil(before / output_step - 1e-9));

  if (options.crossover_frequency > 0) {
    if (!site.snapshots.empty())
      throw ModelError(fmt::format(
          "site: snapshots cannot be taken with a crossover frequency of {} Hz: the motion is the sum of "
          "two models on lattices of their own",
          options.crossover_frequency));
    SolverOptions low_options = options;
    low_options.crossover_frequency = 0;
    low_options.output_step = output_step;
    low_options.memory_limit = limit - memory;
    low = std::make_unique<Impl>(
        site, low_loads, low_options,
        std::min(low_resolution * options.crossover_frequency, site.highest_frequency), start);
    low->is_low_part = true;
  }

  snapshots =
      std::make_unique<SnapshotWriter>(site.snapshots, lattice, OutputTimes{start, output_step, outputs});

  identity = describe_run(site, loads, options);
  identity.push_back({"option threads", fmt::format("{}", threads)});  // sums differ in the last bits
  identity.push_back({"number of degrees of freedom", fmt::format("{}", lattice.dofs())});
  identity.push_back({"time step", fmt::format("{} s", dt)});
}

void WaveSolver::Impl::check_nodes_are_in_the_ground() {
  const auto check = [&](const std::vector<NodeWeight>& nodes, const std::string& who) {
    for (const NodeWeight& n : nodes)
      if (!(with_engine([&](const auto& engine) { return engine.mass(n.X, n.Y, n.Z); }) > 0))
        throw ModelError(who + ": lies in an open block, must be on or in the ground");
  };
  for (std::size_t f = 0; f < footprints.size(); ++f)
    check(footprints[f].force, fmt::format("footprint {}", f + 1));
  for (std::size_t f = 0; f < observed.size(); ++f)
    check(observed[f], fmt::format("footprint {}", footprints.size() + f + 1));
  for (std::size_t r = 0; r < receivers.size(); ++r)
    check(receivers[r].nodes, fmt::format("receiver \"{}\"", site.receivers[r].name));
}

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
    power += n.force * engine.velocity(n.component, n.X, n.Y, top);
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
                     static_cast<double>(2 + 3 * receivers.size() + footprints.size() + observed.size());
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
  if (is_low_part && !control.checkpoint.empty()) save(control, engine, motion, position);
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

double WaveSolver::Impl::measure_step() {
  if (seconds_per_step == 0)
    with_engine([&](auto& engine) {
      update_surface_forces(history.first_time());
      engine.set_to_rest();
      engine.advance(node_forces, false);
      const auto begin = std::chrono::steady_clock::now();
      int count = 0;
      for (; count < 5 || (seconds_since(begin) < 0.3 && count < 1000); ++count)
        engine.advance(node_forces, false);
      seconds_per_step = seconds_since(begin) / count;
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
  high_control.restart = control.restart && std::filesystem::exists(control.checkpoint);
  const GroundMotion below = run_one(*low, low_control);
  GroundMotion motion = run_one(*this, high_control);
  motion.vx += below.vx;
  motion.vy += below.vy;
  motion.vz += below.vz;
  motion.footprint_displacement += below.footprint_displacement;
  motion.energy.resize(0);  // not the sum of the parts'
  return motion;
}

RunSummary WaveSolver::compute_summary() {
  Impl& impl = *impl_;
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
  summary.expected_time = impl.measure_step() * static_cast<double>(summary.steps);
  if (impl.low) {
    summary.memory += impl.low->memory;
    summary.checkpoint += impl.low->compute_checkpoint_size();
    summary.expected_time += impl.low->measure_step() * static_cast<double>(impl.low->steps());
  }
  return summary;
}

const Lattice* WaveSolver::low_lattice() const {
  return impl_->low ? &impl_->low->lattice : nullptr;
}

GroundMotion WaveSolver::run(const std::function<void(double)>& progress) {
  RunControl control;
  control.progress = progress;
  return run(control);
}

GroundMotion WaveSolver::run(const RunControl& control) {
  return impl_->run(control);
}

}  // namespace easydyn::soil

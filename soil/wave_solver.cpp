#include "soil/wave_solver.hpp"

#include <fmt/format.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <thread>
#include <tuple>
#include <utility>

#include "easydyn/error.hpp"
#include "soil/agreement.hpp"
#include "soil/band_split.hpp"
#include "soil/matched_layer_limits.hpp"
#include "soil/physical_memory.hpp"
#include "soil/rheology.hpp"
#include "soil/time_error.hpp"
#include "soil/wave_solver_impl.hpp"

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
  if (options.boundary == AbsorbingBoundary::matched_layer) {
    require(options.sponge_elements != 0, "sponge_elements = 0, must be >= 1 of a matched layer");
    require(options.layer_strength >= 0 && std::isfinite(options.layer_strength),
            fmt::format("layer_strength = {}, must be >= 0", options.layer_strength));
    require(options.layer_alpha > 0 && std::isfinite(options.layer_alpha),
            fmt::format("layer_alpha = {} 1/s, must be > 0", options.layer_alpha));
    require(options.crossover_frequency == 0,
            fmt::format("crossover_frequency = {} Hz with a matched layer, must be 0: the layer absorbs low "
                        "frequencies without a lattice of their own (options --crossover and --boundary)",
                        options.crossover_frequency));
  }
  require(options.memory_limit >= 0,
          fmt::format("memory_limit = {} byte, must be >= 0", options.memory_limit));
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

// Frequency up to which the lattice of the low part resolves, over the crossover. At the upper end of its band a sponge sends
// back more, from elements too coarse; the low part must stay below that (docs/soil_boundary.md).
constexpr double low_resolution = 1.6;

/// To three digits: the estimate of the stable step differs in the last ones from machine to machine.
double round_down(double step) {
  const double unit = std::pow(10, std::floor(std::log10(step)) - 2);
  return std::floor(step / unit) * unit;
}

/// One thread per core that this rank has, but each with enough work to be worth the meetings of a step.
int choose_threads(const Lattice& lattice, const Ranks* ranks) {
  const long smallest_share = 30000;  // degrees of freedom: some tenths of a millisecond
  const long all_cores = std::max(1L, static_cast<long>(std::thread::hardware_concurrency()));
  if (!ranks) return static_cast<int>(std::clamp(lattice.dofs() / smallest_share, 1L, all_cores));
  // Who starts ranks may bind each of them to some cores.
  cpu_set_t bound;
  const long bound_to = sched_getaffinity(0, sizeof bound, &bound) == 0 ? CPU_COUNT(&bound) : all_cores;
  const long cores = std::clamp(all_cores / ranks->on_this_node(), 1L, bound_to);
  return static_cast<int>(std::clamp(lattice.dofs() / ranks->size() / smallest_share, 1L, cores));
}

}  // namespace

WaveSolver::Impl::Impl(const Site& site_, const SurfaceLoads& given, const SolverOptions& options_,
                       Ranks* ranks_, double far_frequency, double start_)
    : site(site_),
      options(options_),
      ranks(ranks_),
      rank(ranks_ ? ranks_->rank() : 0),
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
  const bool has_layer = options.boundary == AbsorbingBoundary::matched_layer;
  if (has_layer) {
    check_matched_layer(site);
    lattice_options.lanes = 1;  // its elements are dear: no more of them to fill vectors
  }
  // A wave must find the same length of sponge whatever the size of the elements.
  lattice_options.sponge_elements =
      options.sponge_elements >= 0
          ? options.sponge_elements
          : static_cast<int>(
                std::lround((has_layer ? 4 : 8) * site.points_per_wavelength / 5.5 * 4 / options.degree));
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
  const Partition partition(lattice.ny(), lattice.nz(), lattice.degree, ranks ? ranks->size() : 1);
  const int threads = options.threads > 0 ? options.threads : choose_threads(lattice, ranks);
  double largest_part = 0;
  for (int r = 0; r < partition.ranks(); ++r) {
    const ElementBlock& block = partition.block(r);
    double part = options.double_precision ? WaveEngine<double>::compute_memory(lattice, memories, block)
                                           : WaveEngine<float>::compute_memory(lattice, memories, block);
    if (has_layer) {
      const double states = options.double_precision
                                ? WaveEngine<double>::compute_layer_memory(lattice, block, threads)
                                : WaveEngine<float>::compute_layer_memory(lattice, block, threads);
      layer_memory += states;
      part += states;
    }
    memory += part;
    largest_part = std::max(largest_part, part);
  }
  double tables = options.double_precision
                      ? WaveEngine<double>::compute_table_memory(lattice, partition, rank, threads)
                      : WaveEngine<float>::compute_table_memory(lattice, partition, rank, threads);
  double largest_tables = tables;
  if (ranks) ranks->sum(&tables, 1);
  if (ranks) ranks->maximise(&largest_tables, 1);
  memory += tables;
  largest_part += largest_tables;
  // Of the ranks that share this machine's memory.
  const double memory_here = ranks ? ranks->on_this_node() * largest_part : memory;
  const double limit = options.memory_limit > 0 ? options.memory_limit : 0.8 * physical_memory();
  if (!(memory_here <= limit))
    throw ModelError(fmt::format(
        "solver: {:.3g} million degrees of freedom need {:.3g} GB of memory{}, must be at most "
        "{:.3g} GB: lower highest_frequency, points_per_wavelength or margin, or bring the farthest "
        "receiver nearer ({}), or look at {}",
        static_cast<double>(lattice.dofs()) * 1e-6, memory_here * 1e-9, ranks ? " in this machine" : "",
        limit * 1e-9, describe_farthest_receiver(site), describe_slowest_layer(site)));

  EngineBoundary boundary;
  boundary.absorber = options.boundary;
  boundary.layer_strength = options.layer_strength;
  boundary.layer_alpha = options.layer_alpha;
  boundary.layer_speed = site.layers.back().cp;
  boundary.sponge_strength = options.sponge_strength;
  boundary.sponge_speed = site.layers.back().cs;
  boundary.dashpots = options.dashpots;
  boundary.odd_x = odd_x;
  boundary.odd_y = odd_y;
  for (const Footprint& f : loads.footprints) {
    boundary.origin[0] += f.x / static_cast<double>(loads.footprints.size());
    boundary.origin[1] += f.y / static_cast<double>(loads.footprints.size());
  }
  if (options.double_precision)
    double_engine = std::make_unique<WaveEngine<double>>(lattice, rheology.materials, rheology.rates,
                                                         boundary, threads, ranks);
  else
    float_engine = std::make_unique<WaveEngine<float>>(lattice, rheology.materials, rheology.rates, boundary,
                                                       threads, ranks);

  if (!lattice.blocks.empty()) act_together(ranks, [&] { check_nodes_are_in_the_ground(); });
  keep_nodes_of_this_rank();

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
  if (options.corrects_time_error) {
    const double step =
        (history.last_time() - history.first_time()) / static_cast<double>(loads.time.size() - 1);
    loads.force = add_time_error(loads.force, step, dt, site.highest_frequency);
    history = LoadHistory(loads, options.preload_time);
  }

  const double duration = site.duration > 0 ? site.duration : history.last_time() - start + site.decay_time;
  if (!(duration > 0) || !std::isfinite(duration))
    throw ModelError(fmt::format("site: duration = {} s, must be > 0", duration));
  if (!(duration >= 10 * output_step))
    throw ModelError(fmt::format("site: duration = {} s, must be at least ten output steps of {} s", duration,
                                 output_step));
  // Histories of receivers and footprints, held twice while they are written, by every rank.
  const double histories =
      2.0 * 8 * (ranks ? ranks->on_this_node() : 1) * duration / output_step *
      static_cast<double>(3 * site.receivers.size() + loads.footprints.size() + observed.size());
  if (!(memory_here + histories <= limit))
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
    low_options.memory_limit = limit - memory_here;
    low = std::make_unique<Impl>(
        site, low_loads, low_options, ranks,
        std::min(low_resolution * options.crossover_frequency, site.highest_frequency), start);
    low->is_low_part = true;
  }

  snapshots = std::make_unique<SnapshotWriter>(site.snapshots, lattice,
                                               OutputTimes{start, output_step, outputs}, partition, rank);

  identity = describe_run(site, loads, options);
  identity.push_back({"option threads", fmt::format("{}", threads)});  // sums differ in the last bits
  identity.push_back({"number of ranks", fmt::format("{}", partition.ranks())});
  identity.push_back({"number of degrees of freedom", fmt::format("{}", lattice.dofs())});
  identity.push_back({"time step", fmt::format("{} s", dt)});
}

void WaveSolver::Impl::check_nodes_are_in_the_ground() {
  const auto check = [&](const std::vector<NodeWeight>& nodes, const std::string& who) {
    for (const NodeWeight& n : nodes)
      if (!with_engine([&](const auto& engine) {
            return !engine.has_line(n.Y, n.Z) || engine.mass(n.X, n.Y, n.Z) > 0;
          }))
        throw ModelError(who + ": lies in an open block, must be on or in the ground");
  };
  for (std::size_t f = 0; f < footprints.size(); ++f)
    check(footprints[f].force, fmt::format("footprint {}", f + 1));
  for (std::size_t f = 0; f < observed.size(); ++f)
    check(observed[f], fmt::format("footprint {}", footprints.size() + f + 1));
  for (std::size_t r = 0; r < receivers.size(); ++r)
    check(receivers[r].nodes, fmt::format("receiver \"{}\"", site.receivers[r].name));
}

/// The sums over nodes that make motions run over the nodes that this rank owns, loads act on those it holds.
void WaveSolver::Impl::keep_nodes_of_this_rank() {
  with_engine([&](const auto& engine) {
    const auto is_of_others = [&](const NodeWeight& n) { return !engine.owns_line(n.Y, n.Z); };
    for (FootprintWeights& footprint : footprints) {
      std::erase_if(footprint.force, [&](const NodeWeight& n) { return !engine.has_line(n.Y, n.Z); });
      std::erase_if(footprint.mean, is_of_others);
    }
    for (std::vector<NodeWeight>& nodes : observed) std::erase_if(nodes, is_of_others);
    for (ReceiverWeights& receiver : receivers) std::erase_if(receiver.nodes, is_of_others);
  });
}

WaveSolver::WaveSolver(const Site& site, const SurfaceLoads& loads, const SolverOptions& options,
                       Ranks* ranks)
    : impl_(std::make_unique<Impl>(site, loads, options, ranks)) {}
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
  RunSummary summary;
  summary.elements = impl.lattice.elements();
  summary.nodes = impl.lattice.nodes();
  summary.dofs = impl.lattice.dofs();
  summary.memory = impl.memory;
  summary.layer_memory = impl.layer_memory;
  if (impl.options.boundary == AbsorbingBoundary::matched_layer)
    summary.layer_elements = impl.lattice.elements() - impl.lattice.interior_elements();
  summary.time_step = impl.dt;
  summary.output_step = impl.output_step;
  summary.checkpoint = impl.compute_checkpoint_size();
  summary.snapshots = impl.snapshots->size();
  summary.snapshot_text = impl.snapshots->description();
  summary.steps = impl.steps();
  impl.with_engine([&](const auto& engine) {
    summary.ranks_y = engine.partition().along_y();
    summary.ranks_z = engine.partition().along_z();
    summary.threads = engine.threads();
    summary.halo = engine.halo_size();
  });
  if (impl.ranks) impl.ranks->maximise(&summary.halo, 1);
  summary.expected_time = impl.measure_step() * static_cast<double>(summary.steps);
  if (impl.low) {
    summary.memory += impl.low->memory;
    summary.checkpoint += impl.low->compute_checkpoint_size();
    summary.expected_time += impl.low->measure_step() * static_cast<double>(impl.low->steps());
  }
  if (impl.ranks) impl.ranks->sum(&summary.checkpoint, 1);  // a file of each rank
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

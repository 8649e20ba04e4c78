#include "soil/element_mobility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "easydyn/error.hpp"
#include "easydyn/require.hpp"
#include "soil/frequency_filter.hpp"
#include "soil/impulse_synthesis.hpp"
#include "soil/layered/layered_mobility.hpp"
#include "soil/mobility_identity.hpp"
#include "soil/prediction.hpp"

namespace easydyn::soil {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;

constexpr double pulse_force = 1e6;  // [N] largest; the fields are in single precision

/// s [s] of the pulse: exp(-(pi f s)^2) = 0.1 where the loads end.
double compute_pulse_width(double highest_frequency) {
  return std::sqrt(std::log(10.0)) / (std::numbers::pi * roll_off * highest_frequency);
}

/// The pulse from where it is 1e-7 of its top on; with a crossover, until both parts have come to rest.
SurfaceLoads make_pulse(const Mobility& distances, double highest_frequency, double crossover) {
  const double width = compute_pulse_width(highest_frequency), half = 4 * width;
  const double end = crossover > 0 ? half + 3 / crossover : half;
  const auto samples = static_cast<Index>(std::ceil((half + end) / (width / 40))) + 1;
  SurfaceLoads pulse;
  pulse.footprints = {{0, 0, distances.length, distances.width}};
  pulse.time = Eigen::VectorXd::LinSpaced(samples, -half, end);
  pulse.force = pulse_force * (-(pulse.time / width).array().square()).exp().matrix();
  return pulse;
}

void check_ground(const Site& site, const std::vector<Footprint>& footprints) {
  for (std::size_t b = 0; b < site.blocks.size(); ++b) {
    const Block& block = site.blocks[b];
    const std::string who =
        fmt::format("block {}{}", b + 1, block.name.empty() ? "" : " \"" + block.name + "\"");
    if (std::isfinite(block.x[0]) || std::isfinite(block.x[1])) {
      throw ModelError(
          fmt::format("{}: x = {}..{} m, must have no ends: superposition needs a ground that does not vary "
                      "along the track (soil run takes any blocks)",
                      who, block.x[0], block.x[1]));
    }
    if (!block.mirrored && block.y[0] != -block.y[1]) {
      throw ModelError(
          fmt::format("{}: y = {}..{} m, must be symmetric about y = 0, or mirrored = true, for responses "
                      "from a quarter model (soil run --full-model takes any blocks)",
                      who, block.y[0], block.y[1]));
    }
  }
  for (std::size_t f = 0; f < footprints.size(); ++f) {
    if (footprints[f].direction != LoadDirection::down) {
      throw ModelError(fmt::format(
          "footprint {} is loaded horizontally, must be vertically for responses by finite elements "
          "(soil run and the layered half-space take any)",
          f + 1));
    }
  }
  if (site.blocks.empty()) return;
  for (std::size_t f = 0; f < footprints.size(); ++f) {
    if (std::abs(footprints[f].y) > 1e-9) {
      throw ModelError(
          fmt::format("footprint {}: y = {} m, must be 0 on a site with blocks", f + 1, footprints[f].y));
    }
  }
}

Site make_model(const Site& site, const Mobility& distances, double duration) {
  Site model = site;
  model.receivers.clear();
  for (const auto& [x, y, z] : distances.places) {
    model.receivers.push_back({fmt::format("({:.6g}, {:.6g}, {:.6g}) m", x, y, z), {x, y, z}});
  }
  model.snapshots.clear();
  model.taper_length = 0;
  model.duration = duration;
  return model;
}

SolverOptions make_options(SolverOptions options, const Mobility& distances) {
  options.half_model = options.quarter_model = true;
  options.output_step = 0;
  options.corrects_time_error = false;  // in the synthesis
  options.preload_time = 0;
  options.observed.clear();
  for (const auto& [x, y] : distances.shifts)
    options.observed.push_back({x, y, distances.length, distances.width});
  return options;
}

double choose_window(const Site& site, const Mobility& distances, double window) {
  require_not_negative("mobility", "window", window, "s");
  return ImpulseSynthesis(site.highest_frequency,
                          window > 0 ? window : estimate_element_window(site, distances))
      .window();
}

double find_reach(const Mobility& distances) {
  double reach = 0;
  for (const auto& place : distances.places) reach = std::max(reach, place[0]);
  return reach;
}

/// Takes the shifts out that lie farther along x than all places.
Mobility take_far_shifts(Mobility& distances) {
  Mobility far;
  far.length = distances.length;
  far.width = distances.width;
  const double reach = find_reach(distances);
  const auto first_far = std::stable_partition(distances.shifts.begin(), distances.shifts.end(),
                                               [&](const auto& shift) { return shift[0] <= reach + 1e-6; });
  far.shifts.assign(first_far, distances.shifts.end());
  distances.shifts.erase(first_far, distances.shifts.end());
  return far;
}

// Puts the shifts of `from` in the place of those of `to`, or behind them. The shorter responses are continued by zeros.
void set_shifts(const Mobility& from, Mobility& to) {
  const Index rows = std::max(from.mean.rows(), to.mean.rows());
  for (Eigen::MatrixXd* h : {&to.hx, &to.hy, &to.hz, &to.mean})
    h->conservativeResizeLike(Eigen::MatrixXd::Zero(rows, h->cols()));
  for (std::size_t s = 0; s < from.shifts.size(); ++s) {
    const auto there = std::find(to.shifts.begin(), to.shifts.end(), from.shifts[s]);
    const auto column = static_cast<Index>(there - to.shifts.begin());
    if (there == to.shifts.end()) {
      to.shifts.push_back(from.shifts[s]);
      to.mean.conservativeResize(Eigen::NoChange, column + 1);
    }
    to.mean.col(column).setZero();
    to.mean.col(column).head(from.mean.rows()) = from.mean.col(static_cast<Index>(s));
  }
}

// Longest side of the elements under the load.
double find_element_side(const Lattice& lattice) {
  return std::max(lattice.x[1] - lattice.x[0], lattice.y[1] - lattice.y[0]);
}

}  // namespace

double estimate_element_window(const Site& site, const Mobility& distances) {
  Mobility near = distances;
  if (site.blocks.empty()) take_far_shifts(near);
  double slowest = site.layers.front().cs;
  for (const Layer& layer : site.layers) slowest = std::min(slowest, layer.cs);
  for (const Block& block : site.blocks)
    if (!block.open) slowest = std::min(slowest, block.material.cs);
  double crossing = 0;  // [s] of a shear wave from the half-space to the surface
  for (std::size_t i = 0; i + 1 < site.layers.size(); ++i)
    crossing += site.layers[i].thickness / site.layers[i].cs;
  const double decay = std::max({0.5, 10 / site.highest_frequency, 8 * 2 * crossing});
  return near.farthest() / (0.8 * slowest) + decay;
}

ElementMobility::ElementMobility(const Site& site, const std::vector<Footprint>& footprints,
                                 const ElementMobilityOptions& options)
    : site_((check_ground(site, footprints), site)),
      options_(options),
      near_(list_distances(footprints, site.receivers)),
      far_(site.blocks.empty() ? take_far_shifts(near_) : Mobility{}),
      window_(choose_window(site, near_, options.window)),
      pulse_(make_pulse(near_, site.highest_frequency, options.solver.crossover_frequency)),
      model_(make_model(site, near_, window_ - pulse_.time(0))),
      solver_(model_, pulse_, make_options(options.solver, near_)) {}

Mobility ElementMobility::compute_layered_shifts(GroundDamping damping) {
  Mobility layered = far_;
  const LayeredGround ground(site_, damping);
  const double side = find_element_side(solver_.lattice());
  for (const auto& shift : near_.shifts)
    if (std::hypot(shift[0], shift[1]) < side) layered.shifts.push_back(shift);
  layered.length = near_.length;
  layered.width = near_.width;
  const double window = far_.shifts.empty() ? 0 : estimate_window(ground.slowest_cs(), far_);
  update_mobility(ground, site_.highest_frequency, layered, std::max(window, window_),
                  options_.solver.threads);
  return layered;
}

StoredMobility ElementMobility::compute(const RunControl& control) {
  const GroundDamping damping = options_.solver.damping == DampingModel::none ? GroundDamping::none
                                : options_.solver.damping == DampingModel::stiffness_proportional
                                    ? GroundDamping::stiffness_proportional
                                    : GroundDamping::maxwell_body;
  // Before the run, which looks at once whether it is to stop.
  const Mobility layered = site_.blocks.empty() ? compute_layered_shifts(damping) : Mobility{};
  const GroundMotion motion = solver_.run(control);
  const ImpulseSynthesis synthesis(site_.highest_frequency, window_);
  const Index lines = synthesis.w().size(), nt = motion.time.size();
  const double dt = solver_.time_step(), width = compute_pulse_width(site_.highest_frequency);
  const double output_step = (motion.time(nt - 1) - motion.time(0)) / static_cast<double>(nt - 1);

  // Transforms of displacements, and of velocities v_n = (u_n+1 - u_n-1) / (2 dt), at the lines.
  Eigen::MatrixXcd of_displacement(lines, nt);
  Eigen::VectorXcd per_velocity(lines);
  for (Index i = 0; i < lines; ++i) {
    const Complex s = Complex(0, 1) * synthesis.w()(i);
    const Complex z = options_.removes_time_error ? 2 / dt * std::asinh(s * dt / 2.0) : s;
    const Complex pulse =
        pulse_force * width * std::sqrt(std::numbers::pi) * std::exp(z * z * width * width / 4.0);
    of_displacement.row(i) =
        output_step / pulse * (-z * motion.time.cast<Complex>()).array().exp().matrix().transpose();
    per_velocity(i) = options_.removes_time_error ? dt / std::sinh(z * dt) : 1.0 / s;
  }
  const auto transform = [&](const Eigen::MatrixXd& records) -> Eigen::MatrixXcd {
    Eigen::MatrixXcd spectra(lines, records.cols());
    spectra.real() = of_displacement.real() * records;
    spectra.imag() = of_displacement.imag() * records;
    return spectra;
  };
  StoredMobility stored;
  stored.site = site_;
  stored.method = element_method;
  stored.damping = damping;
  stored.window = window_;
  stored.identity = describe_responses(site_, stored.damping, &options_.solver);
  add_mesh(stored.parameters, site_, solver_);
  stored.mobility = near_;
  const auto integrate = [&](const Eigen::MatrixXd& velocity) -> Eigen::MatrixXcd {
    return per_velocity.asDiagonal() * transform(velocity);
  };
  synthesis.update(
      stored.mobility, integrate(motion.vx), integrate(motion.vy), integrate(motion.vz),
      transform(motion.footprint_displacement.rightCols(static_cast<Index>(near_.shifts.size()))));
  stored.rest = find_rest(stored.mobility);
  if (site_.blocks.empty()) {
    if (const ResponseRest rest = find_rest(layered); rest.share > stored.rest.share) stored.rest = rest;
    set_shifts(layered, stored.mobility);
    stored.parameters.push_back(
        {"mesh", near_footprints_row, find_element_side(solver_.lattice()), "m", "computed"});
  }
  if (!far_.shifts.empty())
    stored.parameters.push_back({"mesh", far_footprints_row, find_reach(near_), "m", "computed"});
  for (const auto& shift : stored.mobility.shifts) {
    const bool is_layered = std::ranges::find(layered.shifts, shift) != layered.shifts.end();
    stored.shift_methods.emplace_back(is_layered ? layered_method : element_method);
  }
  stored.parameters.push_back(describe_rest(stored.rest));
  return stored;
}

}  // namespace easydyn::soil

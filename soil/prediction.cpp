#include "soil/prediction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "easydyn/results/progress.hpp"
#include "soil/disk_space.hpp"
#include "soil/frequency_filter.hpp"

namespace easydyn::soil {
namespace {

// The rows of the table of parameters that describe the ground; the half-space has no thickness.
void add_site(std::vector<Parameter>& rows, const Site& site) {
  for (std::size_t i = 0; i < site.layers.size(); ++i) {
    const Layer& layer = site.layers[i];
    const std::string group = fmt::format("layer {}{}{}", i + 1, layer.name.empty() ? "" : ": ", layer.name);
    if (std::isfinite(layer.thickness)) {
      rows.push_back({group, "thickness", layer.thickness, "m", layer.source});
    }
    rows.push_back({group, "density", layer.density, "kg/m3", layer.source});
    rows.push_back({group, "shear wave speed", layer.cs, "m/s", layer.source});
    rows.push_back({group, "compression wave speed", layer.cp, "m/s", layer.source});
    rows.push_back({group, "damping ratio", layer.damping, "1", layer.source});
  }
  for (std::size_t i = 0; i < site.blocks.size(); ++i) {
    const Block& block = site.blocks[i];
    const Layer& material = block.material;
    const std::string group = fmt::format("block {}{}{}{}", i + 1, block.name.empty() ? "" : ": ", block.name,
                                          block.mirrored ? ", mirrored about y = 0" : "");
    const char* const axes[3] = {"x", "y", "z"};
    const std::array<double, 2>* const ranges[3] = {&block.x, &block.y, &block.z};
    for (int axis = 0; axis < 3; ++axis) {
      const char* const ends[2] = {" from", " to"};
      for (int end = 0; end < 2; ++end) {
        if (std::isfinite((*ranges[axis])[end])) {
          rows.push_back(
              {group, std::string(axes[axis]) + ends[end], (*ranges[axis])[end], "m", material.source});
        }
      }
    }
    rows.push_back({group, "open (0 no, 1 yes)", block.open ? 1.0 : 0.0, "1", material.source});
    if (block.open) continue;
    rows.push_back({group, "density", material.density, "kg/m3", material.source});
    rows.push_back({group, "shear wave speed", material.cs, "m/s", material.source});
    rows.push_back({group, "compression wave speed", material.cp, "m/s", material.source});
    rows.push_back({group, "damping ratio", material.damping, "1", material.source});
  }
}

template <typename T>
std::string origin_of_option(const T& value, const T& standard) {
  return value == standard ? "default" : "option";
}

// Numbers stand for choices; the name says which.
void add_options(std::vector<Parameter>& rows, const Site& site, const SolverOptions& options) {
  const SolverOptions standard;
  const auto add = [&](const char* group, const char* name, const char* unit, double value,
                       double default_value) {
    rows.push_back({group, name, value, unit, origin_of_option(value, default_value)});
  };
  const auto number = [](DampingModel model) {
    return model == DampingModel::none ? 0.0 : model == DampingModel::stiffness_proportional ? 1.0 : 2.0;
  };
  const char* const damping = "material damping (0 none, 1 stiffness, 2 constant)";
  if (std::any_of(site.layers.begin(), site.layers.end(), [](const Layer& l) { return l.damping > 0; })) {
    add("solver", damping, "1", number(options.damping), number(standard.damping));
  } else {
    rows.push_back({"solver", damping, 0, "1", "all damping ratios are 0"});
  }
  add("solver", "degree of the elements", "1", options.degree, standard.degree);
  add("solver", "precision of the fields", "bit", options.double_precision ? 64 : 32,
      standard.double_precision ? 64 : 32);
  add("solver", "crossover to the lattice of low frequencies (0: none)", "Hz", options.crossover_frequency,
      standard.crossover_frequency);
  add("solver", "time error of the leapfrog taken away (0 no, 1 yes)", "1", options.corrects_time_error,
      standard.corrects_time_error);
  add("solver", "half model, y >= 0 (0 no, 1 yes)", "1", options.half_model, standard.half_model);
  add("solver", "quarter model, x >= 0 and y >= 0 (0 no, 1 yes)", "1", options.quarter_model,
      standard.quarter_model);
  add("boundary", "dashpots and far-field springs on the outer faces (0 no, 1 yes)", "1", options.dashpots,
      standard.dashpots);
}

void add_setting(std::vector<Parameter>& rows, const Site& site, const char* name, const char* unit,
                 const char* key, double Site::*value) {
  const Site standard;
  const char* const origin = site.given.contains(key)         ? "site file"
                             : site.*value == standard.*value ? "default"
                                                              : "caller";
  rows.push_back({"solver", name, site.*value, unit, origin});
}

/// The layer that alone makes the time step less than half of what the others allow; -1: none.
int find_dictating_layer(const Site& site, const Lattice& lattice) {
  // A wave may not cross an element in a step; along x and y the elements are alike in all layers.
  const auto crossing = [&](int ez) {
    return (lattice.z[ez + 1] - lattice.z[ez]) / site.layers[lattice.layer[ez]].cp;
  };
  int shortest = 0;
  for (int ez = 1; ez < lattice.nz(); ++ez) {
    if (crossing(ez) < crossing(shortest)) shortest = ez;
  }
  double others = std::numeric_limits<double>::infinity();
  for (int ez = 0; ez < lattice.nz(); ++ez) {
    const double cp = site.layers[lattice.layer[ez]].cp;
    const double side = std::min(lattice.x[1] - lattice.x[0], lattice.y[1] - lattice.y[0]) / cp;
    others = std::min(others, lattice.layer[ez] == lattice.layer[shortest] ? side : crossing(ez));
  }
  return crossing(shortest) < 0.5 * others ? lattice.layer[shortest] : -1;
}

}  // namespace

WaveSolver make_solver(const Site& site, const SurfaceLoads& loads, const SolverOptions& options,
                       Ranks* ranks) {
  SurfaceLoads limited = loads;
  const auto intervals = static_cast<double>(loads.time.size() - 1);
  const double step = (loads.time(loads.time.size() - 1) - loads.time(0)) / intervals;
  limited.force = limit_band(loads.force, step, site.highest_frequency);
  return WaveSolver(site, limited, options, ranks);
}

void add_settings(std::vector<Parameter>& rows, const Site& site) {
  add_setting(rows, site, "highest frequency", "Hz", "highest_frequency", &Site::highest_frequency);
  add_setting(rows, site, "frequency of the damping ratios and wave speeds", "Hz", "damping_frequency",
              &Site::damping_frequency);
  add_setting(rows, site, "length over which the loads fade out", "m", "taper_length", &Site::taper_length);
}

void add_mesh(std::vector<Parameter>& rows, const Site& site, WaveSolver& solver) {
  add_setting(rows, site, "points per shortest wavelength", "1", "points_per_wavelength",
              &Site::points_per_wavelength);
  add_setting(rows, site, "undamped ground around loads and receivers", "m", "margin", &Site::margin);
  add_options(rows, site, solver.options());
  const RunSummary summary = solver.compute_summary();
  const Lattice& lattice = solver.lattice();
  rows.push_back({"boundary", "sponge elements on each outer side (three quarters of it below)",
                  static_cast<double>(lattice.sponge_y[1]), "1",
                  solver.options().sponge_elements < 0 ? "computed" : "option"});
  const auto add = [&](const char* group, const char* name, double value, const char* unit) {
    rows.push_back({group, name, value, unit, "computed"});
  };
  add("mesh", "extent along x, with the sponge", lattice.x.back() - lattice.x.front(), "m");
  add("mesh", "extent along y, with the sponge", lattice.y.back() - lattice.y.front(), "m");
  add("mesh", "depth, with the sponge", lattice.z.back() - lattice.z.front(), "m");
  add("mesh", "elements", static_cast<double>(summary.elements), "1");
  add("mesh", "degrees of freedom", static_cast<double>(summary.dofs), "1");
  add("mesh", "time step", summary.time_step, "s");
  add("mesh", "steps", static_cast<double>(summary.steps), "1");
}

Vibrations describe_prediction(const Site& site, const SurfaceLoads& loads) {
  Vibrations v;
  add_site(v.parameters, site);
  v.receivers = site.receivers;
  v.highest_frequency = site.highest_frequency;
  v.site_text = site.text;
  v.footprint_x.resize(static_cast<Eigen::Index>(loads.footprints.size()));
  for (Eigen::Index j = 0; j < v.footprint_x.size(); ++j) {
    v.footprint_x(j) = loads.footprints[static_cast<std::size_t>(j)].x;
  }
  return v;
}

void set_motion(Vibrations& v, GroundMotion motion) {
  v.time = std::move(motion.time);
  v.vx = std::move(motion.vx);
  v.vy = std::move(motion.vy);
  v.vz = std::move(motion.vz);
  v.footprint_displacement = std::move(motion.footprint_displacement);
  v.footprint_taper = std::move(motion.taper);
  update_indicators(v);
}

Vibrations predict_vibrations(const Site& site, const SurfaceLoads& loads, WaveSolver& solver, std::FILE* out,
                              const RunControl& control) {
  Vibrations v = describe_prediction(site, loads);
  v.method = "finite elements, all loads";
  add_settings(v.parameters, site);
  add_mesh(v.parameters, site, solver);
  std::unique_ptr<results::Progress> progress;
  if (out) {
    progress = std::make_unique<results::Progress>("waves", out);
  }
  RunControl with_progress = control;
  with_progress.progress = [&, first = true](double fraction) mutable {
    if (progress) {
      first ? progress->start_at(fraction) : progress->update(fraction);
    }
    first = false;
  };
  GroundMotion motion = solver.run(with_progress);
  if (progress) {
    progress->finish();
  }
  set_motion(v, std::move(motion));
  return v;
}

void print_run_summary(std::FILE* out, const Site& site, const SurfaceLoads& loads, WaveSolver& solver) {
  const Lattice& lattice = solver.lattice();
  const RunSummary summary = solver.compute_summary();
  const auto size = [](const std::vector<double>& lines) { return lines.back() - lines.front(); };
  const auto inside = [](const std::array<double, 2>& range) { return range[1] - range[0]; };
  fmt::print(out, "site      {}: {} layer{}, {} receiver{}, up to {} Hz\n", site.name, site.layers.size(),
             site.layers.size() == 1 ? "" : "s", site.receivers.size(), site.receivers.size() == 1 ? "" : "s",
             site.highest_frequency);
  fmt::print(out, "loads     {} footprint{}, {:.3f} to {:.3f} s\n", loads.footprints.size(),
             loads.footprints.size() == 1 ? "" : "s", loads.time(0), loads.time(loads.time.size() - 1));
  fmt::print(out, "mesh      {} x {} x {} elements of degree {}{}, {:.2f} million degrees of freedom\n",
             lattice.nx(), lattice.ny(), lattice.nz(), lattice.degree,
             lattice.quarter_model ? " (quarter model, x >= 0 and y >= 0)"
             : lattice.half_model  ? " (half model, y >= 0)"
                                   : "",
             static_cast<double>(summary.dofs) / 1e6);
  fmt::print(out,
             "          {:.1f} m x {:.1f} m x {:.1f} m, of which {:.1f} m x {:.1f} m x {:.1f} m undamped\n",
             size(lattice.x), size(lattice.y), size(lattice.z), inside(lattice.interior_x()),
             inside(lattice.interior_y()), inside(lattice.interior_z()));
  if (summary.layer_elements > 0)
    fmt::print(out, "          {} elements of perfectly matched layer, with {} of states\n",
               summary.layer_elements, format_bytes(summary.layer_memory));
  if (const Lattice* low = solver.low_lattice()) {
    fmt::print(
        out,
        "          below {} Hz: {} x {} x {} elements, {:.2f} million degrees of freedom, {:.1f} m x {:.1f} "
        "m x {:.1f} m\n",
        solver.options().crossover_frequency, low->nx(), low->ny(), low->nz(),
        static_cast<double>(low->dofs()) / 1e6, size(low->x), size(low->y), size(low->z));
  }
  fmt::print(out, "memory    {}\n", format_bytes(summary.memory));
  if (const int ranks = summary.ranks_y * summary.ranks_z; ranks > 1) {
    fmt::print(out,
               "ranks     {}: {} along y x {} along z, {} thread{} each, up to {} per step from others\n",
               ranks, summary.ranks_y, summary.ranks_z, summary.threads, summary.threads == 1 ? "" : "s",
               format_bytes(summary.halo));
  }
  fmt::print(out, "steps     {} of {:.4g} ms\n", summary.steps, 1e3 * summary.time_step);
  if (const int layer = find_dictating_layer(site, lattice); layer >= 0) {
    const Layer& thin = site.layers[static_cast<std::size_t>(layer)];
    fmt::print(out, "          so short because of layer {} \"{}\", which is only {} m thick\n", layer + 1,
               thin.name, thin.thickness);
  }
  fmt::print(out, "expected  {}, {:.3g} ms per step\n", results::format_duration(summary.expected_time),
             1e3 * summary.expected_time / static_cast<double>(summary.steps));
  std::fflush(out);
}

void print_file_summary(std::FILE* out, WaveSolver& solver, const RunControl& control) {
  const RunSummary summary = solver.compute_summary();
  double total = 0;
  if (!control.checkpoint.empty()) {
    fmt::print(out, "checkpoint {} {}\n", format_bytes(summary.checkpoint),
               control.checkpoint_interval > 0
                   ? "every " + results::format_duration(control.checkpoint_interval)
                   : std::string("when stopped"));
    total += 2 * summary.checkpoint;  // the new one is complete before the old one goes
  }
  if (!control.snapshots.empty() && summary.snapshots > 0) {
    fmt::print(out, "snapshots {} in {}\n", format_bytes(summary.snapshots), control.snapshots.string());
    std::istringstream lines(summary.snapshot_text);
    for (std::string line; std::getline(lines, line);) fmt::print(out, "          {}\n", line);
    total += summary.snapshots;
  }
  std::fflush(out);
  if (total > 0) {
    require_disk_space((control.checkpoint.empty() ? control.snapshots : control.checkpoint).parent_path(),
                       total, summary.snapshots > 0 ? "snapshots and checkpoints" : "checkpoints");
  }
}

void print_indicators(std::FILE* out, const Vibrations& v) {
  fmt::print(out, "\n{:<20} {:>12} {:>12} {:>8} {:>8}   (up to {} Hz)\n", "receiver", "PPV z", "PPV",
             "KB_Fmax", "VdB", v.highest_frequency);
  fmt::print(out, "{:<20} {:>12} {:>12} {:>8} {:>8}\n", "", "[mm/s]", "[mm/s]", "", "[dB]");
  // Of many receivers, a line or a grid is told by its ends.
  constexpr std::size_t most_rows = 24;
  const auto is_told = [&](std::size_t r) {
    const std::string& group = v.receivers[r].group;
    return v.receivers.size() <= most_rows || group.empty() || r == 0 || v.receivers[r - 1].group != group ||
           r + 1 == v.receivers.size() || v.receivers[r + 1].group != group;
  };
  for (std::size_t r = 0; r < v.receivers.size(); ++r) {
    if (!is_told(r)) {
      if (is_told(r - 1)) fmt::print(out, "{:<20} (the others are in vibrations.h5)\n", "...");
      continue;
    }
    const Indicators& indicators = v.indicators[r];
    const std::string vdb = std::isfinite(indicators.vdb) ? fmt::format("{:.1f}", indicators.vdb) : "-";
    fmt::print(out, "{:<20} {:>12.4g} {:>12.4g} {:>8.3g} {:>8}\n", v.receivers[r].name,
               1e3 * indicators.ppv[2], 1e3 * indicators.ppv[3], indicators.kb_f_max, vdb);
  }
}

}  // namespace easydyn::soil

#include "soil/prediction.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "easydyn/results/progress.hpp"
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
}

void add_solver(std::vector<Parameter>& rows, const Site& site, WaveSolver& solver) {
  const RunSummary summary = solver.compute_summary();
  const std::string given = "site file", computed = "computed";
  rows.push_back({"solver", "highest frequency", site.highest_frequency, "Hz", given});
  rows.push_back({"solver", "frequency of the damping ratios", site.damping_frequency, "Hz", given});
  rows.push_back({"solver", "points per shortest wavelength", site.points_per_wavelength, "1", given});
  rows.push_back({"solver", "undamped ground around loads and receivers", site.margin, "m", given});
  rows.push_back({"solver", "length over which the loads fade out", site.taper_length, "m", given});
  rows.push_back(
      {"solver", "degree of the elements", static_cast<double>(solver.lattice().degree), "1", given});
  rows.push_back({"solver", "elements", static_cast<double>(summary.elements), "1", computed});
  rows.push_back({"solver", "degrees of freedom", static_cast<double>(summary.dofs), "1", computed});
  rows.push_back({"solver", "time step", summary.time_step, "s", computed});
  rows.push_back({"solver", "steps", static_cast<double>(summary.steps), "1", computed});
}

std::string format_memory(double bytes) {
  return bytes < 1e9 ? fmt::format("{:.0f} MB", bytes / 1e6) : fmt::format("{:.1f} GB", bytes / 1e9);
}

}  // namespace

WaveSolver make_solver(const Site& site, const SurfaceLoads& loads, const SolverOptions& options) {
  SurfaceLoads limited = loads;
  const auto intervals = static_cast<double>(loads.time.size() - 1);
  const double step = (loads.time(loads.time.size() - 1) - loads.time(0)) / intervals;
  limited.force = limit_band(loads.force, step, site.highest_frequency);
  return WaveSolver(site, limited, options);
}

Vibrations predict_vibrations(const Site& site, const SurfaceLoads& loads, WaveSolver& solver,
                              std::FILE* out) {
  Vibrations v;
  add_site(v.parameters, site);
  add_solver(v.parameters, site, solver);
  v.receivers = site.receivers;
  v.highest_frequency = site.highest_frequency;
  v.site_text = site.text;
  v.footprint_x.resize(static_cast<Eigen::Index>(loads.footprints.size()));
  for (Eigen::Index j = 0; j < v.footprint_x.size(); ++j) {
    v.footprint_x(j) = loads.footprints[static_cast<std::size_t>(j)].x;
  }

  std::unique_ptr<results::Progress> progress;
  if (out) {
    progress = std::make_unique<results::Progress>("waves", out);
  }
  GroundMotion motion = solver.run([&](double fraction) {
    if (progress) {
      progress->update(fraction);
    }
  });
  if (progress) {
    progress->finish();
  }
  v.time = std::move(motion.time);
  v.vx = std::move(motion.vx);
  v.vy = std::move(motion.vy);
  v.vz = std::move(motion.vz);
  v.footprint_displacement = std::move(motion.footprint_displacement);
  v.footprint_taper = std::move(motion.taper);
  update_indicators(v);
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
             lattice.half_model ? " (half model, y >= 0)" : "", static_cast<double>(summary.dofs) / 1e6);
  fmt::print(out,
             "          {:.1f} m x {:.1f} m x {:.1f} m, of which {:.1f} m x {:.1f} m x {:.1f} m undamped\n",
             size(lattice.x), size(lattice.y), size(lattice.z), inside(lattice.interior_x()),
             inside(lattice.interior_y()), inside(lattice.interior_z()));
  fmt::print(out, "memory    {}\n", format_memory(summary.memory));
  fmt::print(out, "steps     {} of {:.4g} ms\n", summary.steps, 1e3 * summary.time_step);
  fmt::print(out, "expected  {}\n", results::format_duration(summary.expected_time));
  std::fflush(out);
}

void print_indicators(std::FILE* out, const Vibrations& v) {
  fmt::print(out, "\n{:<20} {:>12} {:>12} {:>8} {:>8}   (up to {} Hz)\n", "receiver", "PPV z", "PPV",
             "KB_Fmax", "VdB", v.highest_frequency);
  fmt::print(out, "{:<20} {:>12} {:>12} {:>8} {:>8}\n", "", "[mm/s]", "[mm/s]", "", "[dB]");
  for (std::size_t r = 0; r < v.receivers.size(); ++r) {
    const Indicators& indicators = v.indicators[r];
    const std::string vdb = std::isfinite(indicators.vdb) ? fmt::format("{:.1f}", indicators.vdb) : "-";
    fmt::print(out, "{:<20} {:>12.4g} {:>12.4g} {:>8.3g} {:>8}\n", v.receivers[r].name,
               1e3 * indicators.ppv[2], 1e3 * indicators.ppv[3], indicators.kb_f_max, vdb);
  }
}

}  // namespace easydyn::soil

#include "soil/run_identity.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "easydyn/results/provenance.hpp"
#include "soil/checksum.hpp"
#include "soil/mobility_identity.hpp"
#include "soil/simd.hpp"
#include "soil/wave_solver.hpp"

namespace easydyn::soil {
namespace {

std::string checksum_of(const Site& site) {
  Checksum sum;
  sum.add_text(site.text);
  for (const Layer& layer : site.layers)
    for (const double value : {layer.thickness, layer.density, layer.cs, layer.cp, layer.damping})
      sum.add_value(value);
  for (const Block& block : site.blocks) {
    for (const auto& range : {block.x, block.y, block.z}) sum.add_value(range);
    for (const double value : {block.open ? 1.0 : 0.0, block.mirrored ? 1.0 : 0.0, block.material.density,
                               block.material.cs, block.material.cp, block.material.damping})
      sum.add_value(value);
  }
  for (const Receiver& receiver : site.receivers) {
    sum.add_text(receiver.name);
    sum.add_value(receiver.position);
  }
  for (const double value : {site.highest_frequency, site.damping_frequency, site.points_per_wavelength,
                             site.taper_length, site.margin, site.duration, site.decay_time})
    sum.add_value(value);
  return fmt::format("{:016x}", sum.value());
}

void add(Checksum& sum, const std::vector<Footprint>& footprints) {
  for (const Footprint& f : footprints)
    for (const double value :
         {f.x, f.y, f.length, f.width, static_cast<double>(f.direction), static_cast<double>(f.source)})
      sum.add_value(value);
}

std::string checksum_of(const std::vector<Footprint>& footprints) {
  Checksum sum;
  add(sum, footprints);
  return fmt::format("{:016x}", sum.value());
}

std::string checksum_of(const SurfaceLoads& loads) {
  Checksum sum;
  const auto add_values = [&](const auto& values) {
    sum.add(values.data(), sizeof(double) * static_cast<std::size_t>(values.size()));
  };
  add_values(loads.time);
  add(sum, loads.footprints);
  add_values(loads.force);
  return fmt::format("{:016x}", sum.value());
}

}  // namespace

RunIdentity describe_run(const Site& site, const SurfaceLoads& loads, const SolverOptions& options) {
  const auto damping = [](DampingModel model) {
    return model == DampingModel::none                     ? "none"
           : model == DampingModel::stiffness_proportional ? "stiffness"
                                                           : "constant";
  };
  const auto yes = [](bool value) { return value ? "yes" : "no"; };
  const auto number = [](double value) { return fmt::format("{}", value); };
  return {{"version of the program", results::library_version()},
          {"revision of the responses", number(response_revision)},
          {"width of the vector registers [byte]", number(simd_bytes)},
          {"site", checksum_of(site)},
          {"surface loads", checksum_of(loads)},
          {"option degree", number(options.degree)},
          {"option damping", damping(options.damping)},
          {"option double", yes(options.double_precision)},
          {"option full-model", yes(!options.half_model)},
          {"option step_safety", number(options.step_safety)},
          {"option correct-time", yes(options.corrects_time_error)},
          {"option output_step", number(options.output_step)},
          {"option preload_time", number(options.preload_time)},
          {"option boundary", options.boundary == AbsorbingBoundary::sponge ? "sponge" : "pml"},
          {"option layer_strength", number(options.layer_strength)},
          {"option layer_alpha", number(options.layer_alpha)},
          {"option sponge_elements", number(options.sponge_elements)},
          {"option sponge_growth", number(options.sponge_growth)},
          {"option sponge_strength", number(options.sponge_strength)},
          {"option dashpots", yes(options.dashpots)},
          {"option quarter-model", yes(options.quarter_model)},
          {"option crossover_frequency", number(options.crossover_frequency)},
          {"observed footprints", checksum_of(options.observed)}};
}

std::string find_difference(const RunIdentity& before, const RunIdentity& now) {
  for (std::size_t i = 0; i < std::max(before.size(), now.size()); ++i) {
    if (i >= before.size() || i >= now.size() || before[i].name != now[i].name)
      return "what it says of its run is not what this program says";
    if (before[i].value != now[i].value)
      return fmt::format("{} was {}, is {}", now[i].name, before[i].value, now[i].value);
  }
  return {};
}

}  // namespace easydyn::soil

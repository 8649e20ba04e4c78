#include "soil/mobility_identity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "easydyn/results/provenance.hpp"

namespace easydyn::soil {
namespace {

using Lines = std::vector<std::string>;

void add_material(Lines& lines, const std::string& who, const Layer& material) {
  lines.push_back(fmt::format("{}: density = {:.10g} kg/m3", who, material.density));
  lines.push_back(fmt::format("{}: cs = {:.10g} m/s", who, material.cs));
  lines.push_back(fmt::format("{}: cp = {:.10g} m/s", who, material.cp));
  lines.push_back(fmt::format("{}: damping = {:.10g}", who, material.damping));
}

// As superpose() meets distances: to a millimetre, either side of the rounding.
template <std::size_t N>
class Places {
 public:
  explicit Places(const std::vector<std::array<double, N>>& places) {
    for (const auto& place : places) keys_.insert(key(place));
  }
  bool has(const std::array<double, N>& place) const {
    std::array<long, N> near = key(place);
    const std::array<long, N> centre = near;
    for (near[0] = centre[0] - 1; near[0] <= centre[0] + 1; ++near[0])
      for (near[1] = centre[1] - 1; near[1] <= centre[1] + 1; ++near[1])
        if (keys_.contains(near)) return true;
    return false;
  }

 private:
  static std::array<long, N> key(const std::array<double, N>& place) {
    std::array<long, N> rounded;
    for (std::size_t i = 0; i < N; ++i) rounded[i] = std::lround(std::abs(place[i]) * 1e3);
    return rounded;
  }
  std::set<std::array<long, N>> keys_;
};

}  // namespace

Lines describe_ground(const Site& site) {
  Lines lines;
  lines.push_back(fmt::format("highest_frequency = {:.10g} Hz", site.highest_frequency));
  lines.push_back(fmt::format("damping_frequency = {:.10g} Hz", site.damping_frequency));
  lines.push_back(fmt::format("layers = {}", site.layers.size()));
  for (std::size_t i = 0; i < site.layers.size(); ++i) {
    const std::string who = fmt::format("layer {}", i + 1);
    lines.push_back(fmt::format("{}: thickness = {:.10g} m", who, site.layers[i].thickness));
    add_material(lines, who, site.layers[i]);
  }
  lines.push_back(fmt::format("blocks = {}", site.blocks.size()));
  for (std::size_t i = 0; i < site.blocks.size(); ++i) {
    const Block& block = site.blocks[i];
    const std::string who = fmt::format("block {}", i + 1);
    const std::array<double, 2>* const ranges[3] = {&block.x, &block.y, &block.z};
    for (int axis = 0; axis < 3; ++axis) {
      lines.push_back(fmt::format("{}: {} = {:.10g}..{:.10g} m", who, "xyz"[axis], (*ranges[axis])[0],
                                  (*ranges[axis])[1]));
    }
    lines.push_back(fmt::format("{}: mirrored = {}", who, block.mirrored));
    lines.push_back(fmt::format("{}: open = {}", who, block.open));
    if (!block.open) add_material(lines, who, block.material);
  }
  return lines;
}

Lines describe_responses(const Site& site, GroundDamping damping, const SolverOptions* elements) {
  Lines lines;
  lines.push_back("method = " + std::string(elements ? element_method : layered_method));
  lines.push_back("version of the program = " + results::library_version());
  lines.push_back(fmt::format("revision of the responses = {}", response_revision));
  for (const std::string& line : describe_ground(site)) lines.push_back(line);
  lines.push_back("damping model = " + name_of(damping));
  if (!elements) return lines;
  lines.push_back(fmt::format("points_per_wavelength = {:.10g}", site.points_per_wavelength));
  lines.push_back(fmt::format("margin = {:.10g} m", site.margin));
  lines.push_back(fmt::format("degree of the elements = {}", elements->degree));
  lines.push_back(fmt::format("precision = {}", elements->double_precision ? "double" : "single"));
  lines.push_back(fmt::format("crossover = {:.10g} Hz", elements->crossover_frequency));
  if (elements->boundary == AbsorbingBoundary::matched_layer) lines.push_back("boundary = pml");
  return lines;
}

std::string find_difference(const Lines& there, const Lines& here) {
  for (std::size_t i = 0; i < std::max(there.size(), here.size()); ++i) {
    const std::string was = i < there.size() ? there[i] : "nothing",
                      is = i < here.size() ? here[i] : "nothing";
    if (was != is) return fmt::format("{} there, {} here", was, is);
  }
  return {};
}

std::string find_shortage(const StoredMobility& stored, double window) {
  if (stored.window >= window - 1e-6 * stored.mobility.step) return {};
  return fmt::format("responses of {:.6g} s there, {:.6g} s here", stored.window, window);
}

std::string find_missing(const Mobility& mobility, const Mobility& needed) {
  if (std::abs(mobility.length - needed.length) > 1e-6 || std::abs(mobility.width - needed.width) > 1e-6) {
    return fmt::format("a footprint of {} m x {} m there, {} m x {} m here", mobility.length, mobility.width,
                       needed.length, needed.width);
  }
  for (const auto& [direction, h] : needed.horizontal) {
    if (!mobility.horizontal.contains(direction))
      return fmt::format("no load along {} there", direction == LoadDirection::x ? "x" : "y");
  }
  const Places<3> places(mobility.places);
  for (const auto& p : needed.places) {
    if (!places.has(p))
      return fmt::format("no receiver at ({:.6g}, {:.6g}, {:.6g}) m from a footprint there", p[0], p[1],
                         p[2]);
  }
  const Places<2> shifts(mobility.shifts);
  for (const auto& s : needed.shifts) {
    if (!shifts.has(s))
      return fmt::format("no footprint at ({:.6g}, {:.6g}) m from another there", s[0], s[1]);
  }
  return {};
}

}  // namespace easydyn::soil

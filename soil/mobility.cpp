#include "soil/mobility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "easydyn/error.hpp"

namespace easydyn::soil {
namespace {

double round_distance(double distance) {
  return std::round(std::abs(distance) * 1e6) / 1e6;
}

}  // namespace

double Mobility::farthest() const {
  double farthest = 0;
  for (const auto& p : places) farthest = std::max(farthest, std::hypot(p[0], p[1], p[2]));
  for (const auto& s : shifts) farthest = std::max(farthest, std::hypot(s[0], s[1]));
  return farthest;
}

double Mobility::window() const {
  return step * static_cast<double>(hz.rows() - before);
}

std::string name_footprint(const std::vector<Footprint>& footprints, std::size_t index) {
  const int source = footprints[index].source;
  const auto of_source = [&](const Footprint& f) { return f.source == source; };
  if (std::all_of(footprints.begin(), footprints.end(), of_source))
    return fmt::format("footprint {}", index + 1);
  const auto first = footprints.begin();
  return fmt::format("footprint {} of load file {}",
                     std::count_if(first, first + static_cast<std::ptrdiff_t>(index), of_source) + 1,
                     source + 1);
}

Mobility list_distances(const std::vector<Footprint>& footprints, const std::vector<Receiver>& receivers) {
  if (footprints.empty()) throw ModelError("superposition: no footprint");
  const Footprint& first = footprints.front();
  if (first.is_point()) throw ModelError("superposition: footprint 1 is a point, must be a rectangle");
  Mobility mobility;
  mobility.length = first.length;
  mobility.width = first.width;
  std::set<std::array<double, 3>> places;
  std::set<std::array<double, 2>> shifts;
  for (std::size_t j = 0; j < footprints.size(); ++j) {
    const Footprint& f = footprints[j];
    if (std::abs(f.length - first.length) > 1e-6 || std::abs(f.width - first.width) > 1e-6) {
      throw ModelError(fmt::format(
          "superposition: {} is {} m x {} m, must be {} m x {} m like {} (soil run takes any sizes)",
          name_footprint(footprints, j), f.length, f.width, first.length, first.width,
          name_footprint(footprints, 0)));
    }
    if (f.direction != LoadDirection::down) mobility.horizontal[f.direction];
    for (const Receiver& r : receivers) {
      places.insert(
          {round_distance(r.position[0] - f.x), round_distance(r.position[1] - f.y), r.position[2]});
    }
    for (const Footprint& g : footprints)
      shifts.insert({round_distance(g.x - f.x), round_distance(g.y - f.y)});
  }
  mobility.places.assign(places.begin(), places.end());
  mobility.shifts.assign(shifts.begin(), shifts.end());
  return mobility;
}

std::array<double, 3> symmetry_signs(LoadDirection direction, double dx, double dy) {
  const double load_x = dx < 0 && direction == LoadDirection::x ? -1 : 1,
               load_y = dy < 0 && direction == LoadDirection::y ? -1 : 1, load = load_x * load_y;
  return {dx < 0 ? -load : load, dy < 0 ? -load : load, load};
}

double estimate_window(double slowest_cs, const Mobility& distances) {
  // Rayleigh waves, c_R > 0.86 c_S, slower by dispersion; then echoes of the layers.
  return 1.5 * distances.farthest() / (0.8 * slowest_cs) + 1;
}

}  // namespace easydyn::soil

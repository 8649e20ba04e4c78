#include "soil/lattice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "easydyn/error.hpp"

namespace easydyn::soil {

namespace {

void require(bool condition, const std::string& message) {
  if (!condition) throw ModelError(message);
}

std::string describe_block(const Site& site, std::size_t number) {
  const std::string& name = site.blocks[number].name;
  return fmt::format("block {}{}", number + 1, name.empty() ? "" : " \"" + name + "\"");
}

void check_material(const Layer& material, const std::string& who) {
  require(material.density > 0 && std::isfinite(material.density),
          fmt::format("{}: density = {} kg/m3, must be > 0", who, material.density));
  require(material.cs > 0 && std::isfinite(material.cs),
          fmt::format("{}: cs = {} m/s, must be > 0", who, material.cs));
  require(material.cp > material.cs * std::sqrt(4.0 / 3.0) && std::isfinite(material.cp),
          fmt::format("{}: cp = {} m/s, must be > {:.1f} m/s (1.155 cs)", who, material.cp,
                      material.cs * std::sqrt(4.0 / 3.0)));
  require(material.damping >= 0 && material.damping < 0.2,
          fmt::format("{}: damping = {}, must be in 0..0.2", who, material.damping));
}

void check_site(const Site& site) {
  require(!site.layers.empty(), "site: it needs at least one layer");
  for (std::size_t l = 0; l < site.layers.size(); ++l) {
    const Layer& layer = site.layers[l];
    const std::string who = fmt::format("layer {} \"{}\"", l + 1, layer.name);
    const bool last = l + 1 == site.layers.size();
    require(last || (layer.thickness > 0 && std::isfinite(layer.thickness)),
            fmt::format("{}: thickness = {} m, must be > 0 and finite", who, layer.thickness));
    check_material(layer, who);
  }
  for (std::size_t b = 0; b < site.blocks.size(); ++b) {
    const Block& block = site.blocks[b];
    const std::string who = describe_block(site, b);
    const std::array<double, 2>* const ranges[3] = {&block.x, &block.y, &block.z};
    for (int axis = 0; axis < 3; ++axis) {
      const auto& [low, high] = *ranges[axis];
      require(low < high, fmt::format("{}: {} = {}..{} m, must be ascending", who, "xyz"[axis], low, high));
    }
    require(std::isfinite(block.z[0]) && block.z[1] <= 0,
            fmt::format("{}: z = {}..{} m, must be finite and <= 0", who, block.z[0], block.z[1]));
    require(!block.mirrored || block.y[0] >= 0 || block.y[1] <= 0,
            fmt::format("{}: y = {}..{} m contains y = 0, must be on one side of it to be mirrored", who,
                        block.y[0], block.y[1]));
    if (!block.open) check_material(block.material, who);
  }
  require(site.highest_frequency > 0 && std::isfinite(site.highest_frequency),
          fmt::format("site: highest_frequency = {} Hz, must be > 0", site.highest_frequency));
  require(site.damping_frequency > 0 && std::isfinite(site.damping_frequency),
          fmt::format("site: damping_frequency = {} Hz, must be > 0", site.damping_frequency));
  require(site.points_per_wavelength >= 3.5 && site.points_per_wavelength < 100,
          fmt::format("site: points_per_wavelength = {}, must be in 3.5..100 (5.3 for 1 to 2 %)",
                      site.points_per_wavelength));
  require(site.margin >= 0 && std::isfinite(site.margin),
          fmt::format("site: margin = {} m, must be >= 0", site.margin));
}

/// `count` more lines beyond `from`, in steps `size` growing by `growth`; `sign` = +1 or -1.
std::vector<double> grade(double from, double size, double growth, int count, int sign) {
  std::vector<double> lines;
  for (int i = 0; i < count; ++i) {
    size *= growth;
    from += sign * size;
    lines.push_back(from);
  }
  return lines;
}

int count_elements(double length, double size) {
  return std::max(1, static_cast<int>(std::ceil(length / size - 1e-9)));
}

constexpr double smallest_distance = 1e-9;  // [m] of planes that are not the same
constexpr double far_growth = 1.5;  // of elements away from the loads, see LatticeOptions::far_frequency

/// Ascending planes without repetition.
std::vector<double> sort_planes(std::vector<double> planes) {
  std::sort(planes.begin(), planes.end());
  const auto same = [](double a, double b) { return b - a < smallest_distance; };
  planes.erase(std::unique(planes.begin(), planes.end(), same), planes.end());
  return planes;
}

/// Lines from the first to the last plane, all planes among them, between two planes evenly and at most `size`
/// apart.
std::vector<double> divide(const std::vector<double>& planes, double size) {
  std::vector<double> lines{planes.front()};
  for (std::size_t p = 0; p + 1 < planes.size(); ++p) {
    const double low = planes[p], high = planes[p + 1];
    const int count = count_elements(high - low, size);
    for (int i = 1; i < count; ++i) lines.push_back(low + (high - low) * i / count);
    lines.push_back(high);
  }
  return lines;
}

/// A block as it lies in the model: cut at its planes, or a mirror image.
struct PlacedBlock {
  std::array<double, 2> x, y, z;
  double cs;     ///< infinite if open
  int material;  ///< see LatticeBlock
};

std::vector<PlacedBlock> place_blocks(const Site& site, const LatticeOptions& options) {
  std::vector<PlacedBlock> placed;
  for (std::size_t b = 0; b < site.blocks.size(); ++b) {
    const Block& block = site.blocks[b];
    PlacedBlock here{block.x, block.y, block.z,
                     block.open ? std::numeric_limits<double>::infinity() : block.material.cs,
                     block.open ? -1 : static_cast<int>(site.layers.size() + b)};
    const auto is_even = [](const std::array<double, 2>& range) {
      return range[0] == -range[1] || std::abs(range[0] + range[1]) < smallest_distance;
    };
    if (options.quarter_model) {
      require(is_even(block.x),
              fmt::format("{}: x = {}..{} m, must be symmetric about x = 0 in the quarter model",
                          describe_block(site, b), block.x[0], block.x[1]));
      here.x[0] = 0;
    }
    const std::array<double, 2> image{-block.y[1], -block.y[0]};
    if (options.half_model || options.quarter_model) {
      require(
          block.mirrored || is_even(block.y),
          fmt::format("{}: y = {}..{} m, must be symmetric about y = 0 in the half model: mirrored = true "
                      "puts it on both sides, option --full-model keeps it on one",
                      describe_block(site, b), block.y[0], block.y[1]));
      if (!block.mirrored)
        here.y[0] = 0;
      else if (block.y[1] <= 0)
        here.y = image;
      placed.push_back(here);
    } else {
      placed.push_back(here);
      here.y = image;
      if (block.mirrored) placed.push_back(here);
    }
  }
  return placed;
}

/// Elements between two planes of ascending lines; infinite planes mean the ends.
std::array<int, 2> find_elements(const std::vector<double>& lines, const std::array<double, 2>& range) {
  const auto find = [&](double plane) {
    return static_cast<int>(std::lower_bound(lines.begin(), lines.end(), plane - smallest_distance) -
                            lines.begin());
  };
  const int last = static_cast<int>(lines.size()) - 1;
  return {std::min(find(range[0]), last), std::min(find(range[1]), last)};
}

}  // namespace

std::string describe_farthest_receiver(const Site& site) {
  const auto reach = [](const Receiver& r) {
    return std::hypot(r.position[0], r.position[1], r.position[2]);
  };
  const auto farthest =
      std::max_element(site.receivers.begin(), site.receivers.end(),
                       [&](const Receiver& a, const Receiver& b) { return reach(a) < reach(b); });
  if (farthest == site.receivers.end()) return "none";
  return fmt::format("\"{}\" at ({}, {}, {}) m", farthest->name, farthest->position[0], farthest->position[1],
                     farthest->position[2]);
}

std::string describe_slowest_layer(const Site& site) {
  const auto slowest = std::min_element(site.layers.begin(), site.layers.end(),
                                        [](const Layer& a, const Layer& b) { return a.cs < b.cs; });
  for (std::size_t b = 0; b < site.blocks.size(); ++b) {
    const Block& block = site.blocks[b];
    const bool is_slowest = std::all_of(site.blocks.begin(), site.blocks.end(), [&](const Block& other) {
      return other.open || other.material.cs >= block.material.cs;
    });
    if (!block.open && block.material.cs < slowest->cs && is_slowest)
      return fmt::format("{} with cs = {:.4g} m/s", describe_block(site, b), block.material.cs);
  }
  return fmt::format("layer {} \"{}\" with cs = {:.4g} m/s", slowest - site.layers.begin() + 1, slowest->name,
                     slowest->cs);
}

Lattice make_lattice(const Site& site, const std::vector<Footprint>& footprints,
                     const LatticeOptions& options) {
  check_site(site);
  require(options.degree >= 3 && options.degree <= 6,
          fmt::format("lattice: degree = {}, must be in 3..6", options.degree));
  require(options.sponge_elements >= 0 && options.sponge_elements <= 100,
          fmt::format("lattice: sponge_elements = {}, must be in 0..100", options.sponge_elements));
  require(options.sponge_growth >= 1 && options.sponge_growth <= 1.5,
          fmt::format("lattice: sponge_growth = {}, must be in 1..1.5", options.sponge_growth));
  require(options.far_frequency >= 0 && options.far_frequency <= site.highest_frequency,
          fmt::format("lattice: far_frequency = {} Hz, must be in 0..{} Hz, the highest_frequency",
                      options.far_frequency, site.highest_frequency));
  require(options.lanes >= 1 && options.lanes <= 64,
          fmt::format("lattice: lanes = {}, must be in 1..64", options.lanes));
  require(!footprints.empty() || !site.receivers.empty(), "lattice: neither footprints nor receivers");
  require(!footprints.empty() || !(options.far_frequency > 0), "lattice: far_frequency needs footprints");

  const bool half = options.half_model || options.quarter_model;

  // Box of all footprints, receivers and faces of blocks.
  const double infinity = std::numeric_limits<double>::infinity();
  double low_x = infinity, high_x = -infinity, low_y = infinity, high_y = -infinity, deepest = 0;
  const auto include = [&](double x0, double x1, double y0, double y1) {
    low_x = std::min(low_x, x0);
    high_x = std::max(high_x, x1);
    low_y = std::min(low_y, y0);
    high_y = std::max(high_y, y1);
  };
  for (std::size_t f = 0; f < footprints.size(); ++f) {
    const Footprint& foot = footprints[f];
    require(foot.is_point() || (foot.length > 0 && foot.width > 0 && std::isfinite(foot.length) &&
                                std::isfinite(foot.width)),
            fmt::format("footprint {}: length = {} m, width = {} m, must be > 0 (or both 0: a point)", f + 1,
                        foot.length, foot.width));
    require(std::isfinite(foot.x) && std::isfinite(foot.y),
            fmt::format("footprint {}: x = {} m, y = {} m, must be finite", f + 1, foot.x, foot.y));
    require(!options.quarter_model || (std::abs(foot.x) < 1e-9 && std::abs(foot.y) < 1e-9),
            fmt::format("footprint {}: x = {} m, y = {} m, must be 0, 0 in the quarter model", f + 1, foot.x,
                        foot.y));
    require(!options.half_model || std::abs(foot.y) < 1e-9,
            fmt::format("footprint {}: y = {} m, must be 0 in the half model (a load off the axis needs the "
                        "full model, option --full-model)",
                        f + 1, foot.y));
    include(foot.x - foot.length / 2, foot.x + foot.length / 2, foot.y - foot.width / 2,
            foot.y + foot.width / 2);
  }
  const std::array<double, 2> feet_x{low_x, high_x}, feet_y{low_y, high_y};
  for (const Receiver& receiver : site.receivers) {
    const auto [x, y, z] = receiver.position;
    require(std::isfinite(x) && std::isfinite(y) && std::isfinite(z) && z <= 0,
            fmt::format("receiver \"{}\": position = ({}, {}, {}) m, must be finite with z <= 0",
                        receiver.name, x, y, z));
    const double ahead = options.quarter_model ? std::abs(x) : x, side = half ? std::abs(y) : y;
    include(ahead, ahead, side, side);
    deepest = std::max(deepest, -z);
  }
  const std::vector<PlacedBlock> blocks = place_blocks(site, options);
  std::vector<double> planes_x, planes_y, planes_z;
  for (const PlacedBlock& block : blocks) {
    for (const double x : block.x)
      if (std::isfinite(x)) planes_x.push_back(x);
    for (const double y : block.y)
      if (std::isfinite(y)) planes_y.push_back(y);
    planes_z.insert(planes_z.end(), block.z.begin(), block.z.end());
    deepest = std::max(deepest, -block.z[0]);
  }
  for (const double x : planes_x) low_x = std::min(low_x, x), high_x = std::max(high_x, x);
  for (const double y : planes_y) low_y = std::min(low_y, y), high_y = std::max(high_y, y);
  low_x = options.quarter_model ? 0.0 : low_x - site.margin;
  high_x += site.margin;
  low_y = half ? 0.0 : low_y - site.margin;
  high_y += site.margin;

  // Element sizes: N mean node distances.
  double slowest = infinity;
  for (const Layer& layer : site.layers) slowest = std::min(slowest, layer.cs);
  for (const PlacedBlock& block : blocks) slowest = std::min(slowest, block.cs);
  const auto size_for = [&](double cs) {
    return options.degree * cs / (site.highest_frequency * site.points_per_wavelength);
  };
  const auto size_far = [&](double cs) {
    return size_for(cs) * (options.far_frequency > 0 ? site.highest_frequency / options.far_frequency : 1.0);
  };
  const double h = size_for(slowest);
  require(
      (high_x - low_x) / h < 1e5 && (high_y - low_y) / h < 1e5,
      fmt::format(
          "lattice: the undamped ground of {:.0f} m x {:.0f} m needs elements of {:.3g} m: too many; the "
          "farthest receiver is {}, the slowest ground {}",
          high_x - low_x, high_y - low_y, h, describe_farthest_receiver(site), describe_slowest_layer(site)));

  Lattice lattice;
  lattice.degree = options.degree;
  lattice.half_model = half;
  lattice.quarter_model = options.quarter_model;

  // The sponge of n elements ends with the same element size whatever n.
  const auto growth_for = [&](int n) {
    return n > options.sponge_elements ? std::pow(options.sponge_growth, double(options.sponge_elements) / n)
                                       : options.sponge_growth;
  };
  const auto add_sponge = [&](std::vector<double>& lines, int low, int high) {
    const std::vector<double> below = grade(lines.front(), lines[1] - lines[0], growth_for(low), low, -1);
    const std::vector<double> above =
        grade(lines.back(), lines.back() - lines[lines.size() - 2], growth_for(high), high, +1);
    lines.insert(lines.begin(), below.rbegin(), below.rend());
    lines.insert(lines.end(), above.begin(), above.end());
  };

  // Lines between `low` and `high`, at least; `fine` holds footprints and faces of blocks.
  const auto make_lines = [&](std::vector<double> planes, std::array<double, 2> fine, double low, double high,
                              bool ends_at_plane) {
    if (!(options.far_frequency > 0)) {
      planes.insert(planes.end(), {low, high});
      return divide(sort_planes(planes), h);
    }
    for (const double plane : planes) {
      fine[0] = std::min(fine[0], plane);
      fine[1] = std::max(fine[1], plane);
    }
    planes.insert(planes.end(), {ends_at_plane ? low : fine[0] - h, fine[1] + h});
    std::vector<double> lines = divide(sort_planes(planes), h);
    const double coarse = h * site.highest_frequency / options.far_frequency;
    double step = lines.back() - lines[lines.size() - 2];
    while (lines.back() < high || step < 0.999 * coarse)
      lines.push_back(lines.back() + (step = std::min(far_growth * step, coarse)));
    if (ends_at_plane) return lines;
    std::reverse(lines.begin(), lines.end());
    step = lines[lines.size() - 2] - lines.back();
    while (lines.back() > low || step < 0.999 * coarse)
      lines.push_back(lines.back() - (step = std::min(far_growth * step, coarse)));
    std::reverse(lines.begin(), lines.end());
    return lines;
  };
  lattice.x = make_lines(planes_x, feet_x, low_x, high_x, options.quarter_model);
  const int sides = options.quarter_model ? 1 : 2;
  const int plain_x = lattice.nx() + sides * options.sponge_elements;
  const int extra =
      options.sponge_elements > 0 ? (options.lanes - (plain_x + 2) % options.lanes) % options.lanes : 0;
  if (options.quarter_model)
    lattice.sponge_x = {0, options.sponge_elements + extra};
  else
    lattice.sponge_x = {options.sponge_elements + extra / 2, options.sponge_elements + extra - extra / 2};
  add_sponge(lattice.x, lattice.sponge_x[0], lattice.sponge_x[1]);

  lattice.sponge_y = {half ? 0 : options.sponge_elements, options.sponge_elements};
  lattice.y = make_lines(planes_y, feet_y, low_y, high_y, half);
  add_sponge(lattice.y, lattice.sponge_y[0], lattice.sponge_y[1]);

  // In depth: the layers, then the half-space to the margin below layers and receivers, then the sponge.
  std::vector<double> depth{0.0};  // downward
  std::vector<int> layer_down;
  const int last = static_cast<int>(site.layers.size()) - 1;
  // Elements of layer l down to a plane, at most as high as the slowest material there allows.
  const auto divide_down = [&](int l, double plane) {
    const double top = depth.back(), thickness = plane - top;
    double cs = site.layers[l].cs;
    for (const PlacedBlock& block : blocks)
      if (-block.z[0] > top + smallest_distance && -block.z[1] < plane - smallest_distance)
        cs = std::min(cs, block.cs);
    const double allowed = std::min(size_far(cs), std::max(size_for(cs), (far_growth - 1) * top));
    const int count = count_elements(thickness, allowed);
    for (int i = 1; i <= count; ++i) depth.push_back(top + thickness * i / count);
    layer_down.insert(layer_down.end(), count, l);
  };
  for (double& plane : planes_z) plane = -plane;
  planes_z = sort_planes(planes_z);
  for (int l = 0; l <= last; ++l) {
    const double interface = l < last ? depth.back() + site.layers[l].thickness : infinity;
    for (const double plane : planes_z)
      if (plane > depth.back() + smallest_distance && plane < interface - smallest_distance)
        divide_down(l, plane);
    if (l < last) divide_down(l, interface);
  }
  const double bottom = std::max(depth.back(), deepest) + std::max(site.margin, 0.5 * h);
  const double full = size_far(site.layers[last].cs);
  double size = depth.size() > 1 ? depth.back() - depth[depth.size() - 2] : h;
  // Coarsen at twice the pace of the sponge from the last layer's size to what the half-space allows.
  const double pace =
      std::max(options.far_frequency > 0 ? far_growth : 1.3, options.sponge_growth * options.sponge_growth);
  if (options.far_frequency > 0 && depth.size() == 1) size /= pace;
  do {
    size = std::min(full, std::max(size * pace, h));
    depth.push_back(depth.back() + size);
    layer_down.push_back(last);
  } while (depth.back() < bottom || (options.far_frequency > 0 && size < 0.999 * full));
  // Elements of the half-space are larger than those along the surface: three quarters of them reach as far.
  const int sponge_z = (3 * options.sponge_elements + 3) / 4;
  for (int i = 0; i < sponge_z; ++i) {
    size = size < full ? std::min(full * options.sponge_growth, size * pace) : size * options.sponge_growth;
    depth.push_back(depth.back() + size);
    layer_down.push_back(last);
  }
  lattice.sponge_z = {sponge_z, 0};
  for (auto d = depth.rbegin(); d != depth.rend(); ++d) lattice.z.push_back(-*d);
  lattice.z.back() = 0;
  lattice.layer.assign(layer_down.rbegin(), layer_down.rend());
  for (const PlacedBlock& block : blocks)
    lattice.blocks.push_back({find_elements(lattice.x, block.x), find_elements(lattice.y, block.y),
                              find_elements(lattice.z, block.z), block.material});
  return lattice;
}

}  // namespace easydyn::soil

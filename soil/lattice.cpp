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

void check_site(const Site& site) {
  require(!site.layers.empty(), "site: it needs at least one layer");
  for (std::size_t l = 0; l < site.layers.size(); ++l) {
    const Layer& layer = site.layers[l];
    const std::string who = fmt::format("layer {} \"{}\"", l + 1, layer.name);
    const bool last = l + 1 == site.layers.size();
    require(last || (layer.thickness > 0 && std::isfinite(layer.thickness)),
            fmt::format("{}: thickness = {} m, must be > 0 and finite", who, layer.thickness));
    require(layer.density > 0 && std::isfinite(layer.density),
            fmt::format("{}: density = {} kg/m3, must be > 0", who, layer.density));
    require(layer.cs > 0 && std::isfinite(layer.cs),
            fmt::format("{}: cs = {} m/s, must be > 0", who, layer.cs));
    require(layer.cp > layer.cs * std::sqrt(4.0 / 3.0) && std::isfinite(layer.cp),
            fmt::format("{}: cp = {} m/s, must be > {:.1f} m/s (1.155 cs)", who, layer.cp,
                        layer.cs * std::sqrt(4.0 / 3.0)));
    require(layer.damping >= 0 && layer.damping < 0.2,
            fmt::format("{}: damping = {}, must be in 0..0.2", who, layer.damping));
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

std::vector<double> divide(double low, double high, int count) {
  std::vector<double> lines(count + 1);
  for (int i = 0; i <= count; ++i) lines[i] = low + (high - low) * i / count;
  lines.back() = high;
  return lines;
}

int count_elements(double length, double size) {
  return std::max(1, static_cast<int>(std::ceil(length / size - 1e-9)));
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
  require(options.lanes >= 1 && options.lanes <= 64,
          fmt::format("lattice: lanes = {}, must be in 1..64", options.lanes));
  require(!footprints.empty() || !site.receivers.empty(), "lattice: neither footprints nor receivers");

  // Box of all footprints and receivers.
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
    require(foot.length > 0 && foot.width > 0 && std::isfinite(foot.length) && std::isfinite(foot.width),
            fmt::format("footprint {}: length = {} m, width = {} m, must be > 0", f + 1, foot.length,
                        foot.width));
    require(std::isfinite(foot.x) && std::isfinite(foot.y),
            fmt::format("footprint {}: x = {} m, y = {} m, must be finite", f + 1, foot.x, foot.y));
    require(!options.half_model || std::abs(foot.y) < 1e-9,
            fmt::format("footprint {}: y = {} m, must be 0 in the half model (a load off the axis needs the "
                        "full model, option --full-model)",
                        f + 1, foot.y));
    include(foot.x - foot.length / 2, foot.x + foot.length / 2, foot.y - foot.width / 2,
            foot.y + foot.width / 2);
  }
  for (const Receiver& receiver : site.receivers) {
    const auto [x, y, z] = receiver.position;
    require(std::isfinite(x) && std::isfinite(y) && std::isfinite(z) && z <= 0,
            fmt::format("receiver \"{}\": position = ({}, {}, {}) m, must be finite with z <= 0",
                        receiver.name, x, y, z));
    const double side = options.half_model ? std::abs(y) : y;
    include(x, x, side, side);
    deepest = std::max(deepest, -z);
  }
  low_x -= site.margin;
  high_x += site.margin;
  low_y = options.half_model ? 0.0 : low_y - site.margin;
  high_y += site.margin;

  // Element sizes: N mean node distances.
  double slowest = infinity;
  for (const Layer& layer : site.layers) slowest = std::min(slowest, layer.cs);
  const auto size_for = [&](double cs) {
    return options.degree * cs / (site.highest_frequency * site.points_per_wavelength);
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
  lattice.half_model = options.half_model;

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

  const int inner_x = count_elements(high_x - low_x, h);
  const int plain_x = inner_x + 2 * options.sponge_elements;
  const int extra =
      options.sponge_elements > 0 ? (options.lanes - (plain_x + 2) % options.lanes) % options.lanes : 0;
  lattice.sponge_x = {options.sponge_elements + extra / 2, options.sponge_elements + extra - extra / 2};
  lattice.x = divide(low_x, high_x, inner_x);
  add_sponge(lattice.x, lattice.sponge_x[0], lattice.sponge_x[1]);

  lattice.sponge_y = {options.half_model ? 0 : options.sponge_elements, options.sponge_elements};
  lattice.y = divide(low_y, high_y, count_elements(high_y - low_y, h));
  add_sponge(lattice.y, lattice.sponge_y[0], lattice.sponge_y[1]);

  // In depth: the layers, then the half-space to the margin below layers and receivers, then the sponge.
  std::vector<double> depth{0.0};  // downward
  std::vector<int> layer_down;
  const int last = static_cast<int>(site.layers.size()) - 1;
  for (int l = 0; l < last; ++l) {
    const double thickness = site.layers[l].thickness, top = depth.back();
    const int count = count_elements(thickness, size_for(site.layers[l].cs));
    for (int i = 1; i <= count; ++i) depth.push_back(top + thickness * i / count);
    layer_down.insert(layer_down.end(), count, l);
  }
  const double bottom = std::max(depth.back(), deepest) + std::max(site.margin, 0.5 * h);
  const double full = size_for(site.layers[last].cs);
  double size = depth.size() > 1 ? depth.back() - depth[depth.size() - 2] : h;
  // Coarsen at twice the pace of the sponge from the last layer's size to what the half-space allows.
  const double pace = std::max(1.3, options.sponge_growth * options.sponge_growth);
  do {
    size = std::min(full, std::max(size * pace, h));
    depth.push_back(depth.back() + size);
    layer_down.push_back(last);
  } while (depth.back() < bottom);
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
  return lattice;
}

}  // namespace easydyn::soil

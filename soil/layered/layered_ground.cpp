#include "soil/layered/layered_ground.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "easydyn/error.hpp"
#include "easydyn/require.hpp"

namespace easydyn::soil {
namespace {

constexpr double pi = std::numbers::pi;
using Complex = std::complex<double>;

void check_layers(const Site& site) {
  if (site.layers.empty()) throw ModelError("layered ground: no layer, at least the half-space is needed");
  for (std::size_t i = 0; i < site.layers.size(); ++i) {
    const Layer& layer = site.layers[i];
    const std::string object =
        fmt::format("layer {}{}", i + 1, layer.name.empty() ? "" : " \"" + layer.name + "\"");
    if (i + 1 < site.layers.size()) require_positive(object, "thickness", layer.thickness, "m");
    require_positive(object, "density", layer.density, "kg/m3");
    require_positive(object, "cs", layer.cs, "m/s");
    require(layer.cp > layer.cs * std::sqrt(4.0 / 3), object, "cp", layer.cp, "m/s", "> cs sqrt(4/3)");
    require(layer.damping >= 0 && layer.damping < 0.2, object, "damping", layer.damping, "",
            ">= 0 and < 0.2");
  }
  require_positive("site", "damping_frequency", site.damping_frequency, "Hz");
  require_positive("site", "highest_frequency", site.highest_frequency, "Hz");
}

}  // namespace

LayeredGround::LayeredGround(const Site& site, GroundDamping damping)
    : layers_(site.layers), damping_(damping), reference_(2 * pi * site.damping_frequency) {
  check_layers(site);
  layers_.back().thickness = std::numeric_limits<double>::infinity();
  if (damping_ == GroundDamping::none) {
    for (Layer& layer : layers_) layer.damping = 0;
  }
  if (damping_ == GroundDamping::maxwell_body) {
    for (const Layer& layer : layers_) {
      bodies_.push_back(
          fit_relaxation_of_band(layer.damping, site.highest_frequency, site.damping_frequency));
    }
  }
}

double LayeredGround::slowest_cs() const {
  return std::min_element(layers_.begin(), layers_.end(),
                          [](const Layer& a, const Layer& b) { return a.cs < b.cs; })
      ->cs;
}

double LayeredGround::fastest_cp() const {
  return std::max_element(layers_.begin(), layers_.end(),
                          [](const Layer& a, const Layer& b) { return a.cp < b.cp; })
      ->cp;
}

double LayeredGround::lowest_damping() const {
  return std::min_element(layers_.begin(), layers_.end(),
                          [](const Layer& a, const Layer& b) { return a.damping < b.damping; })
      ->damping;
}

double LayeredGround::depth() const {
  double depth = 0;
  for (std::size_t i = 0; i + 1 < layers_.size(); ++i) depth += layers_[i].thickness;
  return depth;
}

double LayeredGround::thinnest_layer() const {
  double thinnest = std::numeric_limits<double>::infinity();
  for (const Layer& layer : layers_) thinnest = std::min(thinnest, layer.thickness);
  return thinnest;
}

Complex LayeredGround::compute_modulus_factor(std::size_t layer, Complex w) const {
  const double ratio = layers_[layer].damping;
  const Complex iw = Complex(0, 1) * w;
  if (ratio == 0) return 1;
  switch (damping_) {
    case GroundDamping::none:
      return 1;
    case GroundDamping::stiffness_proportional:
      return 1.0 + 2 * ratio * iw / reference_;
    case GroundDamping::maxwell_body:
      return bodies_[layer].compute_modulus(w);
    case GroundDamping::constant_q: {
      if (w == 0.0) {
        throw ModelError(
            "layered ground: frequency = 0 Hz, must be > 0 with constant Q: its moduli vanish there");
      }
      const double gamma = std::atan(2 * ratio) / pi;
      return std::pow(iw / reference_, 2 * gamma) / std::cos(pi * gamma);
    }
  }
  return 1;
}

std::vector<LayerAtFrequency> LayeredGround::compute_layers(Complex w) const {
  std::vector<LayerAtFrequency> at;
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    const Layer& layer = layers_[i];
    const Complex mu = layer.shear_modulus() * compute_modulus_factor(i, w);
    at.push_back({.thickness = layer.thickness,
                  .mu = mu,
                  .ks2 = layer.density * w * w / mu,
                  .speed_ratio2 = layer.cs * layer.cs / (layer.cp * layer.cp)});
  }
  return at;
}

}  // namespace easydyn::soil

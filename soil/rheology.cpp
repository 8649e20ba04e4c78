#include "soil/rheology.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "easydyn/error.hpp"
#include "soil/relaxation.hpp"
#include "soil/wave_solver.hpp"

namespace easydyn::soil {
namespace {

// The fit spans the band of the site and the frequency at which the ratio is given.
Relaxation fit_constant_ratio(const Site& site, const Layer& layer) {
  const double high = site.highest_frequency, reference = site.damping_frequency,
               low = std::max(high / 40, choose_damping_band(high, reference).lowest);
  const Relaxation body = fit_relaxation_of_band(layer.damping, high, reference);
  bool is_sound = body.weights.allFinite() && body.weights.sum() < 1;
  for (double f = low; f <= 1.001 * high; f *= 1.2)
    is_sound = is_sound && std::abs(body.compute_damping_ratio(f) - layer.damping) <= 0.25 * layer.damping;
  if (!is_sound)
    throw ModelError(
        fmt::format("layer \"{}\": damping = {} at damping_frequency = {} Hz cannot be held over {} to {} Hz "
                    "within a quarter; "
                    "damping_frequency must be nearer to that band, or the damping lower",
                    layer.name, layer.damping, reference, low, high));
  return body;
}

}  // namespace

Rheology make_rheology(const Site& site, DampingModel model) {
  Rheology rheology;
  const bool damped =
      std::any_of(site.layers.begin(), site.layers.end(), [](const Layer& l) { return l.damping > 0; }) ||
      std::any_of(site.blocks.begin(), site.blocks.end(),
                  [](const Block& b) { return !b.open && b.material.damping > 0; });
  std::vector<const Layer*> all;
  for (const Layer& layer : site.layers) all.push_back(&layer);
  for (const Block& block : site.blocks) all.push_back(block.open ? &site.layers.front() : &block.material);
  for (const Layer* const each : all) {
    const Layer& layer = *each;
    EngineMaterial material{layer.lame_lambda(), layer.shear_modulus(), layer.density, 0, {}};
    if (damped && model == DampingModel::stiffness_proportional)
      material.beta = layer.damping / (M_PI * site.damping_frequency);
    if (damped && model == DampingModel::constant_ratio) {
      const Relaxation body = fit_constant_ratio(site, layer);
      material.lambda *= body.unrelaxed;
      material.mu *= body.unrelaxed;
      material.memory_weights.assign(body.weights.data(), body.weights.data() + body.weights.size());
      rheology.rates.assign(body.rates.data(), body.rates.data() + body.rates.size());
    }
    rheology.materials.push_back(material);
  }
  return rheology;
}

}  // namespace easydyn::soil

#pragma once

#include <vector>

#include "soil/engine_material.hpp"
#include "soil/site.hpp"

namespace easydyn::soil {

enum class DampingModel;

/// The materials of the layers, then of the blocks of a site, and the relaxation rates [rad/s] common to all of them.
/// What is open has no material but keeps its place.
struct Rheology {
  std::vector<EngineMaterial> materials;
  std::vector<double> rates;
};

/// @throws ModelError if a constant damping ratio cannot be held within a quarter over the band of the site
Rheology make_rheology(const Site& site, DampingModel model);

}  // namespace easydyn::soil

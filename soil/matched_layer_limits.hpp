#pragma once

#include "soil/site.hpp"

namespace easydyn::soil {

/// Whether a matched layer (matched_layer.hpp) may stand at the edge of a site. No such layer is known to stay stable in
/// every ground: it did at Poisson ratios up to 0.45 and c_p up to 4 times the lowest c_s of the layers, and grew in some grounds
/// beyond (docs/soil_boundary.md). Blocks do not go on through it as they do through a sponge.
/// @throws ModelError if the ground is beyond these bounds, or a block has no end along x or y
void check_matched_layer(const Site& site);

}  // namespace easydyn::soil

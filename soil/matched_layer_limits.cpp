#include "soil/matched_layer_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "easydyn/error.hpp"

namespace easydyn::soil {
namespace {

constexpr double highest_poisson_ratio = 0.45;
constexpr double highest_contrast = 4;  // c_p over the lowest c_s
constexpr double rounding = 1e-9;       // of speeds that were computed from each other
constexpr const char* elsewhere = "option --boundary sponge, with or without --crossover, takes any ground";

void check_blocks(const std::vector<Block>& blocks) {
  for (std::size_t b = 0; b < blocks.size(); ++b)
    for (const auto& [axis, range] : {std::pair('x', blocks[b].x), std::pair('y', blocks[b].y)})
      if (!std::isfinite(range[0]) || !std::isfinite(range[1]))
        throw ModelError(
            fmt::format("block {}{}: {} = {}..{} m reaches into the matched layer at the edge of the model, "
                        "must have ends ({})",
                        b + 1, blocks[b].name.empty() ? "" : " \"" + blocks[b].name + "\"", axis, range[0],
                        range[1], elsewhere));
}

void check_layers(const std::vector<Layer>& layers) {
  double slowest = layers.front().cs, fastest = 0;
  for (std::size_t k = 0; k < layers.size(); ++k) {
    if (!(layers[k].poisson_ratio() <= highest_poisson_ratio + rounding))
      throw ModelError(
          fmt::format("layer {}: Poisson ratio = {:.4g}, must be at most {} where a matched layer, which may "
                      "grow beyond, ends the model ({})",
                      k + 1, layers[k].poisson_ratio(), highest_poisson_ratio, elsewhere));
    slowest = std::min(slowest, layers[k].cs);
    fastest = std::max(fastest, layers[k].cp);
  }
  if (!(fastest <= (1 + rounding) * highest_contrast * slowest))
    throw ModelError(fmt::format(
        "layers: highest c_p = {:.4g} m/s is {:.3g} times the lowest c_s, must be at most {} times "
        "where a matched layer, which may grow beyond, ends the model ({})",
        fastest, fastest / slowest, highest_contrast, elsewhere));
}

}  // namespace

void check_matched_layer(const Site& site) {
  check_blocks(site.blocks);
  check_layers(site.layers);
}

}  // namespace easydyn::soil

#include "soil/site.hpp"

#include <fmt/format.h>

namespace easydyn::soil {

std::vector<std::string> unusual_values(const Site& site) {
  std::vector<std::string> sentences;
  const auto check_material = [&](const char* kind, std::size_t number, const Layer& material) {
    const auto check = [&](const char* name, double value, double low, double high, const char* unit) {
      if (value >= low && value <= high) return;
      sentences.push_back(fmt::format("{} {}{}: {} = {:.4g} {} is unusual ({:g} to {:g}); is the unit right?",
                                      kind, number, material.name.empty() ? "" : " \"" + material.name + "\"",
                                      name, value, unit, low, high));
    };
    check("density", material.density, 1000, 3000, "kg/m3");
    check("shear wave speed", material.cs, 30, 3000, "m/s");
    if (material.damping > 0) check("damping", material.damping, 0.005, 0.15, "");
  };
  for (std::size_t i = 0; i < site.layers.size(); ++i) check_material("layer", i + 1, site.layers[i]);
  for (std::size_t i = 0; i < site.blocks.size(); ++i) {
    if (!site.blocks[i].open) check_material("block", i + 1, site.blocks[i].material);
  }
  return sentences;
}

}  // namespace easydyn::soil

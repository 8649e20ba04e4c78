#include "soil/site.hpp"

#include <fmt/format.h>

namespace easydyn::soil {

std::vector<std::string> unusual_values(const Site& site) {
  std::vector<std::string> sentences;
  for (std::size_t i = 0; i < site.layers.size(); ++i) {
    const Layer& layer = site.layers[i];
    const auto check = [&](const char* name, double value, double low, double high, const char* unit) {
      if (value >= low && value <= high) return;
      sentences.push_back(
          fmt::format("layer {}{}: {} = {:.4g} {} is unusual ({:g} to {:g}); is the unit right?", i + 1,
                      layer.name.empty() ? "" : " \"" + layer.name + "\"", name, value, unit, low, high));
    };
    check("density", layer.density, 1000, 3000, "kg/m3");
    check("shear wave speed", layer.cs, 30, 3000, "m/s");
    if (layer.damping > 0) check("damping", layer.damping, 0.005, 0.15, "");
  }
  return sentences;
}

}  // namespace easydyn::soil

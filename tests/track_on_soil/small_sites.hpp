#pragma once

#include <cmath>
#include <limits>
#include <string>

#include "soil/site.hpp"

namespace easydyn::testing {

inline soil::Layer layer_of(double thickness, double cs, double nu, double density, double damping) {
  return {.name = "layer",
          .thickness = thickness,
          .density = density,
          .cs = cs,
          .cp = cs * std::sqrt(2 * (1 - nu) / (1 - 2 * nu)),
          .damping = damping,
          .source = ""};
}

/// A homogeneous half-space, density 1800 kg/m3.
inline soil::Site half_space(double cs, double nu, double damping) {
  soil::Site site;
  site.name = "half-space";
  site.layers = {layer_of(std::numeric_limits<double>::infinity(), cs, nu, 1800, damping)};
  return site;
}

/// A site file with two layers, whose first one has this shear wave speed.
inline std::string two_layers(double cs = 120, const std::string& more = "") {
  return "name = \"two layers\"\n[[layer]]\nthickness = 1.7\ndensity = 1800\ncs = " + std::to_string(cs) +
         "\nnu = 0.33\ndamping = 0.03\n[[layer]]\ndensity = 1900\ncs = 250.1\nnu = 0.33\ndamping = 0.02\n"
         "[[receiver]]\nname = \"8 m\"\ndistance = 8\n" +
         more;
}

}  // namespace easydyn::testing

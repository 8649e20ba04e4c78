#pragma once

#include <vector>

namespace easydyn::soil {

/// Material of one layer or block as the engine needs it.
struct EngineMaterial {
  double lambda = 0, mu = 0, density = 0;  ///< [Pa], [kg/m3]; unrelaxed moduli where there is memory
  double beta = 0;                         ///< [s] stiffness-proportional damping
  std::vector<double> memory_weights;      ///< y_l of the memory variables, see relaxation.hpp
};

}  // namespace easydyn::soil

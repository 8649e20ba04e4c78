#pragma once

#include <vector>

#include "soil/lattice.hpp"

namespace easydyn::soil {

/// A weight on one node of the lattice.
struct NodeWeight {
  int X = 0, Y = 0, Z = 0;
  double weight = 0;
};

/// Uniform unit force over a footprint, integrated exactly with the shape functions: the nodal forces, which
/// are at once the weights of the mean displacement over the footprint. In the half and the quarter model the
/// part inside only; the nodal forces then add up to 1/2 or 1/4 (`force`) and the mean weights to 1 (`mean`). At a
/// point: the shape functions there. The displacement under a point load depends on the mesh (it has no limit).
struct FootprintWeights {
  std::vector<NodeWeight> force, mean;
};

/// @throws ModelError if the footprint leaves the undamped ground, naming it and the accepted range
FootprintWeights compute_footprint_weights(const Lattice& lattice, const Footprint& footprint,
                                           std::size_t number);

/// Weights of the mean over a footprint anywhere, loaded or not, of motion that is symmetric about the planes of the half
/// and the quarter model: what lies beyond them counts as its mirror image.
/// @throws ModelError as above
std::vector<NodeWeight> compute_mean_weights(const Lattice& lattice, const Footprint& footprint,
                                             std::size_t number);

/// Shape functions at a receiver: weights that add up to 1. In the half model a receiver at y < 0, in the quarter
/// model also one at x < 0, takes the values of its mirror image: symmetric motion changes the sign of the
/// component across the plane, antisymmetric motion that of the others.
struct ReceiverWeights {
  std::vector<NodeWeight> nodes;
  bool mirrored_x = false, mirrored_y = false;
};

/// @throws ModelError if the receiver lies outside the undamped ground, naming it and the accepted range
ReceiverWeights compute_receiver_weights(const Lattice& lattice, const Receiver& receiver);

}  // namespace easydyn::soil

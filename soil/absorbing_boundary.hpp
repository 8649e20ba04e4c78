#pragma once

namespace easydyn::soil {

/// What stands in the elements at the sides and the bottom of the model, before the dashpots and springs of its outer faces.
enum class AbsorbingBoundary {
  sponge,  ///< mass-proportional damping: takes energy away whatever the ground is
  matched_layer  ///< weak perfectly matched layer (matched_layer.hpp): sends back far less, without a proof of stability
};

}  // namespace easydyn::soil

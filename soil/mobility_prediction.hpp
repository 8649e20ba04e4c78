#pragma once

#include "soil/mobility_file.hpp"
#include "soil/surface_loads.hpp"
#include "soil/vibrations.hpp"

namespace easydyn::soil {

/// The same prediction as by finite elements under all loads, from impulse responses.
/// @throws ModelError if the responses lack a distance that receivers or loads need
Vibrations predict_vibrations(const StoredMobility& stored, const SurfaceLoads& loads, int threads = 0);

}  // namespace easydyn::soil

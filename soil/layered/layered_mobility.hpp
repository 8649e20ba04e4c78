#pragma once

#include "soil/layered/layered_ground.hpp"
#include "soil/mobility.hpp"

namespace easydyn::soil {

/// Fills the responses of a mobility, semi-analytically.
/// @param mobility  places, shifts and footprint are given
/// @param window    [s]; 0: estimate_window()
/// @param threads   0: one per core
/// @throws ModelError if a value is out of range or the responses do not fit in memory
void update_mobility(const LayeredGround& ground, double highest_frequency, Mobility& mobility,
                     double window = 0, int threads = 0);

}  // namespace easydyn::soil

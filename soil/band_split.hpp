#pragma once

#include <utility>

#include "soil/surface_loads.hpp"

namespace easydyn::soil {

/// Both parts of a split band hold something between crossover / width and crossover x width.
inline constexpr double crossover_width = 1.4142;

/// Loads that add up to the given ones: what lies below the crossover [Hz], and what lies above it. Both begin earlier,
/// because a part of a band begins before the whole does.
std::pair<SurfaceLoads, SurfaceLoads> split_band(const SurfaceLoads& loads, double crossover);

}  // namespace easydyn::soil

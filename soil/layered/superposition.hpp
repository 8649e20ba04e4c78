#pragma once

#include "soil/mobility.hpp"
#include "soil/site.hpp"
#include "soil/surface_loads.hpp"
#include "soil/wave_solver.hpp"

namespace easydyn::soil {

struct SuperpositionOptions {
  double preload_time = 0.5;    ///< [s] before the first load sample, as SolverOptions::preload_time
  int samples_per_period = 12;  ///< of the highest frequency, in the record; a multiple of 4
  int threads = 0;              ///< 0: one per core
  double memory_limit = 0;      ///< [byte]; 0: 0.8 of the memory of the machine
};

/// Ground motion under many footprints from the responses to one:
///
///   u(x, t) = sum_j taper_j int h(x - x_j, t - s) F_j(s) ds
///
/// by FFT, loads of all directions that the mobility holds. An even row of footprints, all in one direction, costs one
/// convolution along it; any others cost a product for every pair. The loads are treated as by the finite elements: limited by limit_band(), brought in over `preload_time`
/// where they start away from zero, held after their end, faded out at both ends of the track by compute_taper(). The
/// record begins with the loads and ends Site::decay_time after them (or lasts Site::duration).
/// GroundMotion::energy stays empty.
/// @throws ModelError if a distance is missing in the mobility, loads and site do not fit it, or the spectra do not
///         fit in memory
GroundMotion superpose(const Mobility& mobility, const Site& site, const SurfaceLoads& loads,
                       const SuperpositionOptions& options = {});

}  // namespace easydyn::soil

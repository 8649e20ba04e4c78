#pragma once

#include "soil/mobility_file.hpp"
#include "soil/surface_loads.hpp"
#include "soil/vibrations.hpp"

namespace easydyn::soil {

/// Impulse responses of this site for these footprints and the site's receivers, from the layered half-space.
/// @param window  [s] of the responses; 0: chosen
/// @throws ModelError if the footprints differ in size or a value is out of range
StoredMobility compute_mobility(const Site& site, const std::vector<Footprint>& footprints,
                                GroundDamping damping, double window = 0, int threads = 0);

/// The semi-analytical motion to compare a prediction with; 24 samples per period of the highest frequency.
SemiAnalyticalMotion compute_semi_analytical_motion(const Site& site, const SurfaceLoads& loads,
                                                    GroundDamping damping, int threads = 0);

/// How far a motion is from the semi-analytical one: |v - s| / |s| over the whole record (NaN where s is zero by
/// symmetry), and PPV.
struct MotionDifference {
  std::string receiver;
  double l2[3] = {};        ///< of v_x, v_y, v_z, relative to the norm of s of the component
  double dynamic_l2_z = 0;  ///< of the part of v_z above 2 Hz (recoupling_split_frequency)
  double ppv_z[2] = {};     ///< [m/s] of v_z and of s_z
};
std::vector<MotionDifference> compare_with_semi_analytical(const Vibrations& vibrations);

}  // namespace easydyn::soil

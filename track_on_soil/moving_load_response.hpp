#pragma once

#include <Eigen/Core>

#include "soil/site.hpp"
#include "track/track_data.hpp"

namespace easydyn::track_on_soil {

/// Deflection w(s) of the rail per unit constant load that moves at the speed v on the infinite track on layered ground,
/// s = x - v t ahead of it, downward [m/N]:
///
///   w(s) = 1 / pi Re int_0^inf e^(-i k s) / D(k, k v) dk,   D = E I k^4 - m_r w^2 + Z_p,  Z_p = 1 / (1 / p + 1 / Z_s)
///
/// with w = k v, pads p = (k_p + i w d_p) / L and all that is below them, Z_s, in the same way: sleepers -w^2 m_s / L (and a
/// slab) on the ballast in series with the ground, smeared over the spacing L. The ground's stiffness per length is
/// 1 / C, uniform pressure across the width B of the footprints and mean displacement over it:
///
///   C(k, w) = 1 / pi int_0^inf G_zz(sqrt(k^2 + k_y^2), w) (sin(k_y B / 2) / (k_y B / 2))^2 dk_y
///
/// The detailed counterpart of find_mode_crossing(): where its maximum over s is largest over v, the load runs at the
/// critical speed. Material damping of the ground: the site's ratio at all frequencies. Limits: as
/// compute_free_track_wave(); the foundation of the data sheet does not enter.
/// @param speed  [m/s], > 0
/// @param s      [m]
/// @throws ModelError on impossible data
Eigen::VectorXd compute_moving_load_response(const track::TrackData& data, const soil::Site& site,
                                             double speed, const Eigen::VectorXd& s);

}  // namespace easydyn::track_on_soil

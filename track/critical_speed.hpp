#pragma once

#include <optional>
#include <string>

#include "track/track_data.hpp"

namespace easydyn::track {

/// Where a load that moves along the track meets a wave that keeps up with it.
struct CriticalSpeed {
  double speed;       ///< phase speed w / k [m/s]
  double wavenumber;  ///< k there [rad/m]
  double frequency;   ///< w / 2 pi there [Hz]
  bool is_wave;       ///< a minimum of the dispersion; else the estimate
};

/// Smallest minimum of the phase speed of the lowest wave of the infinite track on its foundation, without damping,
/// inside 0 < k < pi / spacing: there the group speed is the phase speed, so that energy stays with the load. The lowest
/// w(k) is that of one bay in finite elements (at least four) with the phase k spacing between its ends. A beam of
/// stiffness EI and mass m on a bedding k_w per length has (4 k_w EI / m^2)^(1/4) at k = (k_w / EI)^(1/4).
///
/// Heavy sleepers, ballast or foundations on springs of their own slow the short waves down, towards k = pi / spacing,
/// while the rail hardly moves: the phase speed then falls all the way and has no minimum (all bundled tracks), and
/// damping ends these waves at once. The formula above is then the estimate, with the springs in series and all
/// masses moving as the rail does: on the safe side, as masses that lag behind let the rail's own waves run faster.
///
/// It says nothing of waves in the soil that the foundation stands for: a train meets those at the Rayleigh speed of
/// the upper layer, often lower.
/// @throws ModelError on impossible data
CriticalSpeed compute_critical_speed(const TrackData& data);

/// A warning if the speed exceeds a fraction of the critical speed of the track: the deflection of a beam on a bedding
/// grows as 1 / sqrt(1 - (v / v_cr)^2), by 40 % at 0.7.
/// @param speed  of the train, either way [m/s]
std::optional<std::string> warn_of_critical_speed(const TrackData& data, double speed, double fraction = 0.7);

}  // namespace easydyn::track

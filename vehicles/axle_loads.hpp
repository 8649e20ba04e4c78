#pragma once

#include <string>
#include <vector>

#include "vehicles/rail_vehicle.hpp"

namespace easydyn::vehicles {

/// Static forces in one wheel pair, compression positive [N].
struct WheelPairLoad {
  std::string name;      ///< of the wheel pair
  double x = 0;          ///< [m]
  double primary = 0;    ///< preload of the primary suspension
  double resilient = 0;  ///< preload between tyre and hub; 0 without resilient wheels
  double axle_load = 0;  ///< on the rails, all contacts of the pair together
};

/// Static forces in a vehicle at rest on a level rigid track.
struct AxleLoads {
  std::vector<std::vector<double>> secondary;  ///< [gear][secondary suspension], compression positive [N]
  std::vector<std::vector<WheelPairLoad>> wheel_pairs;  ///< [gear][wheel pair]
  std::vector<double> hinge;  ///< force of each hinge on its front body, positive up [N]

  double gear_load(int gear) const;  ///< sum of its axle loads [N]
  double total() const;              ///< of all axle loads [N]
};

/// Statics of bodies, frames, hubs and springs with the tyres held at z = 0:
///
///   [ K  B^T ] [ q ]   [ -weights ]
///   [ B   0  ] [ f ] = [    0     ]       q: heave (up) and pitch of bodies and frames, heave of hubs
///
/// B: hinges (equal heights), f: hinge forces. The springs start unstressed in the nominal geometry, so that
/// their stiffness decides how a statically indeterminate vehicle shares its weight; the forces found are the
/// preloads with which the nominal geometry becomes the loaded state. A height at x moves by z - theta (x -
/// x_G): pitch theta about y is nose down. Linear: small sag and pitch.
/// @throws ModelError on impossible data, or if a motion without stiffness leaves no static equilibrium
AxleLoads compute_axle_loads(const RailVehicle& vehicle);

}  // namespace easydyn::vehicles

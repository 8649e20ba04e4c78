#pragma once

#include "vehicles/rail_vehicle.hpp"

namespace easydyn::vehicles {

/// A low-floor tram of three articulated bodies, representative of the Brussels T2000 (not its maker's data).
///
///      rear body            centre body           front body
///   [=============]o[=======================]o[=============]         o hinges at -2.4 and +2.4 m
///     O   o                  O     O                 o   O            O driven, o trailing wheel pairs
///   -8.71 -7.01            -0.85  0.85             7.01  8.71   ----> x forward
///
/// Each running gear carries its body on two secondary points 0.5 m either side of its pivot: with a single
/// one the articulated tram would have a motion without stiffness, and no static equilibrium. Total mass 36.5
/// t, between tare and full load.
RailVehicle t2000_like();

}  // namespace easydyn::vehicles

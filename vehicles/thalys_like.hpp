#pragma once

#include "vehicles/rail_vehicle.hpp"

namespace easydyn::vehicles {

/// An articulated high-speed train of 10 cars, representative of the Thalys (not its maker's data): composition of
/// Degrande & Schillemans (2001), suspensions of the Eurostar set of the same family.
///
///    car 10     car 9                 cars 8 ... 3                  car 2      car 1
///   [======] [=======]|[======]|[======]| ... |[======]|[======]|[=======] [======]     --> x forward
///    oo  oo   oo      oo       oo       oo   oo       oo       oo      oo   oo  oo
///   bogies 13 ...                                                           ... 1       7 Jacobs bogies under |
///
/// 200.18 m, 13 bogies 1-13 and 26 axles 1-26 from the front, 427 t; the origin is the middle of the train. Two
/// neighbouring bodies rest on one Jacobs bogie, each on half of its secondary suspension, without a hinge. Both halves
/// act at the bogie's centre, where the bodies' spacing of 18.70 m ends: half shares d to either side would pitch the
/// first Jacobs bogie, which carries unequal bodies (11 023 and 13 523 kg), and its axle loads would part by
/// 2 g 2500 kg d / 3.00 m and more. Every body has its pitch stiffness from its two ends.
///
/// Static axle loads: traction cars 17 t, end carriages' own bogies 14.5 t, first Jacobs bogies 15.75 t, others 17 t.
///
/// Left as its source has it: the pitch inertia of the traction cars, half of m L^2 / 12, by which they
/// pitch at 2.17 Hz.
///
/// Source: G. Degrande, L. Schillemans, Free field vibrations during the passage of a Thalys high-speed train at
/// variable speed, J. Sound Vib. 247(1), 2001, doi:10.1006/jsvi.2001.3718.
RailVehicle thalys_like();

}  // namespace easydyn::vehicles

#pragma once

#include <string>

#include "vehicles/rail_vehicle.hpp"

namespace easydyn::vehicles {

/// Data sheet of a car on two equal bogies with two axles each, symmetric front to rear.
///
///   [================ body ================]
///        >                          >           secondary suspension, per bogie
///     [=====]                    [=====]        bogie frames
///      >   >                      >   >         primary suspension, per axle
///     (4) (3)                    (2) (1)        axles, solid wheels        --> x forward
///      |w |
///        |<------ bogie spacing ----->|
struct TwoBogieCar {
  std::string name;
  Sourced length;  ///< over couplers [m], > 0
  Sourced body_mass;
  Sourced body_pitch_inertia;  ///< [kg m2], > 0
  Sourced bogie_spacing;       ///< [m], > 0
  Sourced bogie_mass;          ///< frame without axles [kg], > 0
  Sourced bogie_pitch_inertia;
  Sourced wheelbase;            ///< of a bogie [m], > 0
  Sourced axle_mass;            ///< with all that is unsprung [kg], > 0
  Sourced wheel_radius;         ///< [m], > 0
  Sourced primary_stiffness;    ///< per axle [N/m], > 0
  Sourced primary_damping;      ///< per axle [N s/m], >= 0
  Sourced secondary_stiffness;  ///< per bogie [N/m], > 0
  Sourced secondary_damping;    ///< per bogie [N s/m], >= 0
  bool has_rubber_primary = false;
};

/// The car as a vehicle: "body", "front bogie", "rear bogie", "axle 1" to "axle 4" from the front; its origin is its
/// middle. @throws ModelError on impossible data
RailVehicle two_bogie_car(const TwoBogieCar& data);

}  // namespace easydyn::vehicles

#pragma once

#include <complex>
#include <string>
#include <vector>

#include "vehicles/rail_vehicle.hpp"

namespace easydyn::vehicles {

/// Modes of one frequency and damping, of a vehicle whose wheels are held at z = 0.
struct VehicleMode {
  std::complex<double> pole;  ///< [1/s]
  double frequency;           ///< natural frequency |pole| / (2 pi) [Hz]
  double damping;             ///< ratio -Re(pole) / |pole|
  int count;                  ///< how many have it: equal cars that know nothing of each other
  std::string motion;         ///< what moves most, e.g. "car 3 body, bounce"

  enum class Part { body, frame, wheel_pair };
  Part part;            ///< of what moves most
  int index;            ///< of that body or frame in the data sheet; of a wheel pair, of its gear
  bool is_pitch;        ///< else bounce
  double energy_share;  ///< of what moves most in the kinetic energy, 0 to 1
};

/// Modes on rigid rails, sorted by frequency (easydyn/sim/modes.hpp).
///
/// "Moves most" is meant by kinetic energy, m |v_G|^2 + J |w|^2, so that heave and pitch can be compared. Modes whose
/// poles differ by less than 1e-5 are one row; their energies are those of their whole space, whatever shapes the
/// eigenvalue solver chose in it. Parts with at least 0.9 of the largest energy are named together.
/// @throws ModelError on impossible data
std::vector<VehicleMode> compute_vehicle_modes(const RailVehicle& vehicle);

}  // namespace easydyn::vehicles

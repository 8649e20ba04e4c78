#pragma once

#include <Eigen/Core>

namespace easydyn {

/// Time [s], coordinates, rates and accelerations of a system: first the coordinates of the bodies in the
/// order of their declaration, then those of each linear structure.
struct State {
  double t = 0;
  Eigen::VectorXd q, qd, qdd;
};

/// Energies [J] and powers [W] at a state. Along a motion
///   d/dt (kinetic + potential) = supplied - dissipated.
struct EnergyBalance {
  double kinetic = 0, potential = 0;
  double dissipated = 0;  ///< power turned into heat [W]
  double supplied = 0;    ///< power of imposed motions and external forces [W]
};

}  // namespace easydyn

#pragma once

#include <Eigen/Core>
#include <vector>

namespace easydyn {

/// Time [s] and state of a system.
struct State {
  double t = 0;
  /// Coordinates, rates and accelerations: first the free coordinates of the bodies in the order of their
  /// declaration, then those of each linear structure.
  Eigen::VectorXd q, qd, qdd;
  Eigen::VectorXd x, xd;                ///< first-order states and their rates
  Eigen::VectorXd lambda;               ///< forces of the velocity constraints
  std::vector<Eigen::Matrix3d> charts;  ///< reference orientations of free motions (free_motion.hpp)
  /// Unknowns of each closed loop near this state, and the sign of its branch (0: not yet known): where its solution
  /// starts (loop.hpp).
  Eigen::VectorXd loops;
  /// Memory of HHT and generalised-alpha: pseudo accelerations of q and rates of x; empty: those of the state.
  Eigen::VectorXd a, w;
};

/// Energies [J] and powers [W] at a state. Along a motion
///   d/dt (kinetic + potential) = supplied - dissipated.
struct EnergyBalance {
  double kinetic = 0, potential = 0;
  double dissipated = 0;  ///< power turned into heat [W]
  double supplied = 0;    ///< power of imposed motions and external forces [W]
};

}  // namespace easydyn

#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "easydyn/sim/linearization.hpp"

namespace easydyn {

struct StateSpace;

/// One mode x(t) = Re(shape exp(pole t)) of small motions.
struct Mode {
  std::complex<double> pole;  ///< [1/s]
  double frequency;           ///< natural frequency |pole| / (2 pi) [Hz]
  double damping;             ///< ratio -Re(pole) / |pole|; 0 for a pole at zero
  /// n coordinates, largest entry 1. Zero for a mode in which only first-order states move.
  Eigen::VectorXcd shape;
};

/// Modes of M x.. + C x. + K x = 0, sorted by frequency: one per pair of complex poles, and one per real
/// pole.
///
/// From the eigenvalues of the state matrix [0 I; -M^-1 K, -M^-1 C]; without damping (C = 0) and with
/// symmetric K from the symmetric generalised problem, to machine precision.
/// @throws SolverError if M is singular or the eigenvalue solver fails
std::vector<Mode> compute_modes(const Linearization& linearization);

/// Modes of y. = A y, with first-order states, controllers and velocity constraints, in the same order. Constraints
/// leave poles at zero.
/// @throws SolverError if the eigenvalue solver fails
std::vector<Mode> compute_modes(const StateSpace& space);

}  // namespace easydyn

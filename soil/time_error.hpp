#pragma once

#include <Eigen/Core>

namespace easydyn::soil {

// The time error of the leapfrog, taken away. With u ~ e^(i w t) the leapfrog's (u+ - 2 u + u-) / dt^2 is -W^2 u,
//
//   W = (2 / dt) sin(w dt / 2):
//
// what it does at w is what an exact integration does at W < w: its waves are too fast. A motion X(W) under forces F(W) is
// therefore computed without this error by giving the leapfrog the forces F'(w) = F(W), and by reading X(W) from its record
// X'(w) = X(W).
// (M. Wang, S. Xu, Finite-difference time dispersion transforms for wave propagation, Geophysics 80, 2015; E. Koene,
// J. Robertsson, F. Broggini, F. Andersson, Eliminating time dispersion from seismic wave modeling, Geophys. J. Int. 213,
// 2018.) Exact for elastic ground; dampers keep their time error, a part (w dt)^2 / 8 of the damping.
//
// Both functions add to the signals their correction up to 1.25 x `highest_frequency`, which falls to nothing at 1.6 times
// it (or at what the steps resolve, if that is less), by Fourier integrals over the record without a smooth line through its
// ends. Beyond its ends a record is not known: in the last two periods of the highest frequency some error remains if it still
// moves there. The cost grows as the square of the length of the record.

/// Forces as the leapfrog must be given them.
/// @param signals  one column per signal, the first row at time 0, where the origin of remove_time_error() is
/// @param step     of the signals [s]
/// @param dt       of the leapfrog [s]
/// @throws ModelError if a step or the frequency is not positive, or there are less than two rows
Eigen::MatrixXd add_time_error(const Eigen::Ref<const Eigen::MatrixXd>& signals, double step, double dt,
                               double highest_frequency);

/// What is recorded from a leapfrog.
enum class LeapfrogRecord {
  displacement,
  velocity  ///< means of the half steps before and after: cos(w dt / 2) times too small
};

/// The motion, from the record of a leapfrog under the forces of add_time_error().
/// @param start  time of the first row after the first row of the forces [s]
Eigen::MatrixXd remove_time_error(const Eigen::Ref<const Eigen::MatrixXd>& records, double start, double step,
                                  double dt, double highest_frequency, LeapfrogRecord kind);

}  // namespace easydyn::soil

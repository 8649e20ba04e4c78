#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "track/foundation.hpp"

namespace easydyn::track {

/// What the ground answers to a unit harmonic force, uniform over the footprint of one sleeper: the mean displacement of
/// that footprint and of those beside it. From the soil program, a measurement, any model of the ground.
struct GroundCompliance {
  Eigen::VectorXd frequency;  ///< nf [Hz], ascending, > 0
  Eigen::MatrixXcd
      H;  ///< nf x (n + 1): H(i, n) = H_0n of the footprint n spacings away [m/N], time factor exp(i w t)
  double spacing = 0;  ///< of the sleepers [m]
  std::string source;  ///< e.g. "site hst.toml, layered half-space"
};

struct ClmFitOptions {
  double lowest = 2, highest = 50;  ///< band of the fit [Hz]
  /// Foundations of the chain: 0: infinitely many; else N >= 2 with free ends, whose own and neighbours' compliances
  /// (i, i), (i, i + 1) are all fitted.
  int foundations = 0;
  Eigen::VectorXd weight = {};  ///< nf, >= 0: what errors at each frequency count; empty: all alike
};

/// A coupled lumped mass model that follows a ground, and how well.
struct ClmFit {
  Clm clm;                                                    ///< its sources tell band, system and residual
  Eigen::VectorXd frequency;                                  ///< those within the band [Hz]
  Eigen::VectorXcd ground_00, ground_01, model_00, model_01;  ///< [m/N]; of N foundations: of the middle one
  double rms_00 = 0,
         rms_01 = 0;  ///< root mean square of |model - ground| over the band / |H_00| at its lowest frequency
  double stiffness_margin = 0;      ///< (k_f + 4 k_c) / k_f, >= 0 by passivity
  double damping_margin = 0;        ///< (d_f + 4 d_c) / d_f, >= 0 by passivity; 0: the fit lies on that bound
  std::vector<std::string> bounds;  ///< on which the fit lies, e.g. "m_f = 0"
  /// Of N foundations: largest share |S - tridiagonal part of S| / |S| (Frobenius) over the band of the ground's stiffness
  /// matrix S: couplings to farther sleepers, which no chain has. 0 for the infinite chain.
  double left_out = 0;
  std::string system;  ///< "infinite chain", or "chain of 9"
};

/// The five constants whose chain is closest to the ground:
///
///   min  sum_i w_i ( |H_00 - G_00|^2 + |H_01 - G_01|^2 )      G: ground
///
/// subject to passivity and m_f >= 0. In A = K_f = a + i w c - w^2 m and B = K_f + 4 K_c = b + i w e - w^2 m, the stiffnesses
/// of the chain with all foundations in phase and in opposition, the infinite chain is
///
///   H_00 = 1 / (sqrt(A) sqrt(B)),   H_01 = H_00 (sqrt(B) - sqrt(A)) / (sqrt(B) + sqrt(A))
///
/// and a chain of N with free ends is H = sum_k phi_k phi_k^T / (A cos^2(t_k / 2) + B sin^2(t_k / 2)), t_k = k pi / N. The
/// constraints are then a, b, c, e, m >= 0: bounds, solved by Levenberg and Marquardt's method on the free variables, from
/// several starts. (Fitting the inverted stiffnesses instead gives negative masses.)
/// @throws ModelError if data or options are out of range, SolverError if no start converges
ClmFit calibrate_clm(const GroundCompliance& ground, const ClmFitOptions& options = {});

}  // namespace easydyn::track

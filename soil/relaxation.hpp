#pragma once

#include <Eigen/Core>
#include <complex>

namespace easydyn::soil {

/// Generalised Maxwell body whose damping ratio is nearly constant over a band, with relaxation rates common
/// to all layers so that the memory variables can be nodal displacements:
///
///   force = K_u (u - sum_l y_l zeta_l),   zeta_l. + omega_l zeta_l = omega_l u
///   modulus(omega) = M_u (1 - sum_l y_l omega_l / (omega_l + i omega)),   damping ratio = Im / (2 Re)
///
/// The unrelaxed modulus M_u is such that Re(modulus) is the given one at the reference frequency; below it
/// the ground is softer, above it stiffer (speeds by about 2 xi / pi per factor e in frequency, moduli by twice that), as causality demands.
/// Reference: H. Emmerich, M. Korn, Geophysics 52(9), 1987 (recalled, not re-read).
struct Relaxation {
  Eigen::VectorXd rates;    ///< omega_l [rad/s]
  Eigen::VectorXd weights;  ///< y_l
  double unrelaxed = 1;     ///< M_u / modulus at the reference frequency

  double compute_damping_ratio(double frequency) const;  ///< at `frequency` [Hz]
  /// modulus / modulus given at the reference frequency, at a circular frequency with Im omega <= 0.
  std::complex<double> compute_modulus(std::complex<double> omega) const;
};

/// Least-squares fit of `mechanisms` rates, evenly spaced on a logarithmic scale, over `lowest`..`highest`
/// [Hz].
/// @param ratio      damping ratio, 0 <= ratio < 0.2
/// @param reference  frequency at which the modulus is given [Hz]; the ratio holds exactly there
Relaxation fit_relaxation(double ratio, double lowest, double highest, double reference, int mechanisms);

/// The frequencies [Hz] over which the body of a model holds its damping ratio, lowest and highest.
struct DampingBand {
  double lowest, highest;
};
/// From a fortieth of the highest frequency that a model claims (2 Hz for 80 Hz) to it. Where the reference lies beyond,
/// it is part of the band, which then begins at a fortieth of it, and at a tenth of the model's highest at the latest.
DampingBand choose_damping_band(double highest_frequency, double reference);

/// The body that stands for a constant damping ratio over choose_damping_band(): three mechanisms, which hold 1 to 5 %
/// within a twenty-fifth of it over a factor of 40, and within a fifteenth where the reference is at an end.
Relaxation fit_relaxation_of_band(double ratio, double highest_frequency, double reference);

}  // namespace easydyn::soil

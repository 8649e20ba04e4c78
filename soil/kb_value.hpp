#pragma once

#include <Eigen/Core>
#include <complex>

namespace easydyn::soil {

/// Frequency response of the KB filter of DIN 45669-1:
///
///   H(f) = 1 / (1 + f_0 / (i f))  x  Butterworth high-pass 0.8 Hz  x  Butterworth low-pass 100 Hz (second
///   order)
///
/// f_0 = 5.6 Hz, so that |first factor| = 1 / sqrt(1 + (5.6 Hz / f)^2); the other two limit the band to 1-80
/// Hz. (The band limits are recalled, to be checked against the standard.)
std::complex<double> kb_filter_response(double f);

/// Running rms value with an exponential window, the input linear between samples:
///
///   y(t)^2 = 1 / tau integral_0^t exp(-(t - s) / tau) x(s)^2 ds
///
/// @param step [s], > 0; @param tau [s], > 0 (0.125 s: "fast")
Eigen::VectorXd compute_running_rms(const Eigen::Ref<const Eigen::VectorXd>& x, double step, double tau);

/// KB_F(t), dimensionless (velocity in mm/s, filtered, running rms with 0.125 s), of a velocity [m/s] that is
/// at rest before the record. Band-limited: holds no more than the velocity does.
Eigen::VectorXd compute_kb_f(const Eigen::Ref<const Eigen::VectorXd>& velocity, double step);

}  // namespace easydyn::soil

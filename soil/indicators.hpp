#pragma once

#include <Eigen/Core>
#include <array>

namespace easydyn::soil {

/// What is said about the vibration of one receiver. Every number is **band-limited**: loads are
/// passed unchanged up to Site::highest_frequency and rolled off to zero at 1.25 times it (limit_band()); what
/// lies above is not in the numbers.
struct Indicators {
  std::array<double, 4> ppv{};       ///< [m/s] peak particle velocity of x, y, z and of the resultant
  Eigen::VectorXd third_octave_rms;  ///< [m/s] of v_z per band of third_octave_centres(); NaN: not known
  double kb_f_max = 0;               ///< largest KB_F of v_z (DIN 45669-1)
  double vdb = 0;                    ///< [dB] re 1e-6 in/s, see compute_vdb(); NaN if there is no motion
};

/// Largest absolute value of a signal; the peak between samples by a parabola through the largest sample and
/// its neighbours (samples alone miss up to 5 % at ten samples per period, the parabola 0.4 %).
double compute_peak(const Eigen::Ref<const Eigen::VectorXd>& signal);

/// Largest length of the vector (x, y, z), between samples as in compute_peak().
double compute_resultant_peak(const Eigen::Ref<const Eigen::VectorXd>& x,
                              const Eigen::Ref<const Eigen::VectorXd>& y,
                              const Eigen::Ref<const Eigen::VectorXd>& z);

/// Vibration velocity level of the FTA: L_v = 20 log10(v_rms / 1e-6 in/s) with the largest rms value in a
/// sliding window of 1 s (a record shorter than that is at rest in the remainder).
/// @return [dB]; NaN if the signal is zero
double compute_vdb(const Eigen::Ref<const Eigen::VectorXd>& velocity, double step);

/// All indicators of one receiver.
/// @param vx, vy, vz         velocity [m/s], at rest before the record, under loads limited by limit_band()
/// @param step               [s], > 0
/// @param highest_frequency  [Hz]
Indicators compute_indicators(const Eigen::Ref<const Eigen::VectorXd>& vx,
                              const Eigen::Ref<const Eigen::VectorXd>& vy,
                              const Eigen::Ref<const Eigen::VectorXd>& vz, double step,
                              double highest_frequency);

}  // namespace easydyn::soil

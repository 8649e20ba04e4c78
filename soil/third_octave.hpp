#pragma once

#include <Eigen/Core>

namespace easydyn::soil {

/// Exact centres 1000 Hz 10^(n / 10), n = -30 ... -10, of the one-third octave bands from 1 to 100 Hz (base
/// ten, IEC 61260-1; recalled, to be checked against the standard). Band edges are centre x 10^(+-1/20).
Eigen::VectorXd third_octave_centres();

/// Rms value of a signal in each of these bands, over the whole record.
///
///   rms_b^2 = 1/T integral over band b of S(f) df,  S(f) = 2 |X(f_k)|^2 for |f - f_k| < 1/(2 T)
///
/// Ideal band filters by the discrete Fourier transform: the energy of a spectral line is spread evenly over
/// its width 1/T and shared between the bands in proportion, so that the bands add up to the rms of the
/// signal (Parseval) and a band narrower than 1/T has its part of what the record resolves. Not the filters
/// of the standard, whose skirts let about 1 % of a neighbouring band's energy pass. Band-limited: a band
/// whose upper edge lies above `highest_frequency` (or half the sampling rate) is NaN: not known, which is
/// not zero.
/// @param step of the signal [s], > 0
/// @return one value per centre, in the unit of the signal
Eigen::VectorXd compute_third_octave_rms(const Eigen::Ref<const Eigen::VectorXd>& signal, double step,
                                         double highest_frequency);

}  // namespace easydyn::soil

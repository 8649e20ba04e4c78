#pragma once
// Private to soil: many arguments at once, as the synthesis over wavenumbers needs them.

#include <Eigen/Core>

namespace easydyn::soil {

/// Bessel functions J0(x) and J1(x) of many arguments at once, absolute error below 1e-13 for 0 <= x < 1e5.
///
/// x < 10: Chebyshev series in x^2 of J0 and J1 / x. Beyond: Hankel's form, x_n = x - n pi / 2 - pi / 4,
///
///   Jn(x) = sqrt(2 / (pi x)) (P_n(x) cos x_n - Q_n(x) sin x_n),
///
/// P_n and x Q_n by Chebyshev series in 1 / x^2, cos and sin by Taylor's series after taking off multiples of pi.
/// The coefficients come from the C library's j0, j1, y0, y1 at the first call. Vectorised.
/// Form: M. Abramowitz, I. Stegun, Handbook of Mathematical Functions, 9.2.5 to 9.2.10.
/// @param x  ascending
void update_bessel(const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Ref<Eigen::VectorXd> J0,
                   Eigen::Ref<Eigen::VectorXd> J1);

}  // namespace easydyn::soil

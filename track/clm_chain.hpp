#pragma once

#include <complex>
#include <cstdlib>

#include "track/foundation.hpp"

namespace easydyn::track {

/// Dynamic stiffnesses of a chain of foundations at one angular frequency w:
///   K_f = k_f + i w d_f - w^2 m_f   (foundation to ground),   K_c = k_c + i w d_c   (to each neighbour)
///   [N/m]
struct ChainStiffness {
  std::complex<double> K_f;
  std::complex<double> K_c;
};

/// Response of the infinite chain to a unit harmonic force on foundation 0: H_0n = H_00 L^|n|.
struct ChainCompliance {
  std::complex<double> H_00;  ///< displacement of the loaded foundation [m/N]
  std::complex<double> L;     ///< ratio of the displacements of successive foundations, |L| < 1

  std::complex<double> H_0n(int n) const { return H_00 * std::pow(L, std::abs(n)); }
};

ChainStiffness chain_stiffness(const Clm& clm, double omega);

/// L + 1/L = 2 + K_f / K_c, root of modulus < 1 (the principal square root takes the wrong branch above some
/// tens of Hz); H_00 = L / (K_c (1 - L^2)); K_c = 0: H_00 = 1 / K_f, L = 0.
/// @throws ModelError if both roots have modulus 1 (an undamped chain in its pass band: no steady response)
ChainCompliance compute_infinite_chain(const ChainStiffness& stiffness);

/// Inverse of the above from two compliances of the soil, H_00 (loaded foundation) and H_01 (its neighbour):
///   L = H_01 / H_00,  K_c = L / (H_00 (1 - L^2)),  K_f = (1 - L) / (H_00 (1 + L)).
/// @throws ModelError unless |H_01| < |H_00|
ChainStiffness invert_infinite_chain(std::complex<double> H_00, std::complex<double> H_01);

/// As if there were two foundations only: K_f = 1 / (H_11 + H_12), K_c = (1 / (H_11 - H_12) - K_f) / 2.
/// Its result does not reproduce H_11 in a long chain.
ChainStiffness invert_two_foundations(std::complex<double> H_11, std::complex<double> H_12);

/// Static displacement of the loaded foundation per unit force, u_0 = 1 / sqrt(k_f^2 + 4 k_f k_c) [m/N].
/// The displacements of all foundations add up to 1 / k_f.
double static_chain_compliance(const Clm& clm);

}  // namespace easydyn::track

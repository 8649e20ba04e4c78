#include "track/clm_chain.hpp"

#include <cmath>

#include "easydyn/require.hpp"

namespace easydyn::track {

ChainStiffness chain_stiffness(const Clm& clm, double omega) {
  return {{clm.k_f - omega * omega * clm.m_f, omega * clm.d_f}, {clm.k_c, omega * clm.d_c}};
}

ChainCompliance compute_infinite_chain(const ChainStiffness& stiffness) {
  const auto& [K_f, K_c] = stiffness;
  if (K_c == 0.0) return {1.0 / K_f, 0.0};
  // 1/L and L are 1 + s +- root; the one of larger modulus loses no digit
  const std::complex<double> s = 0.5 * K_f / K_c;
  std::complex<double> root = std::sqrt(s * (s + 2.0));
  if (std::abs(1.0 + s + root) < std::abs(1.0 + s - root)) root = -root;
  const std::complex<double> larger = 1.0 + s + root;
  if (!(std::abs(larger) > 1 + 1e-14))
    throw ModelError(
        fmt::format("CLM chain: |L| = {:.15g}, must be < 1: without damping the chain carries waves "
                    "away without decay and has no steady response",
                    1 / std::abs(larger)));
  // K_c (1/L - L) = 2 K_c root
  return {0.5 / (K_c * root), 1.0 / larger};
}

ChainStiffness invert_infinite_chain(std::complex<double> H_00, std::complex<double> H_01) {
  const std::complex<double> L = H_01 / H_00;
  require(std::abs(L) < 1, "CLM chain", "|H_01 / H_00|", std::abs(L), "", "< 1");
  return {(1.0 - L) / (H_00 * (1.0 + L)), L / (H_00 * (1.0 - L * L))};
}

ChainStiffness invert_two_foundations(std::complex<double> H_11, std::complex<double> H_12) {
  const std::complex<double> K_f = 1.0 / (H_11 + H_12);
  return {K_f, 0.5 * (1.0 / (H_11 - H_12) - K_f)};
}

double static_chain_compliance(const Clm& clm) {
  validate(Foundation(clm), "CLM chain");
  return 1 / std::sqrt(clm.k_f * clm.k_f + 4 * clm.k_f * clm.k_c);
}

}  // namespace easydyn::track

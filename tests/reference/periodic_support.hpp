#pragma once

#include <cmath>
#include <complex>
#include <vector>

/// Infinite Euler-Bernoulli rail on equal discrete supports L apart on a coupled lumped mass chain, in the frequency
/// domain: no finite elements, no truncation of the track. Displacements downward, time factor exp(i w t).
///
///   E I w'''' + m w.. = p(x, t) - sum_j R_j(t) delta(x - j L)
///
/// If all quantities at support j are those at support 0 times exp(-i j theta), the free rail under the reactions R_0
/// exp(-i j theta) deflects by S R_0 at support 0,
///
///   S(theta, w) = -1 / (4 E I b^3) [ sinh bL / (cosh bL - cos theta) - sin bL / (cos bL - cos theta) ],  b^4 = m w^2 / E I
///
/// (the sum over j of the Green's functions -(exp(-b |x|) + i exp(-i b |x|)) / (4 E I b^3) of the free beam), and the
/// support gives R = Z w with the springs and masses of pad, sleeper, ballast and the chain
/// K_f + 2 K_c (1 - cos theta) in series.
///
/// - harmonic force 1 at support 0: w_0 = (1 / 2 pi) int_{-pi}^{pi} S / (1 + Z S) d theta;
/// - force P that moves with v: theta = w L / v, and w_0(w) = (P / v) / (D (1 + Z S)), D = E I (w / v)^4 - m w^2.
///
/// Reference: D. J. Mead, Free wave propagation in periodically supported, infinite beams, J. Sound Vib. 11, 1970 (the
/// lattice sum); the moving force as in A. V. Metrikine, K. Popp, Vibration of a periodically supported beam on an
/// elastic half-space, Eur. J. Mech. A/Solids 18, 1999.
namespace easydyn::reference {

struct PeriodicSupport {
  using Complex = std::complex<double>;
  double EI, m, L;
  double k_p, d_p, m_s, k_b, d_b, m_f, k_f, d_f, k_c, d_c;

  Complex free_rail(double theta, double w) const {
    const double b = std::pow(m * w * w / EI, 0.25), c = std::cos(theta);
    return -1 / (4 * EI * b * b * b) *
           (std::sinh(b * L) / (std::cosh(b * L) - c) - std::sin(b * L) / (std::cos(b * L) - c));
  }
  struct Motion {
    Complex rail, sleeper, ballast_reaction;
  };
  /// Sleeper displacement and ballast reaction for a rail deflection 1, and the support's reaction Z.
  Complex support(double theta, double w, Motion* motion = nullptr) const {
    const Complex i(0, 1);
    const Complex K_p = k_p + i * w * d_p, K_b = k_b + i * w * d_b;
    const Complex K_f = k_f + i * w * d_f - w * w * m_f + 2.0 * (k_c + i * w * d_c) * (1 - std::cos(theta));
    const Complex below = K_b * K_f / (K_b + K_f);  // force per unit sleeper displacement
    const Complex under_pad = below - w * w * m_s;
    const Complex u_s = K_p / (K_p + under_pad);
    if (motion) *motion = {1.0, u_s, below * u_s};
    return under_pad * u_s;
  }
  /// Deflection of the rail at support 0 per unit harmonic force there [m/N].
  Complex receptance(double w, int points = 4000) const {
    Complex sum = 0;
    for (int n = 0; n < points; ++n) {
      const double theta = 2 * std::acos(-1.0) * (n + 0.5) / points;
      const Complex S = free_rail(theta, w);
      sum += S / (1.0 + support(theta, w) * S);
    }
    return sum / double(points);
  }
  /// Spectra at support 0 under a force P that passes it at t = 0 with the speed v: integral of f exp(-i w t) dt.
  Motion passing_force(double P, double v, double w) const {
    const double theta = w * L / v, D = EI * std::pow(w / v, 4) - m * w * w;
    Motion motion;
    const Complex Z = support(theta, w, &motion);
    const Complex rail = P / v / (D * (1.0 + Z * free_rail(theta, w)));
    return {rail, motion.sleeper * rail, motion.ballast_reaction * rail};
  }
  struct History {
    std::vector<double> rail, sleeper, ballast_reaction;
  };
  /// Histories at the times t [s], by the sum over w = (n + 1/2) dw up to w_max; the motion must be over within
  /// pi / dw before and after the passage.
  History passing_force(double P, double v, const std::vector<double>& t, double dw, double w_max) const {
    History h;
    for (auto* f : {&h.rail, &h.sleeper, &h.ballast_reaction}) f->assign(t.size(), 0.0);
    for (double w = 0.5 * dw; w < w_max; w += dw) {
      const Motion spectrum = passing_force(P, v, w);
      for (size_t i = 0; i < t.size(); ++i) {
        const Complex wave = std::polar(dw / std::acos(-1.0), w * t[i]);
        h.rail[i] += (spectrum.rail * wave).real();
        h.sleeper[i] += (spectrum.sleeper * wave).real();
        h.ballast_reaction[i] += (spectrum.ballast_reaction * wave).real();
      }
    }
    return h;
  }
};

}  // namespace easydyn::reference

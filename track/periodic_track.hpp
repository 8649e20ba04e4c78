#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "track/track_data.hpp"

namespace easydyn::track {

/// A wave that travels or decays ahead along the track, exp(i (w t - k x)) times a function with the period of the
/// sleepers.
struct TrackWave {
  std::complex<double> propagation;  ///< mu: motion at a sleeper over that at the sleeper before, |mu| < 1
  double decay_rate;                 ///< -20 log10 |mu| / spacing [dB/m]
  double wavenumber;                 ///< k of the strongest harmonic in the rail [rad/m]
};

/// A wave without decay, without damping in the track.
struct PropagatingWave {
  double wavenumber;   ///< k of the strongest harmonic in the rail [rad/m]; < 0 where the phase runs backward
  double phase_speed;  ///< w / k [m/s]
  double group_speed;  ///< dw/dk [m/s], > 0: energy travels ahead
};

/// The infinite track with all bays alike (Floquet). Rail and slab are exact beams between the sleepers, without
/// discretisation; all else as in `TrackModel`.
///
/// The unknowns y that neighbouring bays share, condensed to the sleepers, follow
///
///   D_-(w) y_{j-1} + D_0(w) y_j + D_+(w) y_{j+1} = 0,    y_j = mu^j y_0,    D_- = D_+^T
///
/// a quadratic eigenvalue problem with pairs mu, 1/mu: as many waves ahead as shared unknowns (2 of the rail, 1 of a
/// chain of foundations, 1 of ballast in shear, 2 of a slab). A wavenumber is known up to 2 pi / spacing; the one given
/// is that of the harmonic with the largest deflection of the rail, which is found from the free rail: under point
/// forces one spacing apart, harmonic k_n has the amplitude 1 / D_rail(k_n).
///
/// Reference: D. J. Mead, Wave propagation in continuous periodic structures, J. Sound Vib. 190, 1996,
/// doi:10.1006/jsvi.1996.0076.
class PeriodicTrack {
 public:
  /// The absorbing ends, the number of elements per bay and a variation of supports do not matter here.
  /// @throws ModelError on impossible data
  explicit PeriodicTrack(const TrackData& data);

  /// All waves ahead, with damping, from the least to the most decaying. @param frequency  [Hz], > 0
  std::vector<TrackWave> compute_waves(double frequency) const;
  /// Waves that travel ahead without decay in the track without dampers, by ascending wavenumber.
  /// @param frequency  [Hz], > 0
  std::vector<PropagatingWave> compute_propagating_waves(double frequency) const;
  /// Deflection of the rail above sleeper n per unit harmonic force on the rail above sleeper 0 [m/N], infinite track
  /// with damping. @throws SolverError if no steady response exists
  std::complex<double> compute_rail_receptance(double frequency, int n = 0) const;

 private:
  struct Dynamic {
    Eigen::MatrixXcd D_0, D_plus;
  };
  Dynamic compute_dynamic(double omega, bool damped) const;
  Eigen::VectorXcd compute_propagations(const Dynamic& D, Eigen::MatrixXcd& shapes) const;
  double strongest_harmonic(double omega, std::complex<double> propagation) const;

  TrackData data_;
  double spacing_;
  Eigen::MatrixXd M_0_, C_0_, K_0_, M_plus_, C_plus_, K_plus_;  ///< of one bay, and with the next
  std::vector<int> shared_, inner_;                             ///< unknowns of a bay
  std::vector<int> slopes_;                                     ///< places of rotations among the shared
  int slab_ = -1, rail_ = 0;  ///< unknowns of a bay: deflections of the beams
};

/// Exact dynamic stiffness of a beam element without damping, (w_1, phi_1, w_2, phi_2) as in BeamElement.
/// @param omega  [rad/s], > 0
Eigen::Matrix4d compute_beam_dynamic_stiffness(const BeamProperties& beam, double length, double omega);

/// First frequency at which the rail vibrates between the sleepers as if it were pinned on them [Hz]: the rail with
/// nodes at the sleepers, pi / (2 L^2) sqrt(EI / m) by Euler and Bernoulli.
double pinned_pinned_frequency(const TrackData& data);

}  // namespace easydyn::track

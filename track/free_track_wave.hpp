#pragma once

#include <Eigen/Core>

#include "track/track_data.hpp"

namespace easydyn::track {

/// Bending wave of a track that rests on nothing, by wavenumber.
struct FreeTrackWave {
  Eigen::VectorXd wavenumber;   ///< k [rad/m], ascending
  Eigen::VectorXd frequency;    ///< w / 2 pi [Hz], ascending
  Eigen::VectorXd phase_speed;  ///< w / k [m/s]
};

/// Lowest wave w(k) of rail, pads, sleepers or slab, ballast and its mass, all smeared over the spacing L, with nothing
/// below and without damping:
///
///   det(K(k) - w^2 M) = 0,   M = diag(m_r, m_s / L, m_b / L)
///
///       | EI k^4 + p    -p               0               |    p = k_p / L
///   K = | -p            p + b            -b              |    b = 1 / (L (1 / k_b + 1 / k_u))
///       | 0             -b               b + k_w L k^2   |
///
/// Ballast without mass bears nothing where nothing is below, so that two unknowns are left. A slab adds its EI k^4 and
/// mass to the second row. Long waves follow w = k^2 sqrt(EI / m) with all masses in m, ever slower as they get longer.
/// Where this wave is as fast as the Rayleigh wave of the ground below, neither hinders the other, and a load that moves
/// at that speed stays with the energy of both (soil::find_crossing). Reference for the idea: P. Alves Costa, A. Colaco,
/// R. Calcada, A. Silva Cardoso, Critical speed of railway tracks: detailed and simplified approaches, Transportation
/// Geotechnics 2, 2015, doi:10.1016/j.trgeo.2014.09.003.
///
/// Limits: waves much longer than the spacing; the rail by Euler and Bernoulli; the foundation of the data sheet, which
/// stands for the ground, does not enter; mass of ballast and embankment counts only as far as the data sheet gives it.
/// @param samples  wavenumbers, evenly in their logarithm from a wave of 100 m to one of two spacings, >= 2
/// @throws ModelError on impossible data
FreeTrackWave compute_free_track_wave(const TrackData& data, int samples = 400);

}  // namespace easydyn::track

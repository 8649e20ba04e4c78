#include "track/free_track_wave.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

#include "easydyn/math/units.hpp"
#include "easydyn/require.hpp"

namespace easydyn::track {

FreeTrackWave compute_free_track_wave(const TrackData& data, int samples) {
  using units::pi;
  validate(data);
  require(samples >= 2, data.label(), "samples of the free wave", samples, "", ">= 2");
  const BeamProperties rail = rail_beam(data);
  const double L = data.sleeper_spacing, pads = data.pad_stiffness / L;
  double ballast = 1 / data.ballast_stiffness;
  if (data.under_sleeper_pads) ballast += 1 / data.under_sleeper_pads->stiffness;
  ballast = 1 / (L * ballast);

  const Eigen::Index n = data.ballast_mass ? 3 : 2;
  Eigen::VectorXd mass(n);
  mass[0] = rail.mass_per_length;
  mass[1] = data.sleeper_mass / L + (data.slab ? data.slab->mass_per_length.value : 0);
  if (data.ballast_mass) mass[2] = data.ballast_mass->mass / L;

  const Eigen::VectorXd root_mass = mass.cwiseSqrt();

  FreeTrackWave wave;
  wave.wavenumber =
      Eigen::VectorXd::LinSpaced(samples, std::log(2 * pi / 100), std::log(pi / L)).array().exp();
  wave.frequency.resize(samples);
  for (Eigen::Index i = 0; i < samples; ++i) {
    const double k2 = wave.wavenumber[i] * wave.wavenumber[i];
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
    K(0, 0) = rail.bending_stiffness * k2 * k2 + pads;
    K(0, 1) = K(1, 0) = -pads;
    K(1, 1) = pads + (data.slab ? data.slab->bending_stiffness * k2 * k2 : 0);
    if (data.ballast_mass) {
      K(1, 1) += ballast;
      K(1, 2) = K(2, 1) = -ballast;
      K(2, 2) = ballast + data.ballast_mass->shear_stiffness * L * k2;
    }
    // The lowest w^2 is far below the others for long waves: as the largest eigenvalue of the inverse.
    const Eigen::MatrixXd compliance = root_mass.asDiagonal() * K.inverse() * root_mass.asDiagonal();
    const double w =
        1 / std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(compliance, Eigen::EigenvaluesOnly)
                          .eigenvalues()
                          .maxCoeff());
    wave.frequency[i] = w / (2 * pi);
  }
  wave.phase_speed = 2 * pi * wave.frequency.cwiseQuotient(wave.wavenumber);
  return wave;
}

}  // namespace easydyn::track

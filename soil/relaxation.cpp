#include "soil/relaxation.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <complex>

namespace easydyn::soil {

namespace {

/// modulus / M_u at omega.
std::complex<double> relative_modulus(const Relaxation& body, std::complex<double> omega) {
  std::complex<double> modulus = 1;
  for (int l = 0; l < body.rates.size(); ++l)
    modulus -= body.weights(l) * body.rates(l) / (body.rates(l) + std::complex<double>(0, 1) * omega);
  return modulus;
}

}  // namespace

double Relaxation::compute_damping_ratio(double frequency) const {
  const std::complex<double> modulus = relative_modulus(*this, 2 * M_PI * frequency);
  return modulus.imag() / (2 * modulus.real());
}

std::complex<double> Relaxation::compute_modulus(std::complex<double> omega) const {
  return unrelaxed * relative_modulus(*this, omega);
}

Relaxation fit_relaxation(double ratio, double lowest, double highest, double reference, int mechanisms) {
  Relaxation body;
  body.rates.resize(mechanisms);
  body.weights = Eigen::VectorXd::Zero(mechanisms);
  for (int l = 0; l < mechanisms; ++l) {
    const double place = mechanisms == 1 ? 0.5 : double(l) / (mechanisms - 1);
    body.rates(l) = 2 * M_PI * lowest * std::pow(highest / lowest, place);
  }
  if (ratio == 0 || mechanisms == 0) return body;

  // Im = 2 xi Re is linear in the weights: y_l omega_l (omega + 2 xi omega_l) / (omega_l^2 + omega^2) = 2 xi.
  const int samples = 60;
  Eigen::MatrixXd A(samples, mechanisms);
  for (int s = 0; s < samples; ++s) {
    const double omega = 2 * M_PI * lowest * std::pow(highest / lowest, double(s) / (samples - 1));
    for (int l = 0; l < mechanisms; ++l) {
      const double rate = body.rates(l);
      A(s, l) = rate * (omega + 2 * ratio * rate) / (rate * rate + omega * omega);
    }
  }
  body.weights = A.colPivHouseholderQr().solve(Eigen::VectorXd::Constant(samples, 2 * ratio));
  // Scale so that the ratio holds at the reference (a second pass absorbs the change of Re).
  for (int pass = 0; pass < 10; ++pass) body.weights *= ratio / body.compute_damping_ratio(reference);
  body.unrelaxed = 1 / relative_modulus(body, 2 * M_PI * reference).real();
  return body;
}

DampingBand choose_damping_band(double highest_frequency, double reference) {
  const double highest = std::max(highest_frequency, reference);
  return {std::min({highest / 40, highest_frequency / 10, reference}), highest};
}

Relaxation fit_relaxation_of_band(double ratio, double highest_frequency, double reference) {
  const DampingBand band = choose_damping_band(highest_frequency, reference);
  return fit_relaxation(ratio, band.lowest, band.highest, reference, 3);
}

}  // namespace easydyn::soil

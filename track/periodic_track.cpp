#include "track/periodic_track.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "easydyn/math/units.hpp"
#include "easydyn/require.hpp"
#include "track/track_model.hpp"

namespace easydyn::track {

namespace {

using Complex = std::complex<double>;
using namespace std::complex_literals;
using units::pi;

// Force per unit deflection of the infinite beam in the wave exp(i (w t - k x)) [N/m2].
double wave_stiffness(const BeamProperties& beam, double k, double omega) {
  const double EI = beam.bending_stiffness, w2 = omega * omega;
  if (beam.is_shear_stiff())
    return EI * std::pow(k, 4) - (beam.rotary_inertia * k * k + beam.mass_per_length) * w2;
  const double S = beam.shear_stiffness;
  return S * k * k - beam.mass_per_length * w2 - S * S * k * k / (EI * k * k + S - beam.rotary_inertia * w2);
}

TrackData one_bay(TrackData data) {
  data.elements_per_bay = 1;
  data.ends.bays = 0;
  data.variation = {};
  return data;
}

}  // namespace

Eigen::Matrix4d compute_beam_dynamic_stiffness(const BeamProperties& beam, double length, double omega) {
  require_positive("beam", "angular frequency", omega, "rad/s");
  // d/dx of w, phi, shear force Q = kappa G A (w' - phi), moment E I phi'
  const double w2 = omega * omega;
  Eigen::Matrix4d S = Eigen::Matrix4d::Zero();
  S(0, 1) = 1;
  S(0, 2) = 1 / beam.shear_stiffness;
  S(1, 3) = 1 / beam.bending_stiffness;
  S(2, 0) = -beam.mass_per_length * w2;
  S(3, 1) = -beam.rotary_inertia * w2;
  S(3, 2) = -1;
  // exp(S l) by Cayley and Hamilton: the eigenvalues are +-sqrt(z_1), +-sqrt(z_2)
  const Eigen::Matrix4d S2 = S * S;
  const double half_sum = 0.25 * S2.trace(), product = S.determinant();
  const Complex root = std::sqrt(Complex(half_sum * half_sum - product));
  const Complex z_1 = half_sum + root, z_2 = half_sum - root, s_1 = std::sqrt(z_1), s_2 = std::sqrt(z_2);
  const Complex C_1 = std::cosh(s_1 * length), C_2 = std::cosh(s_2 * length);
  const Complex S_1 = std::sinh(s_1 * length) / s_1, S_2 = std::sinh(s_2 * length) / s_2;
  const Complex c_2 = (C_1 - C_2) / (z_1 - z_2), c_3 = (S_1 - S_2) / (z_1 - z_2);
  const Eigen::Matrix4d T = (C_1 - c_2 * z_1).real() * Eigen::Matrix4d::Identity() +
                            (S_1 - c_3 * z_1).real() * S + c_2.real() * S2 + c_3.real() * S2 * S;
  // forces at the ends for given ends: -Q, -moment on the left, Q, moment on the right
  const Eigen::Matrix2d to_left = T.topRightCorner<2, 2>().inverse();
  const Eigen::Matrix2d T_11 = T.topLeftCorner<2, 2>(), T_22 = T.bottomRightCorner<2, 2>();
  Eigen::Matrix4d K;
  K.topLeftCorner<2, 2>() = to_left * T_11;
  K.topRightCorner<2, 2>() = -to_left;
  K.bottomLeftCorner<2, 2>() = -to_left.transpose();
  K.bottomRightCorner<2, 2>() = T_22 * to_left;
  return 0.5 * (K + K.transpose());
}

PeriodicTrack::PeriodicTrack(const TrackData& data) : data_(one_bay(data)), spacing_(data.sleeper_spacing) {
  const TrackModel model(data_, 2);
  const int n = model.dofs_per_bay(), here = model.first_dof(1), next = model.first_dof(2);
  const auto block = [&](const Eigen::SparseMatrix<double>& A, int column) -> Eigen::MatrixXd {
    return Eigen::MatrixXd(A).block(here, column, n, n);
  };
  M_0_ = block(model.M(), here), C_0_ = block(model.C(), here), K_0_ = block(model.K(), here);
  M_plus_ = block(model.M(), next), C_plus_ = block(model.C(), next), K_plus_ = block(model.K(), next);
  rail_ = model.rail_dof(1) - here;
  if (data_.slab) slab_ = model.sleeper_dof(1) - here;
  const Eigen::MatrixXd coupling = M_plus_.cwiseAbs() + C_plus_.cwiseAbs() + K_plus_.cwiseAbs();
  for (int i = 0; i < n; ++i) {
    const bool is_slope = i == rail_ + 1 || (data_.slab && i == slab_ + 1);
    if (is_slope) slopes_.push_back(static_cast<int>(shared_.size()));
    (coupling.row(i).any() || coupling.col(i).any() ? shared_ : inner_).push_back(i);
  }
}

PeriodicTrack::Dynamic PeriodicTrack::compute_dynamic(double omega, bool damped) const {
  const double w2 = omega * omega;
  Eigen::MatrixXcd D_0 = (K_0_ - w2 * M_0_).cast<Complex>(),
                   D_plus = (K_plus_ - w2 * M_plus_).cast<Complex>();
  if (damped) {
    D_0 += 1i * omega * C_0_;
    D_plus += 1i * omega * C_plus_;
  }
  // exact beams instead of one element per bay
  const auto replace = [&](const BeamProperties& beam, int w) {
    const BeamElement element(beam, spacing_);
    const Eigen::Matrix4d change = compute_beam_dynamic_stiffness(beam, spacing_, omega) -
                                   (element.compute_stiffness() - w2 * element.compute_mass());
    D_0.block<2, 2>(w, w) += change.topLeftCorner<2, 2>() + change.bottomRightCorner<2, 2>();
    D_plus.block<2, 2>(w, w) += change.topRightCorner<2, 2>();
  };
  replace(rail_beam(data_), rail_);
  if (data_.slab) replace({data_.slab->bending_stiffness, data_.slab->mass_per_length}, slab_);
  // inner unknowns follow the shared ones
  Dynamic D{D_0(shared_, shared_), D_plus(shared_, shared_)};
  if (!inner_.empty()) {
    const Eigen::MatrixXcd inner = D_0(inner_, inner_);
    D.D_0 -= D_0(shared_, inner_) * inner.partialPivLu().solve(Eigen::MatrixXcd(D_0(inner_, shared_)));
  }
  return D;
}

Eigen::VectorXcd PeriodicTrack::compute_propagations(const Dynamic& D, Eigen::MatrixXcd& shapes) const {
  // rotations times the spacing, so that all unknowns are lengths
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(D.D_0.rows());
  for (const int i : slopes_) scale[i] = 1 / spacing_;
  const Eigen::MatrixXcd D_0 = scale.asDiagonal() * D.D_0 * scale.asDiagonal();
  const Eigen::MatrixXcd D_plus = scale.asDiagonal() * D.D_plus * scale.asDiagonal();
  const Eigen::Index n = D_0.rows();
  const Eigen::PartialPivLU<Eigen::MatrixXcd> forward(D_plus);
  Eigen::MatrixXcd companion = Eigen::MatrixXcd::Zero(2 * n, 2 * n);
  companion.topRightCorner(n, n).setIdentity();
  companion.bottomLeftCorner(n, n) = -forward.solve(Eigen::MatrixXcd(D_plus.transpose()));
  companion.bottomRightCorner(n, n) = -forward.solve(D_0);
  const Eigen::ComplexEigenSolver<Eigen::MatrixXcd> eigen(companion);
  if (eigen.info() != Eigen::Success)
    throw SolverError(data_.label() + ": the waves of the periodic track were not found");
  shapes = scale.asDiagonal() * eigen.eigenvectors().topRows(n);
  return eigen.eigenvalues();
}

double PeriodicTrack::strongest_harmonic(double omega, Complex propagation) const {
  const BeamProperties beam = rail_beam(data_);
  double best = 0, least = std::numeric_limits<double>::infinity();
  for (int n = -8; n <= 8; ++n) {
    const double k = (-std::arg(propagation) + 2 * pi * n) / spacing_;
    const double stiffness = std::abs(wave_stiffness(beam, k, omega));
    if (stiffness < least) least = stiffness, best = k;
  }
  return best;
}

std::vector<TrackWave> PeriodicTrack::compute_waves(double frequency) const {
  require_positive(data_.label(), "frequency", frequency, "Hz");
  const double omega = 2 * pi * frequency;
  Eigen::MatrixXcd shapes;
  std::vector<TrackWave> waves;
  for (const Complex mu : compute_propagations(compute_dynamic(omega, true), shapes))
    if (std::abs(mu) < 1)
      waves.push_back({mu, -20 * std::log10(std::abs(mu)) / spacing_, strongest_harmonic(omega, mu)});
  std::ranges::sort(waves, {}, &TrackWave::decay_rate);
  return waves;
}

std::vector<PropagatingWave> PeriodicTrack::compute_propagating_waves(double frequency) const {
  require_positive(data_.label(), "frequency", frequency, "Hz");
  const double omega = 2 * pi * frequency, step = 1e-5 * omega;
  const Dynamic D = compute_dynamic(omega, false);
  const Dynamic above = compute_dynamic(omega + step, false), below = compute_dynamic(omega - step, false);
  Eigen::MatrixXcd shapes;
  const Eigen::VectorXcd propagations = compute_propagations(D, shapes);
  std::vector<PropagatingWave> waves;
  for (Eigen::Index i = 0; i < propagations.size(); ++i) {
    const Complex mu = propagations[i] / std::abs(propagations[i]);
    if (std::abs(std::abs(propagations[i]) - 1) > 1e-7) continue;
    // y^H D(theta, w) y = 0 along the branch, mu = exp(i theta), k = -theta / spacing
    const Eigen::VectorXcd y = shapes.col(i);
    const auto form = [&](const Eigen::MatrixXcd& A) { return y.dot(A * y); };
    const Complex forward = mu * form(D.D_plus), change_0 = form(above.D_0 - below.D_0),
                  change_plus = mu * form(above.D_plus - below.D_plus);
    const double by_theta = -2 * forward.imag();
    const double by_omega = (change_0.real() + 2 * change_plus.real()) / (2 * step);
    const double group = spacing_ * by_theta / by_omega;
    if (!(group > 0)) continue;
    const double k = strongest_harmonic(omega, mu);
    waves.push_back({k, omega / k, group});
  }
  std::ranges::sort(waves, {}, &PropagatingWave::wavenumber);
  return waves;
}

Complex PeriodicTrack::compute_rail_receptance(double frequency, int n) const {
  require_positive(data_.label(), "frequency", frequency, "Hz");
  const Dynamic D = compute_dynamic(2 * pi * frequency, true);
  Eigen::MatrixXcd shapes;
  const Eigen::VectorXcd propagations = compute_propagations(D, shapes);
  const Eigen::Index size = D.D_0.rows();
  Eigen::MatrixXcd ahead(size, size);
  Eigen::VectorXcd mu(size);
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < propagations.size(); ++i)
    if (std::abs(propagations[i]) < 1 - 1e-10 && count < size) {
      ahead.col(count) = shapes.col(i);
      mu[count++] = propagations[i];
    }
  if (count < size)
    throw SolverError(fmt::format("{}: no steady response at {:g} Hz: a wave does not decay; add damping",
                                  data_.label(), frequency));
  // from one bay to the next, and the mirror image backward
  const Eigen::MatrixXcd X = ahead * mu.asDiagonal() * ahead.inverse();
  Eigen::VectorXd mirror = Eigen::VectorXd::Ones(size);
  for (const int i : slopes_) mirror[i] = -1;
  const Eigen::MatrixXcd sum =
      D.D_0 + D.D_plus * X + D.D_plus.transpose() * mirror.asDiagonal() * X * mirror.asDiagonal();
  const Eigen::Index w = static_cast<Eigen::Index>(std::ranges::find(shared_, rail_) - shared_.begin());
  Eigen::VectorXcd y = sum.partialPivLu().solve(Eigen::VectorXcd::Unit(size, w));
  for (int j = 0; j < std::abs(n); ++j) y = X * y;
  return y[w];
}

double pinned_pinned_frequency(const TrackData& data) {
  validate(data);
  const BeamProperties beam = rail_beam(data);
  const double k = pi / data.sleeper_spacing, EI = beam.bending_stiffness, rhoA = beam.mass_per_length;
  if (beam.is_shear_stiff()) return k * k * std::sqrt(EI / rhoA) / (2 * pi);
  // a w^4 - b w^2 + c = 0 of Timoshenko's beam with pinned ends, the lower root
  const double S = beam.shear_stiffness;
  const double a = beam.rotary_inertia * rhoA;
  const double b = beam.rotary_inertia * S * k * k + rhoA * (EI * k * k + S);
  const double c = EI * S * std::pow(k, 4);
  return std::sqrt(2 * c / (b + std::sqrt(b * b - 4 * a * c))) / (2 * pi);
}

}  // namespace easydyn::track

#include "track/critical_speed.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "easydyn/math/units.hpp"
#include "easydyn/require.hpp"
#include "track/track_model.hpp"

namespace easydyn::track {

namespace {

using units::pi;

// Lowest w(theta) of one bay whose ends move with the phase theta between them.
class LowestWave {
 public:
  explicit LowestWave(TrackData data) {
    data.elements_per_bay = std::max(4, data.elements_per_bay);
    data.ends.bays = 0;
    data.variation = {};
    const TrackModel model(data, 2);
    const int n = model.dofs_per_bay(), here = model.first_dof(1);
    const Eigen::MatrixXd M = model.M(), K = model.K();
    M_0_ = M.block(here, here, n, n), K_0_ = K.block(here, here, n, n);
    // the bay behind, whole; ahead of bay 1 the track ends with its sleeper
    M_minus_ = M.block(here, 0, n, n), K_minus_ = K.block(here, 0, n, n);
  }
  double omega(double theta) const {
    const std::complex<double> back = std::polar(1.0, theta);  // exp(i (w t - k x)): the bay behind leads
    const auto with_phase = [&](const Eigen::MatrixXd& A_0, const Eigen::MatrixXd& A_minus) {
      const Eigen::MatrixXcd coupling = back * A_minus;
      return Eigen::MatrixXcd(A_0.cast<std::complex<double>>() + coupling + coupling.adjoint());
    };
    // M may be singular, K is not: the largest 1 / w^2
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXcd> eigen(
        with_phase(M_0_, M_minus_), with_phase(K_0_, K_minus_), Eigen::EigenvaluesOnly);
    return 1 / std::sqrt(eigen.eigenvalues().maxCoeff());
  }

 private:
  Eigen::MatrixXd M_0_, K_0_, M_minus_, K_minus_;
};

// Rail, and slab, as one beam with all masses on all springs in series.
CriticalSpeed estimate(const TrackData& data) {
  const double L = data.sleeper_spacing;
  const Clm ground = as_clm(data.foundation);
  double compliance = 1 / data.pad_stiffness + 1 / data.ballast_stiffness,
         mass = data.sleeper_mass + ground.m_f;
  double EI = rail_beam(data).bending_stiffness, m = rail_beam(data).mass_per_length;
  if (data.under_sleeper_pads) compliance += 1 / data.under_sleeper_pads->stiffness;
  if (data.ballast_mass) {
    compliance += 1 / data.ballast_mass->base_stiffness;
    mass += data.ballast_mass->mass;
  }
  if (!is_rigid(data.foundation)) compliance += 1 / ground.k_f;
  if (data.slab) {
    EI += data.slab->bending_stiffness;
    m += data.slab->mass_per_length;
  }
  m += mass / L;
  const double k_w = 1 / (compliance * L), k = std::pow(k_w / EI, 0.25);
  const double speed = std::pow(4 * k_w * EI / (m * m), 0.25);
  return {speed, k, speed * k / (2 * pi), false};
}

}  // namespace

CriticalSpeed compute_critical_speed(const TrackData& data) {
  const LowestWave wave(data);
  const auto ratio = [&](double log_theta) { return wave.omega(std::exp(log_theta)) / std::exp(log_theta); };
  // coarse scan over three decades, then golden section about the lowest inner minimum
  const double first = std::log(1e-3 * pi), last = std::log(pi);
  constexpr int points = 300;
  const double step = (last - first) / (points - 1);
  std::vector<double> speed(points);
  for (int i = 0; i < points; ++i) speed[static_cast<std::size_t>(i)] = ratio(first + i * step);
  int best = -1;
  for (std::size_t i = 1; i + 1 < speed.size(); ++i)
    if (speed[i] <= speed[i - 1] && speed[i] < speed[i + 1] &&
        (best < 0 || speed[i] < speed[static_cast<std::size_t>(best)]))
      best = static_cast<int>(i);
  if (best < 0) return estimate(data);
  double a = first + (best - 1) * step, b = first + (best + 1) * step;
  const double golden = 0.5 * (std::sqrt(5.0) - 1);
  while (b - a > 1e-6) {
    const double c = b - golden * (b - a), d = a + golden * (b - a);
    const bool is_left = ratio(c) < ratio(d);
    (is_left ? b : a) = is_left ? d : c;
  }
  const double theta = std::exp(0.5 * (a + b)), omega = wave.omega(theta), spacing = data.sleeper_spacing;
  return {omega / theta * spacing, theta / spacing, omega / (2 * pi), true};
}

std::optional<std::string> warn_of_critical_speed(const TrackData& data, double speed, double fraction) {
  require_finite(data.label(), "speed", speed, "m/s");
  speed = std::abs(speed);
  const CriticalSpeed critical = compute_critical_speed(data);
  if (speed <= fraction * critical.speed) return std::nullopt;
  return fmt::format(
      "{}: the speed {:.1f} m/s is {:.2f} of the critical speed {:.1f} m/s of the track on its foundation "
      "({}; wave of "
      "{:.1f} m at {:.1f} Hz); deflections grow towards it",
      data.label(), speed, speed / critical.speed, critical.speed,
      critical.is_wave ? "slowest wave" : "estimate", 2 * pi / critical.wavenumber, critical.frequency);
}

}  // namespace easydyn::track

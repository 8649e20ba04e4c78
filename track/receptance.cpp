#include "track/receptance.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>
#include <cmath>
#include <complex>

#include "easydyn/math/units.hpp"
#include "easydyn/require.hpp"

namespace easydyn::track {

Eigen::VectorXd compute_static_response(const TrackModel& track, const Eigen::VectorXd& load) {
  // the numbering by bay is already that of a narrow band
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::NaturalOrdering<int>> K(
      track.K());
  if (K.info() != Eigen::Success)
    throw SolverError(track.data().label() + ": static stiffness is singular; check supports and foundation");
  return K.solve(load);
}

Eigen::MatrixXcd compute_harmonic_response(const TrackModel& track, const Eigen::VectorXd& load,
                                           std::span<const double> frequencies) {
  using namespace std::complex_literals;
  using SparseComplex = Eigen::SparseMatrix<std::complex<double>>;
  const SparseComplex K = track.K().cast<std::complex<double>>(), C = track.C().cast<std::complex<double>>(),
                      M = track.M().cast<std::complex<double>>();
  const Eigen::VectorXcd f = load.cast<std::complex<double>>();
  Eigen::MatrixXcd response(track.size(), frequencies.size());
  // dynamic stiffness at each frequency; its pattern is always the same
  Eigen::SparseLU<SparseComplex, Eigen::NaturalOrdering<int>> lu;
  for (size_t i = 0; i < frequencies.size(); ++i) {
    const double frequency = frequencies[i], omega = 2 * units::pi * frequency;
    require_not_negative(track.data().label(), "frequency", frequency, "Hz");
    const SparseComplex dynamic = K + (1i * omega) * C - std::complex<double>(omega * omega) * M;
    if (i == 0) lu.analyzePattern(dynamic);
    lu.factorize(dynamic);
    if (lu.info() != Eigen::Success)
      throw SolverError(
          fmt::format("{}: dynamic stiffness is singular at {:g} Hz; add damping or avoid the "
                      "resonance",
                      track.data().label(), frequency));
    response.col(i) = lu.solve(f);
  }
  return response;
}

Eigen::VectorXcd compute_rail_receptance(const TrackModel& track, double x_load, double x_response,
                                         std::span<const double> frequencies) {
  const Eigen::MatrixXcd q = compute_harmonic_response(track, track.rail_load(x_load, 1), frequencies);
  const RailPoint point = track.rail_point(x_response);
  Eigen::VectorXcd w = Eigen::VectorXcd::Zero(q.cols());
  for (int i = 0; i < 4; ++i) w += point.shape.N[i] * q.row(point.dof[i]).transpose();
  return w;
}

Eigen::VectorXcd compute_sleeper_receptance(const TrackModel& track, double x_load, int j,
                                            std::span<const double> frequencies) {
  return compute_harmonic_response(track, track.rail_load(x_load, 1), frequencies).row(track.sleeper_dof(j));
}

Eigen::VectorXcd compute_receptance_between_sleepers(const TrackModel& track, int i, int j,
                                                     std::span<const double> frequencies) {
  for (const int sleeper : {i, j})
    require(sleeper >= 0 && sleeper < track.sleepers(), track.data().label(), "sleeper", sleeper, "",
            fmt::format("0 to {}", track.sleepers() - 1));
  const Eigen::VectorXd load = Eigen::VectorXd::Unit(track.size(), track.sleeper_dof(i));
  return compute_harmonic_response(track, load, frequencies).row(track.sleeper_dof(j));
}

Eigen::VectorXd compute_decay_rate(const TrackModel& track, double x_load,
                                   std::span<const double> frequencies) {
  const TrackData& data = track.data();
  const double spacing = data.sleeper_spacing, step = spacing / data.elements_per_bay;
  const double last = track.end() - data.ends.bays * spacing;
  require(
      x_load >= track.begin() && x_load <= last - spacing, data.label(), "x of the force for the decay rate",
      x_load, "m",
      fmt::format("between {:g} and {:g}, a bay before the absorbing ones", track.begin(), last - spacing));
  const Eigen::MatrixXcd q = compute_harmonic_response(track, track.rail_load(x_load, 1), frequencies);
  const auto squared = [&](double x) {
    const RailPoint point = track.rail_point(x);
    Eigen::VectorXcd w = Eigen::VectorXcd::Zero(q.cols());
    for (int i = 0; i < 4; ++i) w += point.shape.N[i] * q.row(point.dof[i]).transpose();
    return Eigen::VectorXd(w.cwiseAbs2());
  };
  const Eigen::VectorXd at_load = squared(x_load);
  Eigen::VectorXd sum = 0.5 * step * at_load;
  for (int n = 1; x_load + n * step <= last; ++n) sum += step * squared(x_load + n * step);
  return 10 / std::log(10.0) * at_load.cwiseQuotient(sum);
}

}  // namespace easydyn::track

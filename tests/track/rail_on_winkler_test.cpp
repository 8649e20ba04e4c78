#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <cmath>

#include "tests/reference/winkler_beam.hpp"
#include "track/receptance.hpp"
#include "track/track_model.hpp"

namespace {

using namespace easydyn::track;
using easydyn::reference::WinklerBeam;

const double EI = 6.38e6, m = 60.21, k = 50e6, P = 85e3;  // one UIC60 rail on 50 MN/m2
const WinklerBeam beam{EI, m, k};

/// One rail on springs so close that they make a uniform foundation of stiffness k and damping d per length.
TrackData fine_track(double spacing, double d = 0) {
  TrackData data;
  data.name = "fine";
  data.rail = rail_section("60E1");
  data.rail.inertia = EI / data.rail.youngs_modulus;
  data.rails = 1;
  data.sleeper_spacing = spacing;
  data.pad_stiffness = k * spacing;
  data.pad_damping = d * spacing;
  data.sleeper_mass = 1e-6;                    // nothing but a knot
  data.ballast_stiffness = 1e6 * k * spacing;  // rigid: 1e-6 of the pad's compliance
  data.ballast_damping = 0;
  data.footprint_length = data.footprint_width = 1;
  data.elements_per_bay = 1;
  data.ends.bays = 0;
  return data;
}

TEST(RailOnWinklerFoundation, HasTheTextbookConstants) {
  EXPECT_NEAR(beam.lambda(), 1.183, 0.0005);
  EXPECT_NEAR(beam.static_deflection(P, 0), 1.006e-3, 0.5e-6);
  EXPECT_NEAR(beam.critical_speed(), 770, 1);
}

TEST(RailOnWinklerFoundation, DeflectsAsZimmermannUnderAStaticLoad) {
  const TrackModel track(fine_track(0.1), 400, -20);
  const Eigen::VectorXd q = compute_static_response(track, track.rail_load(0, P));
  for (const double x : {0.0, 0.3, 1.0, 2.0, -2.65, 4.0}) {
    const RailPoint point = track.rail_point(x);
    // 2e-6 of the largest deflection: springs a = 0.1 m apart change EI by 4 (lambda a)^4 / 720 = 1.1e-6, the
    // ballast k by 1e-6; measured 6e-7
    EXPECT_NEAR(point.deflection(q), beam.static_deflection(P, x), 2e-6 * beam.static_deflection(P, 0));
  }
}

TEST(RailOnWinklerFoundation, HasTheReceptanceOfTheInfiniteBeam) {
  const double d = 3e4;  // [N s/m2], so that nothing returns from the ends
  const TrackModel track(fine_track(0.1, d), 1200, -60);
  const std::vector<double> frequencies = {1, 20, 80, 140, 200, 400};  // cut-on of the undamped beam: 145 Hz
  const Eigen::VectorXcd H = compute_rail_receptance(track, 0, 0, frequencies);
  for (size_t i = 0; i < frequencies.size(); ++i) {
    const double omega = 2 * std::acos(-1.0) * frequencies[i];
    const std::complex<double> exact = beam.point_receptance(omega, {k, omega * d});
    EXPECT_LT(std::abs(H[i] / exact - 1.0), 1e-3) << frequencies[i] << " Hz";
  }
}

TEST(RailOnWinklerFoundation, StaysInTheSteadyStateOfAMovingLoad) {
  const double v = 400, length = 8;  // a = v / v_cr = 0.52
  const TrackModel track(fine_track(0.1), 500, -20);
  // start in the exact steady state with the load at x = 0
  Eigen::VectorXd q = Eigen::VectorXd::Zero(track.size()), qd = q, qdd = q;
  const auto w = [&](double s) { return beam.moving_deflection(P, v, s); };
  const double e = 1e-4;
  for (int node = 0; node < track.nodes(); ++node) {
    const double s = track.node_x(node);
    const int i = track.rail_dof(node);
    const double dw = (w(s + e) - w(s - e)) / (2 * e), ddw = (w(s + e) - 2 * w(s) + w(s - e)) / (e * e);
    q[i] = w(s), q[i + 1] = dw, qd[i] = -v * dw, qd[i + 1] = -v * ddw, qdd[i] = v * v * ddw;
  }
  for (int j = 0; j < track.sleepers(); ++j) q[track.sleeper_dof(j)] = 1e-6 * q[track.rail_dof(j)];
  // Newmark, beta = 1/4, gamma = 1/2
  const int steps = 1600;
  const double h = length / v / steps;
  const Eigen::SparseMatrix<double> A = track.M() + h / 2 * track.C() + h * h / 4 * track.K();
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(A);
  qdd = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(track.M()).solve(track.rail_load(0, P) -
                                                                            track.K() * q - track.C() * qd);
  for (int n = 1; n <= steps; ++n) {
    const Eigen::VectorXd q_p = q + h * qd + h * h / 4 * qdd, qd_p = qd + h / 2 * qdd;
    qdd = solver.solve(track.rail_load(n * length / steps, P) - track.C() * qd_p - track.K() * q_p);
    q = q_p + h * h / 4 * qdd;
    qd = qd_p + h / 2 * qdd;
  }
  for (const double s : {0.0, 0.5, -0.5, 1.5, -1.5, 3.0, -3.0}) {
    const RailPoint point = track.rail_point(length + s);
    EXPECT_NEAR(point.deflection(q) / w(0), w(s) / w(0), 0.005) << s;
  }
}

}  // namespace

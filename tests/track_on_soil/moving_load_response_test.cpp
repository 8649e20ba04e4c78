#include "track_on_soil/moving_load_response.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "soil/layered/footprint_response.hpp"
#include "tests/reference/winkler_beam.hpp"
#include "tests/track_on_soil/small_sites.hpp"

namespace easydyn::track_on_soil {
namespace {

using easydyn::testing::half_space;
using easydyn::testing::layer_of;

TEST(MovingLoadResponse, OnStiffGroundIsThatOfABeamOnWinklerSprings) {
  track::TrackData data = track::thalys_like_track();
  data.sleeper_mass = 1e-3;
  data.pad_damping = data.ballast_damping = 0;
  const track::BeamProperties rail = rail_beam(data);
  const reference::WinklerBeam beam{rail.bending_stiffness, rail.mass_per_length,
                                    1 / (1 / data.pad_stiffness + 1 / data.ballast_stiffness) / 0.6};
  const Eigen::VectorXd s = Eigen::VectorXd::LinSpaced(25, -6, 6);
  const soil::Site rock = half_space(2e4, 0.25, 0.001);  // moves 2e-5 of the springs
  for (const double part : {0.1, 0.5, 0.8}) {
    const double v = part * beam.critical_speed();
    const Eigen::VectorXd w = compute_moving_load_response(data, rock, v, s);
    for (Eigen::Index i = 0; i < s.size(); ++i)
      // what lies above the largest wavenumber, 1 / (3 EI k^3 pi): 1e-4 of the deflection
      EXPECT_NEAR(w[i], beam.moving_deflection(1, v, s[i]), 3e-4 * w.maxCoeff())
          << v << " m/s, " << s[i] << " m";
  }
}

TEST(MovingLoadResponse, OfASlowLoadIsThatOfSleepersOnTheirCompliances) {
  // The same track sleeper by sleeper: footprints side by side on the ground, each on every other's compliance, a rail
  // with one element per bay.
  track::TrackData data = track::thalys_like_track();
  data.footprint_length = data.sleeper_spacing;
  data.footprint_width = 2.5;
  soil::Site site;
  site.damping_frequency = 0.1;
  site.layers = {layer_of(1.5, 90, 0.33, 1850, 1e-3), half_space(200, 0.3, 1e-3).layers[0]};
  constexpr int n = 81;
  const double L = data.sleeper_spacing, EI = rail_beam(data).bending_stiffness;
  const Eigen::MatrixXcd H = compute_compliances(soil::LayeredGround(site, soil::GroundDamping::constant_q),
                                                 L, 2.5, L, n, Eigen::VectorXd::Constant(1, 0.1));
  Eigen::MatrixXd C(n, n), K = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      C(i, j) =
          H(0, std::abs(i - j)).real() + (i == j) * (1 / data.pad_stiffness + 1 / data.ballast_stiffness);
  Eigen::Matrix4d beam;
  beam << 12, 6 * L, -12, 6 * L, 6 * L, 4 * L * L, -6 * L, 2 * L * L, -12, -6 * L, 12, -6 * L, 6 * L,
      2 * L * L, -6 * L, 4 * L * L;
  for (int i = 0; i + 1 < n; ++i) K.block<4, 4>(2 * i, 2 * i) += EI / (L * L * L) * beam;
  const Eigen::MatrixXd support = C.inverse();
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) K(2 * i, 2 * j) += support(i, j);
  Eigen::VectorXd load = Eigen::VectorXd::Zero(2 * n);
  load[n - 1] = 1;  // on the sleeper in the middle
  const Eigen::VectorXd q = K.partialPivLu().solve(load);
  const Eigen::VectorXd s = L * Eigen::VectorXd::LinSpaced(9, 0, 8);
  const Eigen::VectorXd w = compute_moving_load_response(data, site, 0.5, s);
  for (int i = 0; i < 9; ++i)  // springs smeared over the spacing: 1 %
    EXPECT_NEAR(w[i], q[n - 1 + 2 * i], 0.01 * w[0]) << i;
}

}  // namespace
}  // namespace easydyn::track_on_soil

// What the ends of the modelled track send out: a constant load that runs onto the first sleeper and off the last one.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "soil/layered/layered_mobility.hpp"
#include "soil/layered/superposition.hpp"
#include "soil/recoupling.hpp"
#include "tests/soil/layered_comparison.hpp"
#include "tests/soil/verification_record.hpp"

namespace easydyn::soil {
namespace {

/// v_z at 24 m from the middle of a track of 2 `half` + 1 sleepers on 5 m of 150 m/s on 300 m/s, damping 3 %, up to 20 Hz, under
/// an axle load of 100 kN that comes from 156 m and goes as far. The rail spreads it as a Gaussian, standard deviation 1 m:
/// slower than the waves in the ground it sends none, but for those of the ends.
GroundMotion pass(double speed, int half, double taper_length) {
  constexpr double spacing = 0.6;
  Site site;
  site.layers = {test::damped_layer(5, 150), test::damped_layer(0, 300)};
  site.receivers = {{"24 m", {0, 24, 0}}};
  site.highest_frequency = 20;
  site.damping_frequency = 10;
  site.taper_length = taper_length;
  SurfaceLoads loads;
  for (int j = -half; j <= half; ++j) loads.footprints.push_back({j * spacing, 0, 0.3, 2.5});
  const double end = 156 / speed;
  loads.time = Eigen::VectorXd::LinSpaced(static_cast<Eigen::Index>(2 * end / 2.5e-3) + 1, -end, end);
  loads.force.resize(loads.time.size(), static_cast<Eigen::Index>(loads.footprints.size()));
  for (Eigen::Index n = 0; n < loads.time.size(); ++n)
    for (Eigen::Index j = 0; j < loads.force.cols(); ++j) {
      const double s = loads.footprints[static_cast<std::size_t>(j)].x - speed * loads.time(n);
      loads.force(n, j) = 1e5 * spacing / std::sqrt(2 * std::numbers::pi) * std::exp(-s * s / 2);
    }
  Mobility mobility = list_distances(loads.footprints, site.receivers);
  update_mobility(LayeredGround(site, GroundDamping::maxwell_body), site.highest_frequency, mobility, 1.5);
  return superpose(mobility, site, loads);
}

double largest(const Eigen::MatrixXd& v) {
  return v.cwiseAbs().maxCoeff();
}
double largest_above_2_Hz(const GroundMotion& motion) {
  return largest(motion.vz - compute_slow_part(motion.vz, motion.time(1) - motion.time(0), 2));
}

TEST(Taper, KeepsTheEndsOfTheTrackQuiet) {
  // The passing load moves the ground by its slowly changing deflection, next to nothing above 2 Hz. What the ends of a
  // shorter track add above 2 Hz, over that motion; a taper of 0.6 to 0.7 s of way:
  //   12 m/s,  48 m of track: 5.4 without a taper, 0.26 with  8 m
  //   40 m/s, 120 m of track: 12  without a taper, 0.31 with 24 m, but 3.2 with 8 m
  // (Below 2 Hz any finite track differs, as deflections reach as far as 1 / r.)
  struct Case {
    double speed;
    int half;
    double taper, pulse;
  };
  double worst = 0;
  for (const Case& c : {Case{12, 40, 8, 5}, Case{40, 100, 24, 10}}) {
    const GroundMotion whole = pass(c.speed, 250, 130);
    const double motion = largest(whole.vz);
    const double without = largest_above_2_Hz(pass(c.speed, c.half, 0)) / motion;
    const double share = largest_above_2_Hz(pass(c.speed, c.half, c.taper)) / motion;
    std::printf("%g m/s: %.2e m/s, above 2 Hz %.4f of it; the ends %.2f without a taper, %.3f with %g m\n",
                c.speed, motion, largest_above_2_Hz(whole) / motion, without, share, c.taper);
    EXPECT_LT(largest_above_2_Hz(whole), 0.02 * motion);
    EXPECT_GT(without, c.pulse);
    EXPECT_LT(share, 0.4);
    worst = std::max(worst, share);
  }
  test::record_verification("taper", worst);
}

}  // namespace
}  // namespace easydyn::soil

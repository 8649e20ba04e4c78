// Saturated soil, a layer like any other whose compression wave is that of the water: finite elements against the
// semi-analytical half-space, and what its damping does to both waves.

#include <gtest/gtest.h>

#include <cmath>

#include "soil/layered/footprint_response.hpp"
#include "soil/rheology.hpp"
#include "tests/soil/layered_comparison.hpp"
#include "tests/soil/verification_record.hpp"

namespace easydyn::soil {
namespace {

/// 2 m of dry soil, cs 150 m/s, cp 300 m/s; below the water table cp 1500 m/s: Poisson ratio 0.4949 where cs is 150 m/s.
Site make_site(double cs_below) {
  Site site;
  site.layers = {test::damped_layer(2, 150), test::damped_layer(0, cs_below)};
  site.layers[0].cp = 300;
  site.layers[1].cp = 1500;
  site.layers[1].density = 2000;
  site.highest_frequency = 25;
  return site;
}

TEST(WaterTable, IsSolvedAsByTheLayeredHalfSpace) {
  Site site = make_site(150);
  site.margin = 6;
  site.duration = 0.6;
  const std::vector<double> errors = test::compare_with_layered_half_space(site, {5, 10, 20}, 8);
  const double worst = *std::max_element(errors.begin(), errors.end());
  EXPECT_LT(worst, 0.01);  // measured 0.6 %
  test::record_verification("water-table", 100 * worst);
}

TEST(WaterTable, IsSolvedAtTheHighestPoissonRatio) {
  // 0.4995: cs 47.44 m/s under water, in single precision as by default. Measured 0.3 %.
  Site site = make_site(47.44);
  site.layers[0].cs = 60;
  site.layers[0].cp = 120;
  site.highest_frequency = 10;
  site.margin = 4;
  site.duration = 0.7;
  const std::vector<double> errors = test::compare_with_layered_half_space(site, {5}, 3);
  EXPECT_LT(errors[0], 0.01);
}

TEST(WaterTable, ShortensTheTimeStepAsItRaisesTheSpeed) {
  // 5 times the speed on the same lattice. Under 2 m of dry soil, whose elements are the smallest, less.
  SurfaceLoads loads;
  loads.footprints = {{0, 0, 1, 1}};
  loads.time = Eigen::VectorXd::LinSpaced(301, 0, 0.3);
  loads.force = Eigen::VectorXd::Zero(301);
  const auto count_steps = [&](double cp_above, double cp_below) {
    Site site = make_site(150);
    site.layers[0].cp = cp_above;
    site.layers[1].cp = cp_below;
    site.layers[1].density = 1800;
    site.receivers = {{"near", {3, 3, 0}}};
    site.taper_length = 0;
    site.duration = 1;
    SolverOptions options;
    options.quarter_model = true;
    options.sponge_elements = 2;
    return static_cast<double>(make_solver(site, loads, options).steps());
  };
  const double dry = count_steps(300, 300), saturated = count_steps(1500, 1500) / dry,
               below = count_steps(300, 1500) / dry;
  std::printf("steps over those of dry soil: saturated %.2f, below 2 m %.2f\n", saturated, below);
  EXPECT_NEAR(saturated, 5.5, 0.2);
  EXPECT_NEAR(below, 3.8, 0.2);
}

TEST(WaterTable, HasItsDampingRatioInBothWaves) {
  // One complex factor for both moduli: the ratio of the wave speeds stays as given, and so does Poisson's.
  Site site = make_site(150);
  site.damping_frequency = 10;
  const Rheology rheology = make_rheology(site, DampingModel::constant_ratio);
  for (std::size_t k = 0; k < 2; ++k) {
    const EngineMaterial& material = rheology.materials[k];
    EXPECT_NEAR((material.lambda + 2 * material.mu) / material.mu,
                std::pow(site.layers[k].cp / site.layers[k].cs, 2), 1e-9);
    EXPECT_EQ(material.memory_weights.size(), rheology.rates.size());
  }
  // Over the band the body moves the ground as one whose ratio is constant at all frequencies, as well as without water.
  FootprintRequest request;
  request.length = request.width = 1;
  request.points = {{4, 3, 0}, {8, 6, 0}, {4, 3, -3}};
  Eigen::VectorXcd w(4);
  w << 2 * M_PI * 3, 2 * M_PI * 6, 2 * M_PI * 12, 2 * M_PI * 25;
  const auto compare = [&] {
    const FootprintResponse body =
        compute_footprint_response(LayeredGround(site, GroundDamping::maxwell_body), request, w);
    const FootprintResponse constant =
        compute_footprint_response(LayeredGround(site, GroundDamping::constant_q), request, w);
    double worst = 0;
    for (Eigen::Index i = 0; i < w.size(); ++i)
      for (Eigen::Index p = 0; p < 3; ++p) {
        const Eigen::Vector3cd a(body.ux(i, p), body.uy(i, p), body.uz(i, p)),
            b(constant.ux(i, p), constant.uy(i, p), constant.uz(i, p));
        worst = std::max(worst, (a - b).norm() / b.norm());
      }
    return worst;
  };
  const double saturated = compare();
  site.layers[1].cp = 300;
  const double dry = compare();
  std::printf("Maxwell body from constant Q: saturated %.4f, dry %.4f\n", saturated, dry);
  EXPECT_LT(saturated, 0.05);
  EXPECT_LT(saturated, 1.2 * dry);
}

}  // namespace
}  // namespace easydyn::soil

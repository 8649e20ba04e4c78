#include <gtest/gtest.h>

#include <cmath>

#include "soil/wave_solver.hpp"
#include "tests/reference/lamb.hpp"

namespace easydyn::soil {
namespace {

using reference::Lamb;

TEST(LambReference, AgreesWithPekerisAndTheStaticLimits) {
  const Lamb lamb(0.25);  // values of Pekeris (1955) as tabulated from Kausel's closed form
  EXPECT_NEAR(lamb.vertical(0.70), -0.00304866, 1e-8);
  EXPECT_NEAR(lamb.vertical(0.90), -0.00907218, 1e-8);
  EXPECT_NEAR(lamb.vertical(0.99), -0.02558260, 1e-8);
  EXPECT_NEAR(lamb.vertical(1.01), -0.03802151, 1e-8);
  EXPECT_NEAR(lamb.vertical(1.04), -0.08011506, 1e-8);
  EXPECT_NEAR(lamb.vertical(1.06), -0.14125434, 1e-8);
  EXPECT_NEAR(lamb.vertical(1.10), 0.11936621, 1e-8);
  EXPECT_NEAR(lamb.rayleigh_slowness(), 1.0876639, 1e-7);
  for (const double nu : {0.0, 0.2, 0.25, 0.35, 0.45}) {
    const Lamb any(nu);
    EXPECT_NEAR(any.radial(1e4), -(1 - 2 * nu) / (4 * M_PI), 1e-7) << "nu " << nu;  // Boussinesq, inward
    EXPECT_NEAR(any.vertical(1 - 1e-12), any.vertical(1 + 1e-12), 1e-5) << "nu " << nu;
  }
}

// A mesh small enough for the sanitizers; at the resolution and the receivers that matter: lamb_test.cpp.
TEST(LambsProblem, IsSolvedNearTheSourceOnASmallMesh) {
  const double nu = 0.25, cs = 150, f0 = 20, delay = 1.3 / f0, r = 5;
  Site site;
  Layer ground;
  ground.density = 1800;
  ground.cs = cs;
  ground.cp = cs * std::sqrt(3.0);
  site.layers = {ground};
  site.receivers = {{"r", {0, r, 0}}};
  site.highest_frequency = 2.5 * f0;
  site.points_per_wavelength = 4.5;
  site.margin = 2;
  site.duration = 0.16;
  const auto ricker = [&](double t) {
    const double a = std::pow(M_PI * f0 * (t - delay), 2);
    return (1 - 2 * a) * std::exp(-a);
  };
  SurfaceLoads loads;
  loads.footprints = {{0, 0, 0.2, 0.2}};
  loads.time = Eigen::VectorXd::LinSpaced(161, 0, 0.16);
  loads.force = (1e4 * loads.time.unaryExpr(ricker)).eval();
  SolverOptions options;
  options.degree = 5;
  options.output_step = 2e-3;
  options.sponge_elements = 3;
  WaveSolver solver(site, loads, options);
  const GroundMotion motion = solver.run();
  const Lamb lamb(nu);
  const double scale = 1e4 / (1800 * cs * cs * r), h = 1e-4;
  const auto second = [&](double t) { return (ricker(t + h) - 2 * ricker(t) + ricker(t - h)) / (h * h); };
  double difference = 0, norm = 0;
  for (Eigen::Index i = 0; i < motion.time.size(); ++i) {
    const double exact = -scale * lamb.convolve(true, second, 0, 2 * delay, motion.time(i), r, cs);
    difference += std::pow(motion.vz(i, 0) - exact, 2);
    norm += exact * exact;
  }
  std::printf("%ld dof, %ld steps: %.4f\n", solver.lattice().dofs(), solver.steps(),
              std::sqrt(difference / norm));
  EXPECT_LT(std::sqrt(difference / norm), 0.03);  // measured: 0.011
}

}  // namespace
}  // namespace easydyn::soil

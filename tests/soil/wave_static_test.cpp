#include <gtest/gtest.h>

#include <cmath>

#include "soil/wave_solver.hpp"
#include "tests/soil/verification_record.hpp"

namespace easydyn::soil {
namespace {

TEST(StaticLoad, DoesNotDriftWhenHeldForTwentySeconds) {
  // Raised over 0.5 s (the preload) and held; coarse and soft so that the step is long. From 1 s on, when the
  // waves of the ramp have left, the deflection must stay.
  // The last case with a crossover: both lattices must be at rest, and the deeper sponge leaves less of the springs.
  for (const auto& [nu, crossover] : {std::pair{0.33, 0.0}, {0.45, 0.0}, {0.45, 8.0}}) {
    Site site;
    Layer ground;
    ground.density = 1800;
    ground.cs = 200;
    ground.cp = 200 * std::sqrt((2 - 2 * nu) / (1 - 2 * nu));
    site.layers = {ground};
    site.receivers = {{"near", {2, 3, 0}}};
    site.highest_frequency = 25;
    site.points_per_wavelength = 4;
    site.margin = 1;
    site.duration = 20;
    SurfaceLoads loads;
    loads.footprints = {{0, 0, 6, 6}};  // as large as an element: the mesh resolves it
    loads.time = Eigen::VectorXd::LinSpaced(401, 0, 20);
    loads.force = Eigen::MatrixXd::Constant(401, 1, 1e4);
    SolverOptions options;
    options.degree = 3;
    options.sponge_elements = 4;
    options.output_step = 0.1;
    options.crossover_frequency = crossover;
    const GroundMotion motion = WaveSolver(site, loads, options).run();
    const Eigen::VectorXd w = motion.footprint_displacement.col(0);
    const Eigen::Index nt = w.size();
    const double drift = (w.tail(nt - 10).array() - w(10)).abs().maxCoeff() / w(nt - 1);
    EXPECT_LT(drift, 0.01) << "nu " << nu;
    test::record_verification("drift", 100 * drift);
    test::record_verification("growth", motion.vz.bottomRows(nt / 2).cwiseAbs().maxCoeff() / w(nt - 1));
    EXPECT_LT(motion.vz.bottomRows(nt / 2).cwiseAbs().maxCoeff(), 1e-3 * w(nt - 1))
        << "nu " << nu;  // at rest
    // Uniform pressure p on a square of side a: mean displacement 0.946 (1 - nu^2) p a / E (Timoshenko and
    // Goodier, recalled). The springs of the outer faces and the mesh hold it within some percent.
    const double E = 2 * 1800 * 200.0 * 200 * (1 + nu), exact = 0.946 * (1 - nu * nu) * 1e4 / 6 / E;
    EXPECT_NEAR(w(nt - 1), exact, 0.1 * exact) << "nu " << nu;
    std::printf("nu %.2f, crossover %.0f Hz: drift %.2e, displacement / exact %.4f, %ld steps of %ld dof\n",
                nu, crossover, drift, w(nt - 1) / exact, WaveSolver(site, loads, options).steps(),
                WaveSolver(site, loads, options).lattice().dofs());
  }
}

TEST(StaticLoad, LeavesNoMotionThatGrows) {
  // As above, in double precision with constant damping and the sponge by default, in nearly incompressible ground: what moves from 15 to 20 s is
  // at most what moved from 10 to 15 s. A growth of 1 % a second would be a ratio of 1.05.
  Site site;
  Layer ground;
  ground.density = 1800;
  ground.cs = 200;
  ground.cp = 200 * std::sqrt((2 - 2 * 0.45) / (1 - 2 * 0.45));
  ground.damping = 0.03;
  site.layers = {ground};
  site.receivers = {{"near", {2, 3, 0}}, {"far", {8, 9, 0}}, {"deep", {0, 3, -6}}};
  site.highest_frequency = 25;
  site.damping_frequency = 12;
  site.points_per_wavelength = 4;
  site.margin = 1;
  site.duration = 20;
  SurfaceLoads loads;
  loads.footprints = {{0, 0, 6, 6}};
  loads.time = Eigen::VectorXd::LinSpaced(401, 0, 20);
  loads.force = Eigen::MatrixXd::Constant(401, 1, 1e4);
  SolverOptions options;
  options.degree = 3;
  options.double_precision = true;
  const GroundMotion motion = WaveSolver(site, loads, options).run();
  const auto largest = [&](double from, double to) {
    double v = 0;
    for (Eigen::Index i = 0; i < motion.time.size(); ++i) {
      if (motion.time(i) < from || motion.time(i) >= to) continue;
      for (const Eigen::MatrixXd* component : {&motion.vx, &motion.vy, &motion.vz})
        v = std::max(v, component->row(i).cwiseAbs().maxCoeff());
    }
    return v;
  };
  const double deflection = motion.footprint_displacement(motion.time.size() - 1, 0);
  const double first = largest(10, 15), second = largest(15, 20);
  // A sum of some hundred forces, each rounded at 1e-16 of its size, moves a node by 1e-14 of the deflection in a step of 1 ms.
  const double rounding = 1e-11 * deflection;
  std::printf("velocity per deflection [1/s]: 1..5 s %.2e, 5..10 s %.2e, 10..15 s %.2e, 15..20 s %.2e\n",
              largest(1, 5) / deflection, largest(5, 10) / deflection, first / deflection,
              second / deflection);
  EXPECT_LE(second, std::max(first, rounding));
  test::record_verification("growth-damped", second / std::max(first, rounding));
  EXPECT_LT(second, 1e-3 * deflection);
}

}  // namespace
}  // namespace easydyn::soil

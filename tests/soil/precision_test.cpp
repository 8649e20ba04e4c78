#include <gtest/gtest.h>

#include <algorithm>

#include "soil/wave_solver.hpp"
#include "tests/soil/layered_comparison.hpp"
#include "tests/soil/verification_record.hpp"

namespace easydyn::soil {
namespace {

TEST(SinglePrecision, ChangesNoRecordByMoreThanATenthOfAPercent) {
  // 5 m of cs 150 m/s on 300 m/s, damping 3 %, pulse of 12 Hz; all components at 5 to 20 m, L2 over the whole record.
  Site site;
  site.layers = {test::damped_layer(5, 150), test::damped_layer(0, 300)};
  site.highest_frequency = 30;
  site.damping_frequency = 12;
  site.duration = 0.6;
  for (const double r : {5.0, 10.0, 20.0}) site.receivers.push_back({"r", {0.8 * r, 0.6 * r, 0}});
  SurfaceLoads loads;
  loads.footprints = {{0, 0, 1, 1}};
  loads.time = Eigen::VectorXd::LinSpaced(501, 0, 0.5);
  loads.force = 1e4 * loads.time.unaryExpr(test::Ricker{12, 1.3 / 12});
  SolverOptions options;
  options.quarter_model = true;
  options.output_step = 2e-3;  // with it, both take the same time step
  WaveSolver single_solver(site, loads, options);
  options.double_precision = true;
  WaveSolver double_solver(site, loads, options);
  ASSERT_EQ(single_solver.time_step(), double_solver.time_step());
  const GroundMotion coarse = single_solver.run(), fine = double_solver.run();
  double worst = 0;
  for (const auto& [a, b] : {std::pair{&coarse.vx, &fine.vx}, {&coarse.vy, &fine.vy}, {&coarse.vz, &fine.vz}})
    for (Eigen::Index r = 0; r < a->cols(); ++r)
      worst = std::max(worst, (a->col(r) - b->col(r)).norm() / b->col(r).norm());
  EXPECT_LT(worst, 1e-3);
  test::record_verification("single-precision", 100 * worst);
}

}  // namespace
}  // namespace easydyn::soil

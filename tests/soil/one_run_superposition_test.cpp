// A row of sleepers from one finite element run, shifted and added, against the layered half-space under all of them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "soil/layered/layered_prediction.hpp"
#include "soil/prediction.hpp"
#include "tests/soil/layered_comparison.hpp"
#include "tests/soil/verification_record.hpp"

namespace easydyn::soil {
namespace {

TEST(OneRun, GivesTheMotionUnderAllSleepers) {
  // Eleven sleepers every 0.6 m, a pulse that passes over them at 60 m/s: 10 ms, five output steps, from one to the next.
  constexpr int sleepers = 11, middle = 5, delay = 5;
  constexpr double spacing = 0.6, step = 2e-3;
  Site site;
  site.layers = {test::damped_layer(3, 150), test::damped_layer(0, 300)};
  site.highest_frequency = 40;
  site.damping_frequency = 16;
  site.taper_length = 0;
  site.margin = 6;
  site.duration = 0.6;
  const std::vector<Receiver> places{{"4 m", {1, 4, 0}}, {"8 m", {1, 8, 0}}, {"16 m", {-2, 16, 0}}};
  const auto samples = static_cast<Eigen::Index>(std::lround(site.duration / step)) + 1;
  const Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(samples, 0, site.duration);
  const auto pulse = [&](int sleeper) {
    return (1e4 * time.unaryExpr(test::Ricker{16, 1.3 / 16 + sleeper * delay * step})).eval();
  };

  // One run: the first sleeper's pulse at the origin, receivers at all distances.
  Site one = site;
  for (const Receiver& place : places)
    for (int j = 0; j < sleepers; ++j)
      one.receivers.push_back({"r", {place.position[0] - spacing * (j - middle), place.position[1], 0}});
  SurfaceLoads load;
  load.footprints = {{0, 0, 0.285, 2.5}};
  load.time = time;
  load.force = pulse(0);
  SolverOptions options;
  options.quarter_model = true;
  options.output_step = step;
  WaveSolver solver = make_solver(one, load, options);
  std::printf("%.2f million dof, %ld steps\n", 1e-6 * static_cast<double>(solver.lattice().dofs()),
              solver.steps());
  const GroundMotion response = solver.run();
  Vibrations sum;
  sum.time = response.time;
  sum.receivers = places;
  const auto add = [&](const Eigen::MatrixXd& from, Eigen::MatrixXd& to) {
    to = Eigen::MatrixXd::Zero(samples, 3);
    for (Eigen::Index r = 0; r < 3; ++r)
      for (int j = 0; j < sleepers; ++j)
        to.col(r).tail(samples - delay * j) += from.col(sleepers * r + j).head(samples - delay * j);
  };
  ASSERT_EQ(response.time.size(), samples);
  add(response.vx, sum.vx);
  add(response.vy, sum.vy);
  add(response.vz, sum.vz);

  site.receivers = places;
  SurfaceLoads row;
  row.time = time;
  row.force.resize(samples, sleepers);
  for (int j = 0; j < sleepers; ++j) {
    row.footprints.push_back({spacing * (j - middle), 0, 0.285, 2.5});
    row.force.col(j) = pulse(j);
  }
  sum.semi_analytical = compute_semi_analytical_motion(site, row, GroundDamping::maxwell_body);
  double worst = 0;
  for (const MotionDifference& d : compare_with_semi_analytical(sum)) {
    std::printf("%s: L2 of v_x, v_y, v_z: %.4f %.4f %.4f\n", d.receiver.c_str(), d.l2[0], d.l2[1], d.l2[2]);
    for (const double l2 : d.l2) {
      EXPECT_LT(l2, 0.03) << d.receiver;
      worst = std::max(worst, l2);
    }
  }
  test::record_verification("one-run-superposition", 100 * worst);
}

}  // namespace
}  // namespace easydyn::soil

// The time error of the leapfrog, taken away.

#include "soil/time_error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "easydyn/error.hpp"
#include "soil/load_history.hpp"
#include "soil/wave_solver.hpp"
#include "tests/soil/small_ground.hpp"
#include "tests/soil/warped_response.hpp"

namespace easydyn::soil {
namespace {

using Eigen::Index;

struct Motion {
  Eigen::VectorXd displacement, velocity;
};

/// u.. + w0^2 u = f by the leapfrog, recorded every `every` steps from time 0 on, at rest until then.
Motion run_leapfrog(double w0, const SurfaceLoads& loads, double dt, Index every, Index rows) {
  const LoadHistory history(loads, 0.1);
  Motion motion{Eigen::VectorXd(rows), Eigen::VectorXd(rows)};
  Eigen::VectorXd force;
  double u = 0, v = 0;  // v half a step earlier
  for (Index i = 0; i < rows * every; ++i) {
    history.update_forces(static_cast<double>(i) * dt, force);
    const double after = v + dt * (force(0) - w0 * w0 * u);
    if (i % every == 0) {
      motion.displacement(i / every) = u;
      motion.velocity(i / every) = (v + after) / 2;
    }
    v = after;
    u += dt * v;
  }
  return motion;
}

// Oscillators ring on to the end of the record: nothing has died out there. The reference is the leapfrog with a step 64 times
// smaller (time error 4000 times smaller). dt w0 = 0.35 at 70 Hz.
TEST(TimeError, OfALeapfrogIsTakenAwayThoughTheMotionGoesOn) {
  const double dt = 0.8e-3, highest = 80;
  SurfaceLoads loads;
  loads.footprints = {{0, 0, 1, 1}};
  loads.time = Eigen::VectorXd::LinSpaced(2001, 0, 2);
  loads.force =
      loads.time.unaryExpr(test::Ricker{32, 0.1}) + 0.5 * loads.time.unaryExpr(test::Ricker{20, 1.6});
  for (const double f0 : {10.0, 40.0, 70.0}) {
    const double w0 = 2 * std::numbers::pi * f0;
    const Motion reference = run_leapfrog(w0, loads, dt / 64, 128, 1200);
    const Motion plain = run_leapfrog(w0, loads, dt, 2, 1200);
    SurfaceLoads given = loads;
    given.force = add_time_error(loads.force, 1e-3, dt, highest);
    Motion corrected = run_leapfrog(w0, given, dt, 2, 1200);
    corrected.displacement =
        remove_time_error(corrected.displacement, 0, 2 * dt, dt, highest, LeapfrogRecord::displacement);
    corrected.velocity =
        remove_time_error(corrected.velocity, 0, 2 * dt, dt, highest, LeapfrogRecord::velocity);
    // But for the last two periods of the highest frequency, 16 rows.
    const auto compare = [](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
      return (a - b).head(a.size() - 16).norm() / b.norm();
    };
    const double before = compare(plain.velocity, reference.velocity),
                 after = compare(corrected.velocity, reference.velocity),
                 after_displacement = compare(corrected.displacement, reference.displacement),
                 end = (corrected.velocity - reference.velocity).tail(16).norm() / reference.velocity.norm();
    std::printf("%2.0f Hz: velocity %.2e -> %.2e, at the end %.2e, displacement -> %.2e\n", f0, before, after,
                end, after_displacement);
    EXPECT_GT(before, 4e-3);
    // The reference keeps 1 / 4096 of it, the end reaches back a little.
    EXPECT_LT(after, 4e-3 * before);
    EXPECT_LT(after_displacement, 4e-3 * before);
    EXPECT_LT(end, 0.5 * before);
  }
}

TEST(TimeError, LeavesWhatIsConstantOrSlow) {
  const Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(2001, 0, 2);
  const Eigen::VectorXd slow = 3 + (0.5 * std::numbers::pi * time.array() / 2).sin();
  EXPECT_LT((add_time_error(slow, 1e-3, 1e-3, 80) - slow).cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_LT(
      (remove_time_error(slow, 0, 1e-3, 1e-3, 80, LeapfrogRecord::displacement) - slow).cwiseAbs().maxCoeff(),
      1e-4);
}

TEST(TimeError, OfARunIsTakenFromItsLoadsAndRecords) {
  const Site site = test::small_site();
  SurfaceLoads loads = test::small_loads();
  SolverOptions options = test::small_options();
  options.double_precision = true;
  options.corrects_time_error = true;
  WaveSolver solver(site, loads, options);
  const GroundMotion motion = solver.run();
  // The same by hand.
  const double dt = solver.time_step(), step = motion.time(1) - motion.time(0), f = site.highest_frequency;
  options.corrects_time_error = false;
  loads.force = add_time_error(loads.force, loads.time(1) - loads.time(0), dt, f);
  const GroundMotion plain = WaveSolver(site, loads, options).run();
  const auto velocity = [&](const Eigen::MatrixXd& records) {
    return remove_time_error(records, 0, step, dt, f, LeapfrogRecord::velocity);
  };
  const double largest = motion.vz.cwiseAbs().maxCoeff();
  EXPECT_LT((motion.vx - velocity(plain.vx)).cwiseAbs().maxCoeff(), 1e-12 * largest);
  EXPECT_LT((motion.vy - velocity(plain.vy)).cwiseAbs().maxCoeff(), 1e-12 * largest);
  EXPECT_LT((motion.vz - velocity(plain.vz)).cwiseAbs().maxCoeff(), 1e-12 * largest);
  EXPECT_GT((motion.vz - plain.vz).cwiseAbs().maxCoeff(), 1e-5 * largest);
  const Eigen::MatrixXd displacement =
      remove_time_error(plain.footprint_displacement, 0, step, dt, f, LeapfrogRecord::displacement);
  EXPECT_LT((motion.footprint_displacement - displacement).cwiseAbs().maxCoeff(),
            1e-12 * displacement.cwiseAbs().maxCoeff());
}

TEST(TimeError, RefusesStepsThatAreNotPositive) {
  const Eigen::VectorXd signal = Eigen::VectorXd::Zero(100);
  EXPECT_THAT([&] { add_time_error(signal, 1e-3, 0, 80); },
              testing::ThrowsMessage<ModelError>(testing::HasSubstr("steps of 0.001 s and 0 s")));
  EXPECT_THAT([&] { add_time_error(signal, 1e-3, 1e-3, 0); },
              testing::ThrowsMessage<ModelError>(testing::HasSubstr("highest frequency = 0 Hz")));
  EXPECT_THAT([&] { remove_time_error(signal.head(1), 0, 1e-3, 1e-3, 80, LeapfrogRecord::velocity); },
              testing::ThrowsMessage<ModelError>(testing::HasSubstr("1 rows")));
}

}  // namespace
}  // namespace easydyn::soil

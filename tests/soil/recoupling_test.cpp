#include "soil/recoupling.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "easydyn/error.hpp"
#include "tests/temporary_folder.hpp"

namespace easydyn::soil {
namespace {

using easydyn::testing::message_of;
using ::testing::HasSubstr;
constexpr double pi = std::numbers::pi;

// Displacement of three footprints: a slow passage and a vibration of 20 Hz, each with its own factor.
Eigen::MatrixXd make_motion(const Eigen::VectorXd& time, double slow, double fast) {
  Eigen::MatrixXd u(time.size(), 3);
  for (Eigen::Index j = 0; j < 3; ++j) {
    const Eigen::ArrayXd t = time.array() - 5 - 0.05 * static_cast<double>(j);
    u.col(j) = 1e-4 * (slow * (-t.square() / 2).exp() +
                       0.2 * fast * (-t.square() / 2).exp() * (2 * pi * 20 * t).sin());
  }
  return u;
}

const Eigen::VectorXd soil_time = Eigen::VectorXd::LinSpaced(5001, 0, 10);
const Eigen::VectorXd track_time = Eigen::VectorXd::LinSpaced(11001, -0.5003, 10.4997);
const Eigen::VectorXd no_taper = Eigen::VectorXd::Ones(3);

TEST(Recoupling, FindsNoErrorBetweenTheSameMotionsOnDifferentTimes) {
  const RecouplingError error = compute_recoupling_error(soil_time, make_motion(soil_time, 1, 1), track_time,
                                                         make_motion(track_time, 1, 1), no_taper, 50);
  EXPECT_LT(error.total.l2, 1e-4);
  EXPECT_LT(error.total.peak, 1e-4);
  EXPECT_LT(error.dynamic.l2, 1e-3);
  EXPECT_EQ(error.footprints, 3);
  EXPECT_NEAR(error.from, 0, 1e-9);
  EXPECT_NEAR(error.to, 10, 1e-9);
}

TEST(Recoupling, SplitsTheErrorIntoQuasiStaticAndDynamic) {
  // The foundation overestimates the passage by 30 % and underestimates the vibration by 10 %.
  const RecouplingError error = compute_recoupling_error(soil_time, make_motion(soil_time, 1, 1), track_time,
                                                         make_motion(track_time, 1.3, 0.9), no_taper, 50);
  EXPECT_NEAR(error.quasi_static.l2, 0.3, 1e-3);
  EXPECT_NEAR(error.quasi_static.peak, 0.3, 1e-3);
  EXPECT_NEAR(error.dynamic.l2, 0.1, 2e-3);
  EXPECT_NEAR(error.dynamic.peak, 0.1, 2e-3);
  // Energies: slow 1, fast 0.2^2 / 2 (the same envelope).
  EXPECT_NEAR(error.total.l2, std::sqrt((0.09 + 0.01 * 0.02) / 1.02), 1e-3);
}

TEST(Recoupling, LeavesOutTaperedFootprints) {
  Eigen::MatrixXd foundation = make_motion(track_time, 1, 1);
  foundation.col(0) *= 5;
  const RecouplingError error = compute_recoupling_error(soil_time, make_motion(soil_time, 1, 1), track_time,
                                                         foundation, Eigen::Vector3d(0.4, 1, 1), 50);
  EXPECT_LT(error.total.l2, 1e-4);
  EXPECT_EQ(error.footprints, 2);
}

TEST(Recoupling, LeavesOutWhatTheSoilModelDoesNotClaim) {
  Eigen::MatrixXd foundation = make_motion(track_time, 1, 1);
  foundation.array().colwise() += 1e-5 * (2 * pi * 120 * track_time.array()).sin();
  const RecouplingError error =
      compute_recoupling_error(soil_time, make_motion(soil_time, 1, 1), track_time, foundation, no_taper, 50);
  EXPECT_LT(error.total.l2, 1e-3);
}

TEST(Recoupling, ComparesTheSharedTimeOnly) {
  const Eigen::VectorXd late = Eigen::VectorXd::LinSpaced(8001, 4, 12);
  const RecouplingError error = compute_recoupling_error(soil_time, make_motion(soil_time, 1, 1), late,
                                                         make_motion(late, 1, 1), no_taper, 50);
  EXPECT_NEAR(error.from, 4, 1e-9);
  EXPECT_NEAR(error.to, 10, 1e-9);
}

TEST(Recoupling, NamesWhatDoesNotFit) {
  const Eigen::MatrixXd soil = make_motion(soil_time, 1, 1), track = make_motion(track_time, 1, 1);
  const auto message = [&](const Eigen::VectorXd& time, const Eigen::MatrixXd& foundation,
                           const Eigen::VectorXd& taper) {
    return message_of<ModelError>(
        [&] { compute_recoupling_error(soil_time, soil, time, foundation, taper, 50); });
  };
  EXPECT_THAT(message(track_time, track.leftCols(2), no_taper),
              HasSubstr("foundation displacement is 11001 x 2, must be 11001 x 3"));
  EXPECT_THAT(message(track_time, track, Eigen::Vector2d(1, 1)),
              HasSubstr("soil displacement is 5001 x 3, must be 5001 x 2"));
  EXPECT_THAT(message(track_time, track, 0.5 * no_taper), HasSubstr("no footprint bears its full load"));
  EXPECT_THAT(message(track_time.array() + 100, track, no_taper), HasSubstr("share no time"));
}

TEST(SlowPart, HasTheSlowSineOnly) {
  const double step = 0.01;
  const Eigen::ArrayXd t = Eigen::ArrayXd::LinSpaced(2000, 0, 19.99);
  const Eigen::MatrixXd slow = (2 * pi * 1 * t).cos().matrix(), fast = (2 * pi * 4 * t).cos().matrix();
  EXPECT_LT((compute_slow_part(slow + fast, step, 2) - slow).norm() / slow.norm(),
            0.02);  // the ends have kinks
}

TEST(Interpolation, IsExactForCubics) {
  const Eigen::VectorXd t = Eigen::VectorXd::LinSpaced(11, 0, 1), at = Eigen::VectorXd::LinSpaced(57, 0, 1);
  const auto cubic = [](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    return 1 + 2 * x.array() - 3 * x.array().square() + 4 * x.array().cube();
  };
  EXPECT_NEAR((interpolate(t, cubic(t), at) - cubic(at)).norm(), 0, 1e-12);
}

}  // namespace
}  // namespace easydyn::soil

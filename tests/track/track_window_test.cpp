#include "track/track_window.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "track/track_data.hpp"

namespace easydyn::track {
namespace {

PortShape shape_at(const TrackModel& model, double x) {
  const RailPoint point = model.rail_point(x);
  PortShape shape;
  for (std::size_t i = 0; i < 4; ++i)
    shape.add(point.dof[i], point.shape.N[static_cast<Eigen::Index>(i)],
              point.shape.dN[static_cast<Eigen::Index>(i)]);
  return shape;
}

Eigen::VectorXd dense(const PortShape& shape, int size, bool slope = false) {
  Eigen::VectorXd N = Eigen::VectorXd::Zero(size);
  for (std::size_t k = 0; k < static_cast<std::size_t>(shape.count); ++k)
    N[shape.index[k]] = slope ? shape.gradient[k] : shape.value[k];
  return N;
}

TEST(TrackWindow, HasTheColumnsOfTheInverseEverywhere) {
  for (const Foundation& foundation : {Foundation(RigidGround{}), thalys_like_track().foundation}) {
    TrackData data = thalys_like_track();
    data.foundation = foundation;
    data.ends.bays = 5;
    const double h = 2e-4;
    const TrackModel model(data, 120, -36);
    const Eigen::MatrixXd A = model.M() + 0.5 * h * model.C() + 0.25 * h * h * model.K();
    const Eigen::PartialPivLU<Eigen::MatrixXd> lu(A);
    TrackWindow window(model, 0, h);
    for (double x = -35.9; x < 36; x += 1.73) {
      const PortShape of = shape_at(model, x);
      const Eigen::VectorXd y = lu.solve(dense(of, model.size()));
      const double scale = dense(of, model.size()).dot(y);
      for (const double distance : {-8.0, -3.0, -0.4, 0.0, 0.1, 3.0, 14.0}) {
        if (std::abs(x + distance) > 36) continue;
        const PortShape at = shape_at(model, x + distance);
        const TrackWindow::Response r = window.response(at, of);
        EXPECT_NEAR(r.acceleration / scale, dense(at, model.size()).dot(y) / scale, 1e-11)
            << x << " " << distance;
        EXPECT_NEAR(r.slope / scale, dense(at, model.size(), true).dot(y) / scale, 1e-10)
            << x << " " << distance;
      }
    }
  }
}

}  // namespace
}  // namespace easydyn::track

#include "easydyn/sim/state_space.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "easydyn/easydyn.hpp"

namespace easydyn {
namespace {

/// A motor on a shaft with a spring: L i. = u - R i - k w,  J w. = k i - c a - torque.
class Motor : public System {
 public:
  Coordinate angle = coordinate("angle");
  FirstOrderState current = first_order_state("current");
  Input voltage = input("voltage"), torque = input("torque");
  Body& wheel = body("wheel", Inertia(1, 1, 1, J));
  static constexpr double L = 0.05, R = 0.8, k = 0.3, J = 0.02, c = 4;

 protected:
  void positions() override { wheel = rotate_z(angle); }
  void forces() override {
    current.set_rate((voltage.value() - R * current.value() - k * angle.rate()) / L);
    wheel.add_moment({0, 0, k * current.value() - c * angle.value() - torque.value()});
  }
};

TEST(StateSpace, HoldsCoordinatesFirstOrderStatesAndInputs) {
  Motor motor;
  const StateSpace space = linearize_state_space(motor, motor.initial_state());
  Eigen::Matrix3d A;
  A << 0, 1, 0, -Motor::c / Motor::J, 0, Motor::k / Motor::J, 0, -Motor::k / Motor::L, -Motor::R / Motor::L;
  Eigen::Matrix<double, 3, 2> B;
  B << 0, 0, 0, -1 / Motor::J, 1 / Motor::L, 0;
  EXPECT_LT((space.A - A).norm(), 1e-9 * A.norm());
  EXPECT_LT((space.B - B).norm(), 1e-9 * B.norm());
  EXPECT_EQ(space.coordinates, 1);
  EXPECT_EQ(motor.voltage.value(), 0);
}

TEST(FrequencyResponse, IsThatOfTheClosedForm) {
  Motor motor;
  const StateSpace space = linearize_state_space(motor, motor.initial_state());
  const Eigen::Vector3d f(0, 1.5, 40);
  const auto H = compute_frequency_response(space, f);
  for (int i = 0; i < 3; ++i) {
    // angle / voltage = k / ((L s + R)(J s^2 + c) + k^2 s)
    const std::complex<double> s(0, 2 * M_PI * f[i]);
    const std::complex<double> expected =
        Motor::k / ((Motor::L * s + Motor::R) * (Motor::J * s * s + Motor::c) + Motor::k * Motor::k * s);
    EXPECT_LT(std::abs(H[static_cast<std::size_t>(i)](0, 0) - expected), 1e-9 * std::abs(expected));
  }
}

TEST(FrequencyResponse, RefusesTheFrequencyOfAnUndampedMode) {
  const StateSpace oscillator{Eigen::Matrix2d{{0, 1}, {-4 * M_PI * M_PI, 0}}, Eigen::Vector2d(0, 1), 1};
  EXPECT_THROW(compute_frequency_response(oscillator, Eigen::VectorXd::Constant(1, 1.0)), SolverError);
  EXPECT_THROW(compute_frequency_response(oscillator, Eigen::VectorXd::Constant(1, -1.0)), ModelError);
}

}  // namespace
}  // namespace easydyn

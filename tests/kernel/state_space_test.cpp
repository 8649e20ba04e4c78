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

TEST(Linearization, HasTheForcesOfItsInputs) {
  Motor motor;
  const Linearization lin = linearize(motor, motor.initial_state());
  ASSERT_EQ(lin.B.cols(), 2);
  EXPECT_NEAR(lin.B(0, 0), 0, 1e-12);   // the voltage acts through the current, which is constant here
  EXPECT_NEAR(lin.B(0, 1), -1, 1e-10);  // the torque against the angle
  EXPECT_EQ(motor.torque.value(), 0);
}

TEST(StateSpace, GivesTheModesOfCoordinatesAndFirstOrderStatesTogether) {
  Motor motor;
  const StateSpace space = linearize_state_space(motor, motor.initial_state());
  const std::vector<Mode> modes = compute_modes(space);
  // (L s + R)(J s^2 + c) + k^2 s = 0: one real pole (electrical), one pair (the spring, damped by the current)
  ASSERT_EQ(modes.size(), 2u);
  for (const Mode& m : modes) {
    const std::complex<double> s = m.pole;
    EXPECT_LT(std::abs((Motor::L * s + Motor::R) * (Motor::J * s * s + Motor::c) + Motor::k * Motor::k * s),
              1e-8 * Motor::R * Motor::c);
    EXPECT_NEAR(std::abs(m.shape[0]), 1, 1e-12);
  }
}

TEST(StateSpace, GivesModesWhateverTheUnitsOfItsStates) {
  // A mass on two oil chambers, pressures in pascal: w^2 = sum of a_i b_i; entries from 1e-7 to 1e9.
  StateSpace space;
  space.coordinates = 1;
  space.A =
      Eigen::MatrixXd{{0, 1, 0, 0}, {0, 0, 2.655e-7, -1.848e-7}, {0, -1.1377e9, 0, 0}, {0, 2.8073e9, 0, 0}};
  const double w = std::sqrt(2.655e-7 * 1.1377e9 + 1.848e-7 * 2.8073e9);
  EXPECT_NEAR(compute_modes(space).back().frequency, w / (2 * M_PI), 1e-12 * w);
}

TEST(StateSpace, SeesItsOutputs) {
  class Sensor : public Motor {
   public:
    Output speed = output("speed"), power = output("power");

   protected:
    void forces() override {
      Motor::forces();
      speed.set(3 * angle.rate());
      power.set(2 * voltage.value() + 5 * current.value() + angle.value());
    }
  } motor;
  const StateSpace space = linearize_state_space(motor, motor.initial_state());
  EXPECT_LT((space.C - Eigen::MatrixXd{{0, 3, 0}, {1, 0, 5}}).norm(), 1e-10);
  EXPECT_LT((space.D - Eigen::MatrixXd{{0, 0}, {2, 0}}).norm(), 1e-10);
  EXPECT_EQ(motor.output_name(1), "power");
  EXPECT_THROW(motor.speed.set(1), ModelError);
}

TEST(Coordinate, TakesAGeneralisedForceOfTheUsers) {
  class Slider : public System {
   public:
    Coordinate x = coordinate("x", 0.2), y = coordinate("y");
    Body& mass = body("mass", 2.0);

   protected:
    void positions() override { mass = translate(x, y, 0); }
    void forces() override {
      x.add_force(-50 * x.value());
      y.add_force(7);
    }
  } slider;
  const State s = slider.initial_state();
  EXPECT_NEAR(slider.compute_residual(s)[0], 10, 1e-13);
  Eigen::MatrixXd M(2, 2);
  Eigen::VectorXd bias(2);
  slider.compute_mass_and_bias(s, M, bias);
  EXPECT_NEAR(bias[0], 10, 1e-13);
  EXPECT_NEAR(bias[1], -7, 1e-13);
  slider.y.lock(0);  // its force goes to what holds it
  slider.evaluate(slider.initial_state());
  EXPECT_NEAR(slider.holding_force(slider.y), -7, 1e-13);
  EXPECT_THROW(slider.x.add_force(1), ModelError);
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

TEST(FrequencyResponse, IsFoundWhateverTheUnitsOfTheStates) {
  StateSpace space;
  space.coordinates = 1;
  space.A = Eigen::MatrixXd{{0, 1, 0, 0}, {-3, -0.1, 7e-6, -7e-6}, {0, -1.4e11, -20, 0}, {0, 1.4e11, 0, -20}};
  space.B = Eigen::MatrixXd{{0}, {0}, {1e8}, {0}};
  const auto H = compute_frequency_response(space, Eigen::VectorXd::Constant(1, 0.01));
  const std::complex<double> s(0, 0.02 * M_PI);
  const Eigen::MatrixXcd y = H[0];
  const Eigen::MatrixXcd r = s * y - space.A * y - space.B.cast<std::complex<double>>();
  EXPECT_LT(std::abs(r(1, 0)), 1e-9 * std::abs(7e-6 * y(2, 0)));
  EXPECT_LT(std::abs(r(2, 0)), 1e-9 * 1e8);
}

TEST(FrequencyResponse, RefusesTheFrequencyOfAnUndampedMode) {
  const StateSpace oscillator{.A = Eigen::Matrix2d{{0, 1}, {-4 * M_PI * M_PI, 0}},
                              .B = Eigen::Vector2d(0, 1),
                              .C = Eigen::MatrixXd(0, 2),
                              .D = Eigen::MatrixXd(0, 1),
                              .coordinates = 1};
  EXPECT_THROW(compute_frequency_response(oscillator, Eigen::VectorXd::Constant(1, 1.0)), SolverError);
  EXPECT_THROW(compute_frequency_response(oscillator, Eigen::VectorXd::Constant(1, -1.0)), ModelError);
}

}  // namespace
}  // namespace easydyn

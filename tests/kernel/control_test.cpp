#include <gtest/gtest.h>

#include <complex>

#include "easydyn/easydyn.hpp"

using namespace easydyn;

namespace {

// Sum of the energies less what came in and went out, largest change over a run, relative to what went in.
double imbalance(System& system, double t_end, double tolerance) {
  Cvode integrator(system,
                   {.relative_tolerance = tolerance, .absolute_tolerance = tolerance, .max_step = 2e-3});
  EnergyBalance before = system.compute_energy(integrator.state());
  const double E0 = before.kinetic + before.potential;
  double t = 0, work = 0, turnover = 0, worst = 0;
  integrator.advance(t_end, [&](const State& s) {
    // Simpson's rule with the middle of the step from the dense output
    const EnergyBalance middle = system.compute_energy(integrator.interpolate(0.5 * (t + s.t)));
    const EnergyBalance now = system.compute_energy(s);
    const auto power = [](const EnergyBalance& e) { return e.supplied - e.dissipated; };
    const double h = s.t - t;
    work += h / 6 * (power(before) + 4 * power(middle) + power(now));
    turnover += h * (std::abs(now.supplied) + now.dissipated);
    worst = std::max(worst, std::abs(now.kinetic + now.potential - E0 - work));
    before = now;
    t = s.t;
  });
  return worst / turnover;
}

// --- PID -------------------------------------------------------------------------------------------------

class ServoMass : public System {
 public:
  static constexpr double m = 2;
  Coordinate x = coordinate("x");
  Body& mass = body("mass", m);
  Pid pid;
  double goal = 0, load = 0;
  explicit ServoMass(const Pid::Data& data) : pid(*this, "servo", data) {}

 protected:
  void positions() override { mass = translate(x, 0, 0); }
  void forces() override { mass.add_force({pid.compute(goal - x.value()) + load, 0, 0}, mass.position()); }
};

TEST(Pid, ClosesTheLoopWithTheTransferFunctionItClaims) {
  const Pid::Data data{.proportional = 80, .integral = 60, .derivative = 12, .filter_time = 0.02};
  ServoMass servo(data);
  const auto modes = compute_modes(linearize_state_space(servo, servo.initial_state()));
  // m s^2 + K_p + K_i / s + K_d s / (1 + T s) = 0
  ASSERT_GE(modes.size(), 2u);
  for (const Mode& mode : modes) {
    const std::complex<double> s = mode.pole;
    const std::complex<double> value = ServoMass::m * s * s + data.proportional + data.integral / s +
                                       data.derivative * s / (1.0 + data.filter_time * s);
    EXPECT_LT(std::abs(value), 1e-6 * std::abs(ServoMass::m * s * s)) << s;
    EXPECT_LT(s.real(), 0);
  }
}

TEST(Pid, LeavesNoErrorUnderAConstantLoad) {
  ServoMass servo({.proportional = 80, .integral = 60, .derivative = 25, .filter_time = 0.02});
  servo.goal = 0.5;
  servo.load = -30;
  Cvode integrator(servo, {.relative_tolerance = 1e-8, .absolute_tolerance = 1e-10});
  integrator.advance(25);
  EXPECT_NEAR(integrator.state().q[0], 0.5, 1e-6);
  EXPECT_NEAR(servo.pid.value(), 30, 1e-4);
}

TEST(Pid, StaysWithinItsLimitsAndDoesNotWindUp) {
  const auto overshoot = [](double tracking_time) {
    ServoMass servo({.proportional = 40,
                     .integral = 30,
                     .derivative = 25,
                     .filter_time = 0.02,
                     .lower = -5,
                     .upper = 5,
                     .tracking_time = tracking_time});
    servo.goal = 4;
    RungeKutta integrator(servo, {.relative_tolerance = 1e-7, .absolute_tolerance = 1e-9, .max_step = 0.01});
    double highest = 0;
    integrator.advance(20, [&](const State& s) {
      highest = std::max(highest, s.q[0]);
      EXPECT_LE(std::abs(servo.pid.value()), 5);
    });
    return highest - 4;
  };
  EXPECT_LT(overshoot(0.5), 0.3 * overshoot(1e6));  // 1e6 s: the integral runs away
}

TEST(Pid, RefusesImpossibleData) {
  EXPECT_THROW(ServoMass({.derivative = 1}), ModelError);  // no filter
  EXPECT_THROW(ServoMass({.integral = 1, .lower = 1, .upper = 0, .tracking_time = 1}), ModelError);
  EXPECT_THROW(ServoMass({.integral = 1, .upper = 1}), ModelError);
  EXPECT_THROW(ServoMass({.proportional = std::nan("")}), ModelError);
}

// --- DC motor --------------------------------------------------------------------------------------------

class MotorAndWheel : public System {
 public:
  static constexpr double J = 0.02, R = 0.8, L = 0.01, k = 0.25, n = 3, d = 0.05;
  Coordinate a = coordinate("a");
  Body& wheel = body("wheel", Inertia(1, J));
  DcMotor motor{*this, "motor", {.resistance = R, .inductance = L, .constant = k, .gear_ratio = n}};
  TorsionalSpringDamper bearing{"bearing", 0, d};
  double voltage = 12;

 protected:
  void positions() override { wheel = rotate_z(a); }
  void forces() override {
    motor.apply({}, wheel, {0, 0, 1}, voltage);
    bearing.apply({}, wheel, {0, 0, 1}, 0);
  }
};

TEST(DcMotor, RunsUpAsItsTwoPolesSay) {
  MotorAndWheel m;
  using M = MotorAndWheel;
  Cvode integrator(m, {.relative_tolerance = 1e-9, .absolute_tolerance = 1e-11});
  // J w. = n k i - d w, L i. = u - R i - n k w from rest: w = w_inf (1 + (s2 e^(s1 t) - s1 e^(s2 t)) / (s1 - s2))
  const double kn = M::k * M::n, w_inf = kn * 12 / (M::R * M::d + kn * kn);
  const double p = M::R / M::L + M::d / M::J, c = (M::R * M::d + kn * kn) / (M::L * M::J);
  const std::complex<double> root = std::sqrt(std::complex<double>(p * p / 4 - c)), s1 = -p / 2 + root,
                             s2 = -p / 2 - root;
  for (double t : {0.005, 0.02, 0.1, 1.0}) {
    integrator.advance(t);
    const double w = w_inf * (1.0 + (s2 * std::exp(s1 * t) - s1 * std::exp(s2 * t)) / (s1 - s2)).real();
    EXPECT_NEAR(integrator.state().qd[0], w, 1e-6 * w_inf);
  }
}

TEST(DcMotor, BalancesItsEnergy) {
  MotorAndWheel m;
  EXPECT_LT(imbalance(m, 0.5, 1e-9), 1e-6);
}

TEST(DcMotor, BrakesAsAGenerator) {
  MotorAndWheel m;
  m.voltage = 0;  // short circuit
  State s = m.initial_state();
  s.qd[0] = 10;
  RungeKutta integrator(m, s, {.relative_tolerance = 1e-8, .absolute_tolerance = 1e-10});
  integrator.advance(0.05);
  EXPECT_LT(m.motor.moment(), 0);
  EXPECT_LT(integrator.state().x[0], 0);
}

// --- hydraulic jack --------------------------------------------------------------------------------------

HydraulicJack::Data symmetric_jack() {
  return {.area_1 = 2e-3,
          .area_2 = 2e-3,
          .shortest = 0.5,
          .longest = 1.1,
          .dead_volume = 1e-4,
          .bulk_modulus = 1.2e9,
          .supply_pressure = 2e7,
          .rated_flow = 1e-3,
          .rated_pressure_drop = 35e5,
          .pressure_1 = 5e6,
          .pressure_2 = 5e6};
}

class Lift : public System {
 public:
  static constexpr double m = 300;
  Coordinate x = coordinate("x");
  Body& mass = body("mass", m);
  HydraulicJack jack;
  double opening = 0, friction = 0;
  explicit Lift(const HydraulicJack::Data& data) : jack(*this, "jack", data) {}

 protected:
  void positions() override { mass = translate(0.8 + x, 0, 0); }
  void forces() override {
    jack.apply({}, {0, 0, 0}, mass, {0, 0, 0}, opening);
    x.add_force(-friction * x.rate());
    energy().dissipated += friction * x.rate() * x.rate();
  }
};

TEST(HydraulicJack, WithAClosedValveIsTheSpringOfItsOil) {
  Lift lift(symmetric_jack());
  const auto modes = compute_modes(linearize_state_space(lift, lift.initial_state(), 1e-5));
  // In the middle: k = 2 beta A^2 / V, V = 1e-4 + 2e-3 * 0.3 (Merritt 1967, eq. 6-33)
  const double V = 1e-4 + 2e-3 * 0.3, k = 2 * 1.2e9 * 2e-3 * 2e-3 / V;
  const double f = std::sqrt(k / Lift::m) / (2 * M_PI);
  EXPECT_NEAR(modes.back().frequency, f, 1e-6 * f);
}

TEST(HydraulicJack, MovesAtTheSpeedOfItsValve) {
  Lift lift(symmetric_jack());
  lift.opening = 0.1;
  lift.friction = 2e4;
  Cvode integrator(lift, {.relative_tolerance = 1e-8, .absolute_tolerance = 1e-8});
  integrator.advance(1.0);
  // Both edges carry A v: p_s - p_1 = p_2 = p_r (A v / y Q_r)^2 and (p_1 - p_2) A = d v
  const double A = 2e-3, v = integrator.state().qd[0];
  const double edge = 35e5 * std::pow(A * v / (0.1 * 1e-3), 2);
  EXPECT_NEAR((2e7 - 2 * edge) * A, 2e4 * v, 1e-4 * 2e4 * v);
  EXPECT_NEAR(lift.jack.force(), 2e4 * v, 1e-4 * 2e4 * v);
  EXPECT_NEAR(integrator.state().x[1], edge, 1e-4 * edge);
}

TEST(HydraulicJack, BalancesItsEnergy) {
  HydraulicJack::Data data = symmetric_jack();
  data.area_2 = 1.2e-3;
  data.leakage = 1e-12;
  data.tank_pressure = 3e5;
  Lift lift(data);
  lift.friction = 1e4;
  lift.opening = -0.1;
  EXPECT_LT(imbalance(lift, 0.5, 1e-9), 1e-5);
  lift.opening = 0.1;
  EXPECT_LT(imbalance(lift, 0.5, 1e-9), 1e-5);
}

TEST(HydraulicJack, RefusesWhatCannotBe) {
  HydraulicJack::Data data = symmetric_jack();
  data.area_1 = 0;
  EXPECT_THROW(Lift lift(data), ModelError);
  Lift lift(symmetric_jack());
  lift.opening = 1.2;
  EXPECT_THROW(lift.evaluate(lift.initial_state()), ModelError);
  lift.opening = 0;
  State s = lift.initial_state();
  s.q[0] = 0.4;
  EXPECT_THROW(lift.evaluate(s), ModelError);
}

}  // namespace

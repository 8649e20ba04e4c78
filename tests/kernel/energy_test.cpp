#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <functional>

#include "easydyn/easydyn.hpp"

using namespace easydyn;
using Eigen::VectorXd;

namespace {

// Double pendulum in space: the second rod turns about an axis across the first one.
class SpatialDoublePendulum : public System {
 public:
  Coordinate a = coordinate("a", 1.0), b = coordinate("b", 0.8);
  Body& rod1 = body("rod 1", Inertia::box(3, 0.1, 0.05, 1.0));
  Body& rod2 = body("rod 2", Inertia::box(2, 0.05, 0.1, 0.8));
  void positions() override {
    const Frame arm = rotate_y(a);
    rod1 = arm * translate(0, 0, -0.5);
    rod2 = arm * translate(0, 0, -1.0) * rotate({1, 0, 0.4}, b) * translate(0, 0, -0.4);
  }
  void forces() override { gravity(); }
};

double total_energy(System& system, const State& s) {
  const EnergyBalance e = system.compute_energy(s);
  return e.kinetic + e.potential;
}

// Classical Runge-Kutta of order four on qdd = -M^-1 (h - Q).
void runge_kutta_step(System& system, State& s, double h) {
  const auto acceleration = [&](const VectorXd& q, const VectorXd& qd) -> VectorXd {
    State x = s;
    x.q = q;
    x.qd = qd;
    return -system.compute_mass_matrix(x).ldlt().solve(system.compute_bias(x));
  };
  const VectorXd a1 = acceleration(s.q, s.qd);
  const VectorXd v2 = s.qd + h / 2 * a1, a2 = acceleration(s.q + h / 2 * s.qd, v2);
  const VectorXd v3 = s.qd + h / 2 * a2, a3 = acceleration(s.q + h / 2 * v2, v3);
  const VectorXd v4 = s.qd + h * a3, a4 = acceleration(s.q + h * v3, v4);
  s.q += h / 6 * (s.qd + 2 * v2 + 2 * v3 + v4);
  s.qd += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  s.t += h;
}

TEST(SpatialDoublePendulum, ConservesEnergyToEightDigitsOverTenSeconds) {
  SpatialDoublePendulum system;
  State s = system.initial_state();
  const double E0 = total_energy(system, s);
  const double scale = 5 * 9.81;  // largest kinetic energy, about m g l
  double drift = 0;
  for (int i = 0; i < 10000; ++i) {
    runge_kutta_step(system, s, 1e-3);
    drift = std::max(drift, std::abs(total_energy(system, s) - E0) / scale);
  }
  EXPECT_LT(drift, 1e-8);
  EXPECT_GT(s.qd.norm(), 0.1);  // it moved
}

TEST(SpatialDoublePendulum, LosesEnergyWithNewmarkAtSecondOrder) {
  const auto drift = [](double h) {
    SpatialDoublePendulum system;
    Newmark integrator(system, {.step = h});
    const double E0 = total_energy(system, integrator.state());
    double largest = 0;
    integrator.advance(2.0, [&](const State& s) {
      largest = std::max(largest, std::abs(total_energy(system, s) - E0) / (5 * 9.81));
    });
    return largest;
  };
  const double coarse = drift(2e-3), fine = drift(1e-3), finer = drift(5e-4);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.1);
  EXPECT_NEAR(std::log2(fine / finer), 2.0, 0.05);
  EXPECT_LT(finer, 1e-4);
}

// A driven, damped oscillator on a moving support: what the drive supplies is stored or turned into heat.
class DrivenOscillator : public System {
 public:
  Coordinate x = coordinate("x");
  Body& mass = body("mass", 2.0);
  SpringDamper spring{"spring", 500, 6, 0.4};
  Frame support;
  void positions() override {
    support = translate(0, 0, 0.1 * sin(9 * time()));
    mass = translate(0, 0, -0.5 + x);
  }
  void forces() override {
    gravity();
    spring.apply(support, {0, 0, 0}, mass, {0, 0, 0});
  }
};

TEST(EnergyBalance, ClosesForADrivenDampedSystemAtSecondOrder) {
  const auto imbalance = [](double h) {
    DrivenOscillator system;
    Newmark integrator(system, {.step = h});
    EnergyBalance before = system.compute_energy(integrator.state());
    const double E0 = before.kinetic + before.potential;
    double work = 0, turnover = 0, worst = 0;
    integrator.advance(3.0, [&](const State& s) {
      const EnergyBalance now = system.compute_energy(s);
      work += 0.5 * h * (before.supplied - before.dissipated + now.supplied - now.dissipated);
      turnover += h * (std::abs(now.supplied) + now.dissipated);
      worst = std::max(worst, std::abs(now.kinetic + now.potential - E0 - work));
      before = now;
    });
    return worst / turnover;
  };
  const double coarse = imbalance(1e-3), fine = imbalance(5e-4);
  EXPECT_LT(coarse, 1e-5);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.1);
}

// Heavy symmetric top in steady precession: with nutation angle theta and spin w3 about the symmetry axis,
// the slow precession rate solves  J1 W^2 cos(theta) - J3 w3 W + m g l = 0.
TEST(HeavyTop, PrecessesSteadily) {
  class Top : public System {
   public:
    Coordinate precession = coordinate("precession"), nutation = coordinate("nutation"),
               spin = coordinate("spin");
    Body& top = body("top", Inertia(2.0, 0.01, 0.01, 0.008));
    void positions() override {
      top = rotate_z(precession) * rotate_x(nutation) * rotate_z(spin) * translate(0, 0, 0.15);
    }
    void forces() override { gravity(); }
  } system;
  const double theta = 0.6, w3 = 120, m = 2, l = 0.15, J1 = 0.01 + m * l * l, J3 = 0.008, g = 9.81;
  const double b = J3 * w3,
               W = (b - std::sqrt(b * b - 4 * J1 * std::cos(theta) * m * g * l)) / (2 * J1 * std::cos(theta));
  State s = system.initial_state();
  s.q[1] = theta;
  s.qd << W, 0, w3 - W * std::cos(theta);
  set_consistent_accelerations(system, s);
  EXPECT_LT(s.qdd.norm(), 1e-10);
  for (int i = 0; i < 1000; ++i) runge_kutta_step(system, s, 5e-4);
  EXPECT_NEAR(s.q[1], theta, 1e-9);
  EXPECT_NEAR(s.q[0], W * 0.5, 1e-9);
}

TEST(Recorder, DrawsNoCurveForRoundingInTheSuppliedEnergy) {
  class Driven : public System {
   public:
    explicit Driven(double power) : power_(power) {}
    Coordinate x = coordinate("x", 0, 1);
    Body& block = body("block", 2.0);
    void positions() override { block = translate(x, 0, 0); }
    void forces() override { energy().supplied += power_; }

   private:
    double power_;
  };
  const auto curves = [](double power) {
    Driven driven(power);
    Newmark newmark(driven, {.step = 0.1});
    Recorder recorder(driven, 0.1);
    recorder(newmark.state());
    newmark.advance(1, std::ref(recorder));
    return recorder.energy_chart().series.size();
  };
  EXPECT_EQ(curves(1e-14), 3u);  // kinetic, potential, balance; 1e-14 J beside 1 J
  EXPECT_EQ(curves(1e-3), 4u);
}

}  // namespace

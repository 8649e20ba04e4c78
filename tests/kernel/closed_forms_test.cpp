// Motions with a closed form: pendulum and heavy top by elliptic functions, the rolling disc.

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "easydyn/easydyn.hpp"
#include "tests/reference/elliptic.hpp"

namespace easydyn {
namespace {

using Eigen::Vector3d;

const AdaptiveOptions tight{.relative_tolerance = 1e-12, .absolute_tolerance = 1e-13};

class Pendulum : public System {
 public:
  Pendulum(double angle, double rate) : a(coordinate("a", angle, rate)) {}
  Coordinate a;
  Body& bob = body("bob", 1.0);

 protected:
  void positions() override { bob = rotate_y(a) * translate(0, 0, -1); }
  void forces() override { gravity(); }
};

TEST(EllipticPendulum, SwingsAsJacobisFunctionsSay) {
  const double w = std::sqrt(9.81);
  for (const double degrees : {90.0, 179.0}) {
    // Released at rest: sin(a / 2) = k cn(w t) / dn(w t), k the sine of half the amplitude.
    const double amplitude = degrees * M_PI / 180, k = std::sin(amplitude / 2), k1 = std::cos(amplitude / 2);
    const double period = 4 * reference::complete_elliptic_integral(k1) / w;
    Pendulum pendulum(amplitude, 0);
    RungeKutta integrator(pendulum, tight);
    double worst = 0;
    for (int i = 1; i <= 60; ++i) {  // two periods
      const double t = period * i / 30;
      integrator.advance(t);
      const double phi = reference::jacobi_amplitude(w * t, k, k1);
      const double sine = k * std::cos(phi) / std::hypot(k1, k * std::cos(phi));  // dn^2 = k'^2 + k^2 cn^2
      worst = std::max(worst, std::abs(integrator.state().q[0] - 2 * std::asin(sine)));
    }
    // At 179 deg the energy lacks 1.5e-3 J of the top: an error of 1e-12 J shifts each of the four passages by some
    // 1e-9 s (measured 2e-8 rad).
    EXPECT_LT(worst, degrees > 100 ? 1e-7 : 1e-10) << degrees;
  }
}

TEST(EllipticPendulum, TurnsOverTheTopAsTheAmplitudeFunction) {
  // a = 2 am(rate t / 2, k), k = 2 w / rate < 1.
  const double w = std::sqrt(9.81), rate = 6.5, k = 2 * w / rate, k1 = std::sqrt(1 - k * k);
  Pendulum pendulum(0, rate);
  RungeKutta integrator(pendulum, tight);
  double worst = 0;
  for (int i = 1; i <= 50; ++i) {
    integrator.advance(0.1 * i);
    worst = std::max(worst, std::abs(integrator.state().q[0] -
                                     2 * reference::jacobi_amplitude(rate * 0.1 * i / 2, k, k1)));
  }
  EXPECT_GT(integrator.state().q[0], 2 * M_PI);
  EXPECT_LT(worst, 1e-9);
}

// A symmetric top on its tip: mass, distance of the centre of mass, inertia about the tip across and along the axis.
constexpr double m = 2, l = 0.15, J_C = 0.01, J1 = J_C + m * l * l, J3 = 0.008, g = 9.81;

class Top : public System {
 public:
  Body& top = body("top", Inertia(m, J_C, J_C, J3));
  /// About the tip, world axes.
  Vector3d angular_momentum(const State& s) {
    evaluate(s);
    const Eigen::Matrix3d R = top.frame().rotation();
    return R * Vector3d(J_C, J_C, J3).asDiagonal() * R.transpose() * top.angular_velocity() +
           m * top.position().cross(top.velocity());
  }
  Vector3d axis() const { return top.frame().direction(Vector3d::UnitZ()); }

 protected:
  void forces() override { gravity(); }
};

/// By Euler's angles.
class EulerTop : public Top {
 public:
  Coordinate precession = coordinate("precession"), nutation = coordinate("nutation"),
             spin = coordinate("spin");

 protected:
  void positions() override {
    top = rotate_z(precession) * rotate_x(nutation) * rotate_z(spin) * translate(0, 0, l);
  }
};

/// As a free body with the tip held by conditions on its velocity.
class FreeTop : public Top {
 public:
  explicit FreeTop(double theta)
      : motion(free_motion("motion", Vector3d(0, -l * std::sin(theta), l * std::cos(theta)),
                           Eigen::AngleAxisd(theta, Vector3d::UnitX()).toRotationMatrix())) {}
  FreeMotion motion;
  VelocityConstraint &tip_x = velocity_constraint("tip x"), &tip_y = velocity_constraint("tip y"),
                     &tip_z = velocity_constraint("tip z");

 protected:
  void positions() override {
    top = motion.frame();
    const ExprVector tip = top.frame().express_point({0, 0, -l});
    tip_x = {{1, tip.x()}};
    tip_y = {{1, tip.y()}};
    tip_z = {{1, tip.z()}};
  }
};

/// Height of the axis, cos(theta), of a top that is let go at theta_0 with its spin w3 alone:
///   u.^2 = (u0 - u) (beta (1 - u^2) - a^2 (u0 - u)) = beta (u - u1) (u0 - u) (u3 - u),  beta = 2 m g l / J1, a = J3 w3 / J1
///   u = u1 + (u0 - u1) sn^2(K - sqrt(beta (u3 - u1)) t / 2, k),   k^2 = (u0 - u1) / (u3 - u1)
/// (Goldstein, Classical Mechanics, 2nd ed., sect. 5-7).
double nutation_cosine(double theta_0, double w3, double t) {
  const double u0 = std::cos(theta_0), beta = 2 * m * g * l / J1, a2 = std::pow(J3 * w3 / J1, 2);
  const double root = std::sqrt(a2 * a2 - 4 * beta * (a2 * u0 - beta));
  const double u1 = (a2 - root) / (2 * beta), u3 = (a2 + root) / (2 * beta);
  const double k = std::sqrt((u0 - u1) / (u3 - u1)), k1 = std::sqrt((u3 - u0) / (u3 - u1));
  const double phase = reference::complete_elliptic_integral(k1) - std::sqrt(beta * (u3 - u1)) * t / 2;
  return u1 + (u0 - u1) * std::pow(std::sin(reference::jacobi_amplitude(phase, k, k1)), 2);
}

/// Largest deviation of cos(theta) from the closed form over 3 s, and of the integrals of motion from their start.
void follow(Top& top, State start, double theta_0, double w3, double allowed) {
  set_consistent_accelerations(top, start);
  RungeKutta integrator(top, start, {.relative_tolerance = 1e-11, .absolute_tolerance = 1e-12});
  const double Lz = top.angular_momentum(start).z(), L3 = top.angular_momentum(start).dot(top.axis());
  const EnergyBalance e0 = top.compute_energy(start);
  double deviation = 0, lowest = 1, drift = 0;
  for (int i = 1; i <= 150; ++i) {
    integrator.advance(0.02 * i);
    const Vector3d L = top.angular_momentum(integrator.state());
    const double u = top.axis().z();
    deviation = std::max(deviation, std::abs(u - nutation_cosine(theta_0, w3, 0.02 * i)));
    lowest = std::min(lowest, u);
    const EnergyBalance e = top.compute_energy(integrator.state());
    drift = std::max({drift, std::abs(L.z() / Lz - 1), std::abs(L.dot(top.axis()) / L3 - 1),
                      std::abs((e.kinetic + e.potential) / (e0.kinetic + e0.potential) - 1)});
  }
  EXPECT_LT(lowest, std::cos(theta_0) - 0.1);  // it nods
  EXPECT_LT(deviation, allowed);
  EXPECT_LT(drift, allowed);
}

TEST(HeavyTop, NutatesAsEllipticFunctionsSay) {
  const double theta = 0.5, w3 = 50;
  EulerTop euler;
  State s = euler.initial_state();
  s.q[1] = theta;
  s.qd[2] = w3;
  follow(euler, s, theta, w3, 1e-8);
}

TEST(HeavyTop, NutatesTheSameAsAFreeBodyHeldAtItsTip) {
  const double theta = 0.5, w3 = 50;
  FreeTop top(theta);
  State s = top.initial_state();
  s.qd[5] = w3;
  follow(top, s, theta, w3, 1e-7);
}

TEST(HeavyTop, PassesTheVerticalWhereEulersAnglesEnd) {
  // With L_z = L_3 the axis runs through the vertical.
  const double theta = 0.4, w3 = 20, precession = J3 * w3 / J1 / (1 + std::cos(theta)), fall = -9;
  FreeTop top(theta);
  State s = top.initial_state();
  const Vector3d e3(0, -std::sin(theta), std::cos(theta));
  // w . e3 = w3
  const Vector3d w = Vector3d(fall, 0, precession) + (w3 - precession * std::cos(theta)) * e3;
  s.qd.head(3) = w.cross(l * e3);
  s.qd.tail(3) = s.charts[0].transpose() * w;
  set_consistent_accelerations(top, s);
  const Vector3d L0 = top.angular_momentum(s);
  const EnergyBalance e0 = top.compute_energy(s);
  EXPECT_NEAR(L0.z(), L0.dot(top.axis()), 1e-12);
  RungeKutta integrator(top, s, {.relative_tolerance = 1e-11, .absolute_tolerance = 1e-12});
  double nearest = 1, drift = 0;
  integrator.advance(2, [&](const State& state) {
    const Vector3d L = top.angular_momentum(state);
    nearest = std::min(nearest, std::hypot(top.axis().x(), top.axis().y()));
    const EnergyBalance e = top.compute_energy(state);
    drift = std::max({drift, std::abs(L.z() / L0.z() - 1), std::abs(L.dot(top.axis()) / L0.z() - 1),
                      std::abs((e.kinetic + e.potential) / (e0.kinetic + e0.potential) - 1)});
  });
  EXPECT_LT(nearest, 0.05);  // a step of the integrator beside it
  EXPECT_LT(drift, 1e-8);
}

/// A thin disc that rolls on the plane: centre above (x, y), heading psi, lean theta, spin phi.
class RollingDisc : public System {
 public:
  static constexpr double mass = 3, r = 0.4, A = mass * r * r / 4, C = mass * r * r / 2;
  Coordinate x = coordinate("x"), y = coordinate("y"), psi = coordinate("psi"), theta = coordinate("theta"),
             phi = coordinate("phi");
  VelocityConstraint &forward = velocity_constraint("forward"), &sideways = velocity_constraint("sideways");
  Body& disc = body("disc", Inertia(mass, A, C, A));

 protected:
  void positions() override {
    disc = translate(x, y, r * cos(theta)) * rotate_z(psi) * rotate_x(theta) * rotate_y(phi);
    // The touching point of the disc rests.
    forward = {{cos(psi), x}, {sin(psi), y}, {-r, phi}, {-r * sin(theta), psi}};
    sideways = {{-sin(psi), x}, {cos(psi), y}, {r * cos(theta), theta}};
  }
  void forces() override { gravity(); }
};

/// Steady rolling with lean theta and turning rate W: by angular momentum about the centre,
///   A W^2 sin cos - (C + m r^2) n W cos = m g r sin        n: angular velocity about the disc's axis
TEST(RollingDisc, CirclesSteadily) {
  using D = RollingDisc;
  RollingDisc disc;
  const double theta = 0.35, W = 2.1, s = std::sin(theta), c = std::cos(theta);
  const double n = (D::A * W * W * s * c - D::mass * g * D::r * s) / ((D::C + D::mass * D::r * D::r) * W * c);
  State state = disc.initial_state();
  state.q[3] = theta;
  state.qd << D::r * n, 0, W, 0, n - W * s;
  set_consistent_accelerations(disc, state);
  EXPECT_LT(state.qdd.tail(3).norm(), 1e-11);
  EXPECT_NEAR(state.qdd[0], 0, 1e-11);
  EXPECT_NEAR(state.qdd[1], D::r * n * W, 1e-11);  // towards the centre of the circle
  RungeKutta integrator(disc, state, {.relative_tolerance = 1e-10, .absolute_tolerance = 1e-11});
  integrator.advance(2 * M_PI / W);
  EXPECT_LT(integrator.state().q.head(2).norm(), 1e-7);  // back after a turn
  EXPECT_NEAR(integrator.state().q[3], theta, 1e-7);
}

/// Upright at the spin n the lean obeys
///   (A + m r^2) theta.. + ((C + m r^2) C n^2 / A - m g r) theta = 0
/// so that a thin disc stays up above v^2 = g r / 3.
TEST(RollingDisc, StaysUprightAboveItsCriticalSpeed) {
  using D = RollingDisc;
  for (const double v : {0.5, 1.0, 1.3, 3.0}) {
    RollingDisc disc;
    const double n = v / D::r, mr2 = D::mass * D::r * D::r;
    State state = disc.initial_state();
    state.qd << v, 0, 0, 0, n;
    set_consistent_accelerations(disc, state);
    const StateSpace space = linearize_state_space(disc, state);
    const double square = ((D::C + mr2) * D::C * n * n / D::A - D::mass * g * D::r) / (D::A + mr2);
    const std::complex<double> expected = std::sqrt(std::complex<double>(-square));
    const Eigen::VectorXcd poles = space.A.eigenvalues();
    const double distance = (poles.array() - expected).abs().minCoeff();
    const double growth = poles.real().maxCoeff();
    EXPECT_LT(distance, 1e-6 * std::abs(expected)) << v;
    // Above it the double pole at zero (a turned heading) splits by the square root of rounding.
    EXPECT_NEAR(growth, expected.real(), 1e-6) << v;
  }
}

TEST(RollingDisc, KeepsItsEnergyWhileItWobbles) {
  RollingDisc disc;
  State state = disc.initial_state();
  state.q[3] = 0.9;
  state.qd << 0, 0, 3, 0.5, 4;
  AccelerationSolver(disc).project_velocities(state);
  set_consistent_accelerations(disc, state);
  RungeKutta integrator(disc, state, {.relative_tolerance = 1e-11, .absolute_tolerance = 1e-12});
  const EnergyBalance e0 = disc.compute_energy(state);
  double drift = 0, least = 2, most = 0;
  integrator.advance(10, [&](const State& s) {
    const EnergyBalance e = disc.compute_energy(s);
    drift = std::max(drift, std::abs((e.kinetic + e.potential) / (e0.kinetic + e0.potential) - 1));
    least = std::min(least, s.q[3]);
    most = std::max(most, s.q[3]);
  });
  EXPECT_GT(most - least, 0.3);
  EXPECT_LT(drift, 1e-8);
}

}  // namespace
}  // namespace easydyn

#include <gmock/gmock.h>

#include <Eigen/Eigenvalues>

#include "easydyn/easydyn.hpp"

namespace easydyn {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// Two rods in a plane; the second angle can be held.
class TwoRods : public System {
 public:
  Coordinate a = coordinate("a", 0.4, 0.5), b = coordinate("b", 0.3, -0.7);
  Reaction bearing = reaction("bearing");
  Body& first = body("first", Inertia::rod_z(2, 1.0));
  Body& second = body("second", Inertia::rod_z(1, 0.6));

 protected:
  void positions() override {
    const Frame start = bearing.cut(translate(0.2, 0, 1.5));
    first = start * rotate_y(a) * translate(0, 0, -0.5);
    second = start * rotate_y(a) * translate(0, 0, -1.0) * rotate_y(b) * translate(0, 0, -0.3);
  }
  void forces() override { gravity(); }
};

/// The same with the second angle as a function of time inside positions().
class DrivenRods : public System {
 public:
  Coordinate a = coordinate("a", 0.4, 0.5);
  Body& first = body("first", Inertia::rod_z(2, 1.0));
  Body& second = body("second", Inertia::rod_z(1, 0.6));

 protected:
  void positions() override {
    const Expr b = 0.3 + 0.2 * sin(3 * time());
    first = translate(0.2, 0, 1.5) * rotate_y(a) * translate(0, 0, -0.5);
    second =
        translate(0.2, 0, 1.5) * rotate_y(a) * translate(0, 0, -1.0) * rotate_y(b) * translate(0, 0, -0.3);
  }
  void forces() override { gravity(); }
};

TEST(HeldCoordinate, MovesAsGivenAndLeavesTheUnknowns) {
  TwoRods rods;
  DrivenRods driven;
  rods.b.prescribe([](double t) {
    return ImposedMotion{0.3 + 0.2 * std::sin(3 * t), 0.6 * std::cos(3 * t), -1.8 * std::sin(3 * t)};
  });
  EXPECT_EQ(rods.size(), 1);
  EXPECT_EQ(rods.coordinate_name(0), "a");
  State s = driven.initial_state();
  s.t = 0.37;
  s.qdd[0] = 1.9;
  EXPECT_NEAR(rods.compute_residual(s)[0], driven.compute_residual(s)[0], 1e-12);
  EXPECT_NEAR(rods.compute_mass_matrix(s)(0, 0), driven.compute_mass_matrix(s)(0, 0), 1e-12);
  EXPECT_NEAR(rods.compute_energy(s).supplied, driven.compute_energy(s).supplied, 1e-12);

  // The moment that holds b is the residual of the free system at the same motion.
  rods.evaluate(s);
  const double moment = rods.holding_force(rods.b);
  rods.b.release();
  State free = rods.initial_state();
  free.t = s.t;
  free.q << s.q[0], 0.3 + 0.2 * std::sin(3 * s.t);
  free.qd << s.qd[0], 0.6 * std::cos(3 * s.t);
  free.qdd << 1.9, -1.8 * std::sin(3 * s.t);
  EXPECT_NEAR(moment, rods.compute_residual(free)[1], 1e-12);
}

TEST(HeldCoordinate, SaysThatItIsHeld) {
  TwoRods rods;
  rods.a.lock(0.1);
  EXPECT_EQ(rods.b.index(), 0);
  EXPECT_THAT([&] { (void)rods.a.index(); },
              ThrowsMessage<ModelError>(HasSubstr("coordinate \"a\" is held")));
  EXPECT_THAT([&] { (void)rods.holding_force(rods.b); },
              ThrowsMessage<ModelError>(HasSubstr("coordinate \"b\" is not held")));
  EXPECT_THROW(rods.b.lock(std::nan("")), ModelError);
}

TEST(Reaction, OfTheBearingIsNewtonAndEuler) {
  TwoRods rods;
  State s = rods.initial_state();
  set_consistent_accelerations(rods, s);
  rods.compute_reactions(s);
  const Eigen::Vector3d g(0, 0, -9.81), bearing(0.2, 0, 1.5);
  const Eigen::Vector3d force = 2 * (rods.first.acceleration() - g) + 1 * (rods.second.acceleration() - g);
  EXPECT_LT((rods.bearing.force() - force).norm(), 1e-12 * force.norm());
  EXPECT_LT(rods.bearing.moment().norm(), 1e-12);  // the hinge is free
  // Reactions do not change the system.
  EXPECT_LT(rods.compute_residual(s).norm(), 1e-11);

  // Held, the hinge carries the moment about its axis.
  rods.a.lock(0.4);
  rods.b.lock(0.3);
  State still = rods.initial_state();
  rods.compute_reactions(still);
  const double by_hand =
      -9.81 * (2 * (rods.first.position().x() - 0.2) + 1 * (rods.second.position().x() - 0.2));
  EXPECT_NEAR(rods.bearing.moment().y(), by_hand, 1e-12);
}

TEST(Reaction, InsideALoopBalancesTheMomentum) {
  // Slider-crank without gravity: along x nothing but the crank's bearing acts on the whole.
  class SliderCrank : public System {
   public:
    Coordinate a = coordinate("a", 0.7, 5.0);
    Loop<1> closing = loop<1>("rod", {0.1});
    Reaction bearing = reaction("bearing");
    Body& crank = body("crank", Inertia::box(2, 0.3, 0.1, 0.1));
    Body& rod = body("rod", Inertia::box(3, 0.8, 0.1, 0.1));

   protected:
    void positions() override {
      const Frame pin = bearing.cut(Frame()) * rotate_y(-a) * translate(0.3, 0, 0);
      const Expr b = closing.solve([&](const auto& p) {
        const Frame end = pin * rotate_y(p[0] + a) * translate(0.8, 0, 0);
        return std::array{end.express_point({0, 0, 0}).z()};
      })[0];
      crank = pin * translate(-0.15, 0, 0);
      rod = pin * rotate_y(b + a) * translate(0.4, 0, 0);
    }
  } system;
  State s = system.initial_state();
  set_consistent_accelerations(system, s);
  system.compute_reactions(s);
  const double rate = 2 * system.crank.acceleration().x() + 3 * system.rod.acceleration().x();
  EXPECT_NEAR(system.bearing.force().x(), rate, 1e-11 * std::abs(rate));
}

/// A skate on an inclined plane, which turns at a constant rate w: starting from rest it does not run down but
/// drifts sideways (Bloch, Nonholonomic Mechanics and Control, 2003, sect. 1.4):
///   s(t) = c / (2 w^2) sin^2 w t down the slope,  u(t) = c / (2 w^2) (w t - sin(2 w t) / 2) across,  c = g sin(slope)
class Skate : public System {
 public:
  Coordinate s = coordinate("s"), u = coordinate("u"), psi = coordinate("psi", 0, w);
  VelocityConstraint& edge = velocity_constraint("edge");
  Body& skate = body("skate", Inertia(2.0, 0.3));
  static constexpr double w = 1.7, c = 3.0;

 protected:
  void positions() override {
    skate = translate(s, u, 0) * rotate_z(psi);
    edge = {{-sin(psi), s}, {cos(psi), u}};  // no velocity across the blade
  }
  void forces() override { gravity(Eigen::Vector3d(c, 0, 0)); }
};

TEST(VelocityConstraint, LetsASkateDriftAcrossTheSlope) {
  Skate skate;
  const double errors[2] = {[&] {
                              Newmark newmark(skate, {.step = 2e-3});
                              newmark.advance(2);
                              const double wt = Skate::w * 2, k = Skate::c / (2 * Skate::w * Skate::w);
                              EXPECT_NEAR(newmark.state().qd[0] * std::sin(newmark.state().q[2]),
                                          newmark.state().qd[1] * std::cos(newmark.state().q[2]), 1e-9);
                              return std::hypot(newmark.state().q[0] - k * std::pow(std::sin(wt), 2),
                                                newmark.state().q[1] - k * (wt - std::sin(2 * wt) / 2));
                            }(),
                            [&] {
                              Newmark newmark(skate, {.step = 1e-3});
                              newmark.advance(2);
                              const double wt = Skate::w * 2, k = Skate::c / (2 * Skate::w * Skate::w);
                              return std::hypot(newmark.state().q[0] - k * std::pow(std::sin(wt), 2),
                                                newmark.state().q[1] - k * (wt - std::sin(2 * wt) / 2));
                            }()};
  EXPECT_LT(errors[1], 1e-5);
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2, 0.1);
}

TEST(VelocityConstraint, GivesTheForceOfRollingWithoutSlip) {
  // A disc that rolls down a slope: x.. = c / (1 + J / m r^2), friction J x.. / r^2.
  class Disc : public System {
   public:
    Coordinate x = coordinate("x"), spin = coordinate("spin");
    VelocityConstraint& rolling = velocity_constraint("rolling");
    Body& disc = body("disc", Inertia::cylinder_y(4, 0.5, 0.1));

   protected:
    void positions() override {
      disc = translate(x, 0, 0.5) * rotate_y(spin);
      rolling = {{1, x}, {-0.5, spin}};
    }
    void forces() override { gravity(Eigen::Vector3d(2, 0, -9)); }
  } disc;
  State s = disc.initial_state();
  set_consistent_accelerations(disc, s);
  EXPECT_NEAR(s.qdd[0], 2 / 1.5, 1e-12);
  EXPECT_NEAR(s.lambda[0], -4 * (2 - 2 / 1.5), 1e-12);
  s.qd << 3.0, 1.0;  // slips
  AccelerationSolver(disc).project_velocities(s);
  EXPECT_NEAR(s.qd[0], 0.5 * s.qd[1], 1e-13);
  EXPECT_NEAR(4 * s.qd[0] + 0.5 * s.qd[1] / 0.5, 4 * 3.0 + 0.5 / 0.5, 1e-12);  // impulse along A only
}

TEST(VelocityConstraint, IsNamedWhenItRepeatsAnother) {
  class Twice : public System {
   public:
    Coordinate x = coordinate("x"), y = coordinate("y");
    VelocityConstraint &one = velocity_constraint("one"), &two = velocity_constraint("two");
    Body& b = body("b", 1.0);

   protected:
    void positions() override {
      b = translate(x, y, 0);
      one = {{1, x}, {1, y}};
      two = {{2, x}, {2, y}};
    }
  } twice;
  State s = twice.initial_state();
  EXPECT_THAT([&] { set_consistent_accelerations(twice, s); },
              ThrowsMessage<SolverError>(HasSubstr("velocity constraints are not independent")));
}

/// A motor that drives a flywheel: L i. = u - R i - k w,  J w. = k i.
class Motor : public System {
 public:
  Coordinate angle = coordinate("angle");
  FirstOrderState current = first_order_state("current");
  Input voltage = input("voltage", 12);
  Body& wheel = body("wheel", Inertia(1, 1, 1, J));
  static constexpr double L = 0.05, R = 0.8, k = 0.3, J = 0.02;

 protected:
  void positions() override { wheel = rotate_z(angle); }
  void forces() override {
    current.set_rate((voltage.value() - R * current.value() - k * angle.rate()) / L);
    wheel.add_moment({0, 0, k * current.value()});
  }
};

TEST(FirstOrderState, RunsWithTheCoordinatesAtSecondOrder) {
  // Linear: x = (w, i), x. = A x + b; the exact solution by the eigenvalues of A.
  Eigen::Matrix2d A;
  A << 0, Motor::k / Motor::J, -Motor::k / Motor::L, -Motor::R / Motor::L;
  const Eigen::Vector2d b(0, 12 / Motor::L), rest = -A.inverse() * b;
  const Eigen::EigenSolver<Eigen::Matrix2d> eigen(A);
  const Eigen::Vector2cd start = eigen.eigenvectors().inverse() * (-rest).cast<std::complex<double>>();
  const double t = 0.15;
  const Eigen::Vector2d exact =
      rest +
      (eigen.eigenvectors() * ((eigen.eigenvalues() * t).array().exp() * start.array()).matrix()).real();

  const auto error = [&](auto make) {
    Motor motor;
    auto stepper = make(motor);
    stepper.advance(t);
    return (Eigen::Vector2d(stepper.state().qd[0], stepper.state().x[0]) - exact).norm() / exact.norm();
  };
  const auto order = [&](auto make) {
    return std::log2(error([&](Motor& m) { return make(m, 1e-3); }) /
                     error([&](Motor& m) { return make(m, 5e-4); }));
  };
  EXPECT_NEAR(order([](Motor& m, double h) { return Newmark(m, {.step = h}); }), 2, 0.1);
  EXPECT_NEAR(order([](Motor& m, double h) { return Hht(m, {.step = h}, -0.2); }), 2, 0.1);
  EXPECT_NEAR(order([](Motor& m, double h) { return GeneralizedAlpha(m, {.step = h}, 0.5); }), 2, 0.1);
  EXPECT_LT(error([](Motor& m) { return Newmark(m, {.step = 1e-4}); }), 1e-6);
}

TEST(FirstOrderState, SettlesWithTheStaticEquilibrium) {
  // A spring holds the wheel: the current is u / R, the angle k i / stiffness.
  class Held : public Motor {
   protected:
    void forces() override {
      Motor::forces();
      wheel.add_moment({0, 0, -5 * angle.value()});
    }
  } held;
  const State s = solve_static_equilibrium(held);
  EXPECT_NEAR(s.x[0], 12 / Motor::R, 1e-9);
  EXPECT_NEAR(s.q[0], Motor::k * 12 / Motor::R / 5, 1e-9);
}

// A wheel is turned as given and drives a cart by rolling without slip.
class DrivenCart : public System {
 public:
  Coordinate x = coordinate("x"), spin = coordinate("spin");
  VelocityConstraint& no_slip = velocity_constraint("no slip");
  Body& cart = body("cart", 4.0);
  Body& wheel = body("wheel", Inertia(1, 0.5));
  DrivenCart() {
    spin.prescribe([](double t) { return ImposedMotion(t * t, 2 * t, 2); });
  }

 protected:
  void positions() override {
    cart = translate(x, 0, 0);
    wheel = rotate_y(spin);
    no_slip = {{1, Expr(x)}, {-0.5, Expr(spin)}};
  }
};

TEST(VelocityConstraint, BringsInTheEnergyOfADrive) {
  DrivenCart system;
  State s = system.initial_state();
  s.t = 1;
  s.qd[0] = 1;  // x. = 0.5 * 2
  set_consistent_accelerations(system, s);
  EXPECT_NEAR(s.qdd[0], 1, 1e-12);
  // d/dt (m x.^2 / 2) = 4 W for the cart, J w w. = 2 W for the wheel
  const EnergyBalance e = system.compute_energy(s);
  EXPECT_NEAR(e.supplied, 4 + 2, 1e-12);
  EXPECT_NEAR(system.holding_force(system.spin) * 2, 6, 1e-12);
}

TEST(VelocityConstraint, HoldsInEveryIntegratorBesideAStructureAndAHeldCoordinate) {
  class WithStructure : public DrivenCart {
   public:
    WithStructure() {
      SparseMatrix one(2, 2);
      one.setIdentity();
      structure("block", one, one, 50 * one);
    }
  };
  const auto x_of = [](auto make) {
    WithStructure system;
    auto integrator = make(system);
    integrator.advance(0.5);
    return integrator.state().q[0];
  };
  const AdaptiveOptions tight{.relative_tolerance = 1e-8, .absolute_tolerance = 1e-10};
  EXPECT_NEAR(x_of([](System& s) { return Newmark(s, {.step = 1e-3}); }), 0.125, 1e-6);
  EXPECT_NEAR(x_of([&](System& s) { return RungeKutta(s, tight); }), 0.125, 1e-7);
  EXPECT_NEAR(x_of([&](System& s) { return Cvode(s, tight); }), 0.125, 1e-6);
  EXPECT_NEAR(x_of([&](System& s) { return Ida(s, tight); }), 0.125, 1e-6);
}

TEST(VelocityConstraint, IsMetByTheRatesThatNewmarkStartsWith) {
  class Wheel : public System {
   public:
    Coordinate x = coordinate("x", 0, 3.0), spin = coordinate("spin", 0, 1.0);
    VelocityConstraint& no_slip = velocity_constraint("no slip");
    Body& wheel = body("wheel", Inertia(2, 0.5));
    void positions() override {
      wheel = translate(x, 0, 0) * rotate_y(spin);
      no_slip = {{1, Expr(x)}, {-0.5, Expr(spin)}};
    }
  } system;
  Newmark newmark(system, {.step = 1e-2});
  EXPECT_NEAR(newmark.state().qd[0], 0.5 * newmark.state().qd[1], 1e-12);
  newmark.advance(0.1);
  EXPECT_NEAR(newmark.state().lambda[0], 0, 1e-9);  // it rolls on without force
  EXPECT_THROW(linearize(system, newmark.state()), ModelError);
}

}  // namespace
}  // namespace easydyn

// The IFToMM library of computational benchmark problems (Gonzalez et al., Multibody Syst. Dyn. 16, 2006).

#include <gmock/gmock.h>

#include <Eigen/SVD>

#include "easydyn/easydyn.hpp"
#include "tests/reference/bricard.hpp"

namespace easydyn {
namespace {

/// A01: a point of 1 kg on a rod of 1 m, released level.
TEST(IftommA01, SimplePendulumIsWhereTheEllipticFunctionsPutIt) {
  class Pendulum : public System {
   public:
    Coordinate a = coordinate("a", M_PI / 2);
    Body& bob = body("bob", 1.0);

   protected:
    void positions() override { bob = rotate_y(a) * translate(0, 0, -1); }
    void forces() override { gravity(); }
  } pendulum;
  RungeKutta integrator(pendulum, {.relative_tolerance = 1e-11, .absolute_tolerance = 1e-12});
  integrator.advance(10);
  // x(10 s) and height by elliptic functions; the library allows 1e-5 of the energy at high precision
  pendulum.evaluate(integrator.state());
  EXPECT_NEAR(pendulum.bob.position().x(), -0.275087462576117, 1e-8);
  EXPECT_NEAR(pendulum.bob.position().z(), -0.961419205099125, 1e-8);
  const EnergyBalance e = pendulum.compute_energy(integrator.state());
  EXPECT_NEAR(e.kinetic + e.potential, 0, 1e-8);
}

/// A02, N = 2: three cranks and two couplers of 1 m and 1 kg on the parallelogram branch, which the crank's angle
/// describes through the flat positions.
TEST(IftommA02, ParallelogramFollowsTheIndependentSolution) {
  class FourBars : public System {
   public:
    Coordinate phi = coordinate("phi", M_PI / 2, -1);
    std::vector<Body*> cranks, couplers;
    FourBars() {
      for (int i = 0; i < 3; ++i)
        cranks.push_back(&body("crank " + std::to_string(i), Inertia(1, 0, 1 / 12.0, 1 / 12.0)));
      for (int i = 0; i < 2; ++i)
        couplers.push_back(&body("coupler " + std::to_string(i), Inertia(1, 0, 1 / 12.0, 1 / 12.0)));
    }

   protected:
    void positions() override {
      for (int i = 0; i < 3; ++i)
        *cranks[static_cast<std::size_t>(i)] = translate(i, 0, 0) * rotate_y(-phi) * translate(0.5, 0, 0);
      for (int i = 0; i < 2; ++i)
        *couplers[static_cast<std::size_t>(i)] =
            translate(i, 0, 0) * rotate_y(-phi) * translate(1, 0, 0) * rotate_y(phi) * translate(0.5, 0, 0);
    }
    void forces() override { gravity(); }
  } system;
  RungeKutta integrator(system, {.relative_tolerance = 1e-11, .absolute_tolerance = 1e-12});
  integrator.advance(10);
  // One coordinate, integrated independently to an energy drift of 2e-11.
  EXPECT_NEAR(integrator.state().q[0], -30.1798008601836, 1e-6);
  EXPECT_NEAR(integrator.state().qd[0], -1.50664218082099, 1e-6);
}

/// A02 with its loops left to Newton: the same mechanism as two rhombi, the second on the first one's rocker.
TEST(IftommA02, LoopsRefuseTheFlatPositionWhereBranchesMeet) {
  class Rhombi : public System {
   public:
    Coordinate phi = coordinate("phi", M_PI / 2, -1);
    Loop<2> first = loop<2>("first window", {0, M_PI / 2}), second = loop<2>("second window", {0, M_PI / 2});
    std::vector<Body*> bars;
    Rhombi() : System("N-four-bar") {
      for (int i = 0; i < 5; ++i)
        bars.push_back(&body("bar " + std::to_string(i), Inertia(1, 0, 1 / 12.0, 1 / 12.0)));
    }

   protected:
    void positions() override {
      const auto close = [](Loop<2>& window, const Expr& crank) {  // angles of coupler and rocker
        return window.solve([&](const auto& p) {
          return std::array{cos(crank) + cos(p[0]) - cos(p[1]) - 1, sin(crank) + sin(p[0]) - sin(p[1])};
        });
      };
      const auto [coupler_1, rocker_1] = close(first, phi);
      const auto [coupler_2, rocker_2] = close(second, rocker_1);
      *bars[0] = rotate_y(-phi) * translate(0.5, 0, 0);
      *bars[1] = translate(1, 0, 0) * rotate_y(-rocker_1) * translate(0.5, 0, 0);
      *bars[2] = translate(2, 0, 0) * rotate_y(-rocker_2) * translate(0.5, 0, 0);
      *bars[3] = translate(cos(phi), 0, sin(phi)) * rotate_y(-coupler_1) * translate(0.5, 0, 0);
      *bars[4] = translate(1 + cos(rocker_1), 0, sin(rocker_1)) * rotate_y(-coupler_2) * translate(0.5, 0, 0);
    }
    void forces() override { gravity(); }
  };
  // At phi = 0 all bars lie on one line: parallelogram and antiparallelogram meet. No step may carry the motion
  // across unseen; up to there it is that of the parallelogram. (Newmark with 1 ms comes so close that rounding,
  // multiplied by 1 / phi^3, stops its own iteration first.)
  const auto refused_at = [](auto make) {
    Rhombi rhombi;
    double last = M_PI / 2;
    EXPECT_THAT(
        [&] {
          auto integrator = make(rhombi);
          integrator.advance(10, [&](const State& s) {
            last = s.q[0];
            EXPECT_NEAR(rhombi.first.value(0), 0, 1e-3);  // coupler level: no other branch
          });
        },
        testing::ThrowsMessage<SolverError>(testing::AllOf(
            testing::HasSubstr("window\" of system \"N-four-bar\""), testing::HasSubstr("dead point"))));
    return last;
  };
  const double runge_kutta =
      refused_at([](System& s) { return RungeKutta(s, {.relative_tolerance = 1e-8}); });
  EXPECT_GT(runge_kutta, 0);
  EXPECT_LT(runge_kutta, 0.5);  // a step of Runge-Kutta's before it
  for (const double step : {0.01, 0.0031}) {
    const double newmark = refused_at([&](System& s) { return Newmark(s, {.step = step}); });
    EXPECT_GT(newmark, 0) << step;
    EXPECT_LT(newmark, 6 * step) << step;  // 4.8 rad/s there: the last step before it
  }
}

/// A03: Andrews' squeezing mechanism, seven bodies in three loops; data of the test set for initial value problem
/// solvers (Mazzia & Magherini 2008, problem andrews), after Hairer & Wanner, Solving ODE II, sect. VII.7.
class Andrews : public System {
 public:
  static constexpr double d = 28e-3, da = 115e-4, e = 2e-2, ea = 1421e-5, zf = 2e-2, fa = 1421e-5, rr = 7e-3,
                          ra = 92e-5, ss = 35e-3, sa = 1874e-5, sb = 1043e-5, sc = 18e-3, sd = 2e-2,
                          zt = 4e-2, ta = 2308e-5, tb = 916e-5, u = 4e-2, ua = 1228e-5, ub = 449e-5;
  static constexpr double xa = -0.06934, ya = -0.00227, xb = -0.03635, yb = 0.03273, xc = 0.014, yc = 0.072;
  static constexpr double c0 = 4530, l0 = 0.07785, mom = 0.033;

  Coordinate beta = coordinate("beta", -0.0617138900142764496358948458001);
  Loop<6> closing =
      loop<6>("Andrews", {0, 0.455279819163070380255912382449, 0.222668390165885884674473185609,
                          0.487364979543842550225598953530, -0.222668390165885884674473185609,
                          1.23054744454982119249735015568});  // Theta, gamma, Phi, delta, Omega, epsilon
  std::array<Expr, 6> p;
  std::array<Body*, 7> bodies_of{
      &body("1", Inertia(0.04325, 2.194e-6)), &body("2", Inertia(0.00365, 4.410e-7)),
      &body("3", Inertia(0.02373, 5.255e-6)), &body("4", Inertia(0.00706, 5.667e-7)),
      &body("5", Inertia(0.07050, 1.169e-5)), &body("6", Inertia(0.00706, 5.667e-7)),
      &body("7", Inertia(0.05498, 1.912e-5))};

 protected:
  void positions() override {
    p = closing.solve([&](const auto& x) {
      const auto& [Theta, gamma, Phi, delta, Omega, epsilon] = x;
      const Expr Fx = rr * cos(beta) - d * cos(beta + Theta), Fy = rr * sin(beta) - d * sin(beta + Theta);
      return std::array{Fx - ss * sin(gamma) - xb,
                        Fy + ss * cos(gamma) - yb,
                        Fx - e * sin(Phi + delta) - zt * cos(delta) - xa,
                        Fy + e * cos(Phi + delta) - zt * sin(delta) - ya,
                        Fx - zf * cos(Omega + epsilon) - u * sin(epsilon) - xa,
                        Fy - zf * sin(Omega + epsilon) + u * cos(epsilon) - ya};
    });
    const auto& [Theta, gamma, Phi, delta, Omega, epsilon] = p;
    const auto place = [&](int i, const Expr& x, const Expr& y, const Expr& angle) {
      *bodies_of[static_cast<std::size_t>(i - 1)] = translate(x, y, 0) * rotate_z(angle);
    };
    place(1, ra * cos(beta), ra * sin(beta), beta);
    place(2, rr * cos(beta) - da * cos(beta + Theta), rr * sin(beta) - da * sin(beta + Theta), beta + Theta);
    place(3, xb + sa * sin(gamma) + sb * cos(gamma), yb - sa * cos(gamma) + sb * sin(gamma), gamma);
    place(4, xa + zt * cos(delta) + (e - ea) * sin(Phi + delta),
          ya + zt * sin(delta) - (e - ea) * cos(Phi + delta), Phi + delta);
    place(5, xa + ta * cos(delta) - tb * sin(delta), ya + ta * sin(delta) + tb * cos(delta), delta);
    place(6, xa + u * sin(epsilon) + (zf - fa) * cos(Omega + epsilon),
          ya - u * cos(epsilon) + (zf - fa) * sin(Omega + epsilon), Omega + epsilon);
    place(7, xa + ua * sin(epsilon) - ub * cos(epsilon), ya - ua * cos(epsilon) - ub * sin(epsilon), epsilon);
  }
  void forces() override {
    bodies_of[0]->add_moment({0, 0, mom});
    // The spring from (xc, yc) to point D of body 3, which is (sd - sb, sa - sc) from its centre of mass.
    const Eigen::Vector3d D = bodies_of[2]->point({sd - sb, sa - sc, 0}),
                          line = D - Eigen::Vector3d(xc, yc, 0);
    const double length = line.norm();
    bodies_of[2]->add_force(-c0 * (length - l0) / length * line, D);
  }
};

TEST(IftommA03, AndrewsMechanismReachesThePublishedAngles) {
  Andrews andrews;
  RungeKutta integrator(andrews, {.relative_tolerance = 1e-11, .absolute_tolerance = 1e-11});
  EXPECT_NEAR(integrator.state().qdd[0], 14222.4439199541, 1e-6);  // published initial acceleration
  integrator.advance(0.03);
  andrews.evaluate(integrator.state());
  // Published at 0.03 s (test set, release 2.4): beta, Theta, gamma, Phi, delta, Omega, epsilon.
  const double published[7] = {0.1581077119629904e2, -0.1575637105984298e2, 0.4082224013073101e-1,
                               -0.5347301163226948,  0.5244099658805304,    0.5347301163226948,
                               0.1048080741042263e1};
  EXPECT_NEAR(integrator.state().q[0], published[0], 1e-7);
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(andrews.p[i].value(), published[i + 1], 1e-7) << "angle " << i + 1;
}

/// A04: Bricard's mechanism, five rods of 1 m and 1 kg on the edges of a cube, the sixth edge is the ground. Each of the
/// six hinges stands across its two rods. Counted by Gruebler it cannot move; it has one freedom.
class Bricard : public System {
 public:
  Bricard() : System("Bricard") {}
  Coordinate q = coordinate("q");  // angle in joint 0
  Loop<5> closing = loop<5>("Bricard", {0, 0, 0, 0, 0});
  Body& rod_1 = body("rod 1", Inertia(1, 0, 1 / 12.0, 1 / 12.0));
  Body& rod_2 = body("rod 2", Inertia(1, 1 / 12.0, 0, 1 / 12.0));
  Body& rod_3 = body("rod 3", Inertia::rod_z(1, 1));
  Body& rod_4 = body("rod 4", Inertia(1, 0, 1 / 12.0, 1 / 12.0));
  Body& rod_5 = body("rod 5", Inertia(1, 1 / 12.0, 0, 1 / 12.0));
  std::vector<Expr> equations;
  std::array<Expr, 5> angles;

 protected:
  void positions() override {
    angles = closing.solve([&](const auto& p) { return equations = equations_of_closure(p); });
    const Frame f1 = rotate_y(q), f2 = f1 * translate(1, 0, 0) * rotate_z(angles[0]),
                f3 = f2 * translate(0, -1, 0) * rotate_x(angles[1]),
                f4 = f3 * translate(0, 0, 1) * rotate_y(angles[2]),
                f5 = f4 * translate(-1, 0, 0) * rotate_z(angles[3]);
    rod_1 = f1 * translate(0.5, 0, 0);
    rod_2 = f2 * translate(0, -0.5, 0);
    rod_3 = f3 * translate(0, 0, 0.5);
    rod_4 = f4 * translate(-0.5, 0, 0);
    rod_5 = f5 * translate(0, 0.5, 0);
  }
  void forces() override { gravity(Eigen::Vector3d(0, -9.81, 0)); }

 private:
  /// Around all six joints back to the ground: the place of joint 5 and the axes after it.
  std::vector<Expr> equations_of_closure(const std::array<Expr, 5>& p) const {
    const Frame end = rotate_y(q) * translate(1, 0, 0) * rotate_z(p[0]) * translate(0, -1, 0) *
                      rotate_x(p[1]) * translate(0, 0, 1) * rotate_y(p[2]) * translate(-1, 0, 0) *
                      rotate_z(p[3]) * translate(0, 1, 0) * rotate_x(p[4]);
    const ExprVector place = end.express_point({0, 0, 0});
    return {place.x(),
            place.y(),
            place.z() - 1,
            end.express_direction({1, 0, 0}).y(),
            end.express_direction({0, 1, 0}).z(),
            end.express_direction({0, 0, 1}).x()};
  }
};

TEST(IftommA04, BricardsMechanismFollowsItsClosedForm) {
  Bricard bricard;
  RungeKutta integrator(bricard, {.relative_tolerance = 1e-10, .absolute_tolerance = 1e-11});
  reference::Bricard closed_form;
  double largest = 0, drift = 0, lowest = 0;
  for (int i = 1; i <= 100; ++i) {
    for (int k = 0; k < 500; ++k) closed_form.step(2e-4);
    integrator.advance(0.1 * i);
    bricard.evaluate(integrator.state());
    const auto joints = reference::Bricard::joints(closed_form.s);
    const auto joint = [&](std::size_t k) {
      return Eigen::Vector3d(joints[k][0].f, joints[k][1].f, joints[k][2].f);
    };
    largest = std::max({largest, (bricard.rod_2.point({0, -0.5, 0}) - joint(2)).norm(),
                        (bricard.rod_4.point({-0.5, 0, 0}) - joint(4)).norm(),
                        (bricard.rod_5.point({0, 0.5, 0}) - joint(5)).norm()});
    const EnergyBalance e = bricard.compute_energy(integrator.state());
    drift = std::max(drift, std::abs(e.kinetic + e.potential + 3 * 9.81));
    lowest = std::min(lowest, closed_form.s);
  }
  EXPECT_LT(lowest, -0.9 * M_PI);  // through the flat position and far beyond it
  EXPECT_LT(largest, 1e-8);        // measured 1.2e-10; the library allows 1e-3
  EXPECT_LT(drift, 1e-9 * 34);     // of the potential energy
}

TEST(IftommA04, SixClosureEquationsHaveRankFive) {
  constexpr int first_unknown = 1 << 24;  // in gradients, as System numbers them
  Bricard bricard;
  State s = bricard.initial_state();
  for (double q = 0.1; q < 3; q += 0.37) {
    s.q[0] = q;
    bricard.evaluate(s);
    Eigen::Matrix<double, 6, 6> J;  // five unknowns, last the coordinate
    for (int e = 0; e < 6; ++e) {
      const Gradient& g = bricard.equations[static_cast<std::size_t>(e)].gradient();
      for (int i = 0; i < 5; ++i) J(e, i) = g[first_unknown + i];
      J(e, 5) = g[0];
    }
    const Eigen::VectorXd singular = Eigen::JacobiSVD<Eigen::MatrixXd>(J).singularValues();
    EXPECT_LT(singular[5], 1e-12 * singular[0]) << "q = " << q;  // rounding of the solved angles
    EXPECT_GT(singular[4], 1e-2 * singular[0]) << "q = " << q;
  }
}

/// A05: stiff flyball governor. Two rods with balls hinged 0.05 m beside the axis at the top of a shaft of 1 m; springs
/// with dampers instead of couplers lead from their middles to the sides of a slider at height s on the shaft.
class FlyballGovernor : public System {
 public:
  Coordinate psi = coordinate("psi", 0, 2 * M_PI), s = coordinate("s", 0.5);
  Coordinate alpha_1 = coordinate("alpha 1", M_PI / 6), alpha_2 = coordinate("alpha 2", M_PI / 6);
  static constexpr double density = 3000, bar = density * 1e-4, block = density * 1e-3;
  Body& shaft = body("shaft", Inertia::box(bar, 0.01, 0.01, 1));
  Body& slider = body("slider", Inertia::box(block, 0.1, 0.1, 0.1));
  Body& rod_1 = body("rod 1", Inertia::box(bar, 1, 0.01, 0.01));
  Body& rod_2 = body("rod 2", Inertia::box(bar, 1, 0.01, 0.01));
  Body &ball_1 = body("ball 1", 5), &ball_2 = body("ball 2", 5);
  SpringDamper coupler_1{"coupler 1", 8e5, 4e4, 0.5}, coupler_2{"coupler 2", 8e5, 4e4, 0.5};

 protected:
  void positions() override {
    shaft = rotate_z(psi) * translate(0, 0, 0.5);
    slider = rotate_z(psi) * translate(0, 0, s);
    rod_1 = rotate_z(psi) * translate(0.05, 0, 1) * rotate_y(alpha_1) * translate(0.5, 0, 0);
    rod_2 = rotate_z(psi) * translate(-0.05, 0, 1) * rotate_y(-alpha_2) * translate(-0.5, 0, 0);
    ball_1 = rod_1 * translate(0.5, 0, 0);
    ball_2 = rod_2 * translate(-0.5, 0, 0);
  }
  void forces() override {
    gravity();
    coupler_1.apply(slider, {0.05, 0, 0}, rod_1, {0, 0, 0});
    coupler_2.apply(slider, {-0.05, 0, 0}, rod_2, {0, 0, 0});
  }
};

TEST(IftommA05, FlyballGovernorFollowsTheIndependentSolution) {
  FlyballGovernor governor;
  // Four coordinates integrated independently to a tolerance of 1e-10: slider, arm, speed of the shaft.
  const double expected[][4] = {{0.025, 0.501515439622, 0.521799428683, 6.27089506354},
                                {0.5, 0.743249424786, 0.259491381543, 5.10341542197},
                                {1, 0.50142092238, 0.521833301626, 6.27112574188},
                                {5, 0.535563103722, 0.482874576587, 6.02249649976},
                                {10, 0.619622917061, 0.390073701845, 5.54820362265}};
  Cvode integrator(governor, {.relative_tolerance = 1e-9, .absolute_tolerance = 1e-10});
  for (const auto& [t, s, alpha, speed] : expected) {
    integrator.advance(t);
    const State& state = integrator.state();
    // Measured 3e-8, 3e-8 and 2e-7; the library allows 1e-3.
    EXPECT_NEAR(state.q[1], s, 3e-7) << "t = " << t;
    EXPECT_NEAR(state.q[2], alpha, 3e-7) << "t = " << t;
    EXPECT_NEAR(state.qd[0], speed, 2e-6) << "t = " << t;
    EXPECT_NEAR(state.q[3], state.q[2], 1e-9);  // both arms
  }
}

}  // namespace
}  // namespace easydyn

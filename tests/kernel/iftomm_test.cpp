// The IFToMM library of computational benchmark problems (Gonzalez et al., Multibody Syst. Dyn. 16, 2006).

#include <gtest/gtest.h>

#include "easydyn/easydyn.hpp"

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

}  // namespace
}  // namespace easydyn

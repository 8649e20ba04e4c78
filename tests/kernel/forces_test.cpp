#include <gtest/gtest.h>

#include "easydyn/easydyn.hpp"

using namespace easydyn;

namespace {

class TwoBlocks : public System {
 public:
  Coordinate x1 = coordinate("x1", 0.1, 0.4), x2 = coordinate("x2", 0.25, -0.2);
  Body& lower = body("lower", 2.0);
  Body& upper = body("upper", 3.0);
  void positions() override {
    lower = translate(0, 0, x1);
    upper = translate(0, 0, 1 + x2);
  }
};

TEST(SpringDamper, PullsItsEndsTogetherAndAccountsItsEnergy) {
  class Model : public TwoBlocks {
   public:
    SpringDamper spring{"spring", 100, 7, 0.9};
    void forces() override { spring.apply(lower, {0, 0, 0}, upper, {0, 0, 0}); }
  } system;
  const State s = system.initial_state();
  // By hand: length 1.15, stretch 0.25, rate -0.6: F = 25 - 4.2 = 20.8 N tension.
  const Eigen::VectorXd r = system.compute_residual(s);
  EXPECT_NEAR(system.spring.force(), 20.8, 1e-12);
  EXPECT_NEAR(r[0], -20.8, 1e-12);
  EXPECT_NEAR(r[1], 20.8, 1e-12);
  const EnergyBalance e = system.compute_energy(s);
  EXPECT_NEAR(e.potential, 0.5 * 100 * 0.25 * 0.25, 1e-12);
  EXPECT_NEAR(e.dissipated, 7 * 0.36, 1e-12);
}

TEST(VerticalSpringDamper, CarriesItsPreloadInTheNominalGeometry) {
  class Model : public TwoBlocks {
   public:
    VerticalSpringDamper suspension{"suspension", 100, 7, 1.0, 50};
    void forces() override { suspension.apply(lower, {0.2, 0, 0}, upper, {0.7, 0, 0}); }
  } system;
  // By hand: u = 0.15, u. = -0.6: F = 50 - 15 + 4.2 = 39.2 N compression.
  const State s = system.initial_state();
  const Eigen::VectorXd r = system.compute_residual(s);
  EXPECT_NEAR(system.suspension.force(), 39.2, 1e-12);
  EXPECT_NEAR(r[0], 39.2, 1e-12);
  EXPECT_NEAR(r[1], -39.2, 1e-12);
  const EnergyBalance e = system.compute_energy(s);
  EXPECT_NEAR(e.potential, 0.5 * 100 * 0.15 * 0.15 - 50 * 0.15, 1e-12);
  EXPECT_NEAR(e.dissipated, 7 * 0.36, 1e-12);
}

TEST(SpringDamper, RefusesImpossibleDataByName) {
  try {
    SpringDamper("primary", -5, 0, 0);
    FAIL();
  } catch (const ModelError& e) {
    EXPECT_NE(std::string(e.what()).find("primary"), std::string::npos);
    EXPECT_NE(std::string(e.what()).find("-5"), std::string::npos);
  }
  EXPECT_THROW(SpringDamper("s", 1, std::nan(""), 0), ModelError);
  EXPECT_THROW(VerticalSpringDamper("s", std::nan(""), 0), ModelError);
  EXPECT_THROW(VerticalSpringDamper("s", 1, 0, 0, INFINITY), ModelError);
}

}  // namespace

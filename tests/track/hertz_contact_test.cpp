#include "track/hertz_contact.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "easydyn/error.hpp"

using easydyn::track::HertzContact;

TEST(HertzContact, NeverPulls) {
  const HertzContact contact;
  EXPECT_EQ(contact.force(-1e-6), 0);
  EXPECT_EQ(contact.force(0), 0);
  EXPECT_EQ(contact.stiffness(-1e-6), 0);
  EXPECT_EQ(contact.energy(-1e-6), 0);
}

TEST(HertzContact, HasTheForceAsDerivativeOfItsEnergy) {
  const HertzContact contact(9e10, 2);
  for (const double delta : {1e-6, 5e-5, 2e-4}) {
    const double e = 1e-4 * delta;  // central differences: relative error of order (e / delta)^2 = 1e-8
    EXPECT_NEAR((contact.energy(delta + e) - contact.energy(delta - e)) / (2 * e) / contact.force(delta), 1,
                1e-7);
    EXPECT_NEAR((contact.force(delta + e) - contact.force(delta - e)) / (2 * e) / contact.stiffness(delta), 1,
                1e-7);
  }
}

TEST(HertzContact, LinearisesTo1420MNPerMetreUnder85kN) {
  const HertzContact wheel(1e11, 1);
  EXPECT_NEAR(wheel.stiffness_under(85e3), 1.42e9, 0.005e9);  // 1.5 (1e11)^(2/3) (85e3)^(1/3), three digits
  EXPECT_NEAR(wheel.stiffness_under(85e3) / wheel.stiffness(wheel.indentation_under(85e3)), 1, 1e-12);
  EXPECT_NEAR(wheel.force(wheel.indentation_under(85e3)) / 85e3, 1, 1e-12);
}

TEST(HertzContact, OfAWheelsetCarriesTwiceTheLoadOfAWheel) {
  EXPECT_DOUBLE_EQ(HertzContact(1e11, 2).force(1e-4), 2 * HertzContact(1e11, 1).force(1e-4));
}

TEST(HertzContact, IsClosedByARaisedRailOrALoweredWheelAndOpenedByADeflectedRail) {
  EXPECT_GT(HertzContact::indentation(0, 0, 1e-3), 0);
  EXPECT_GT(HertzContact::indentation(-1e-3, 0, 0), 0);
  EXPECT_LT(HertzContact::indentation(0, 1e-3, 0), 0);
}

TEST(HertzContact, RefusesAnImpossibleConstant) {
  EXPECT_THROW(HertzContact(-1e11, 2), easydyn::ModelError);
  EXPECT_THROW(HertzContact(std::nan(""), 2), easydyn::ModelError);
  EXPECT_THROW(HertzContact(1e11, 0), easydyn::ModelError);
}

// Zhai's formulas (M-h), by hand for R = 0.46 m, ln R = -0.776529, K = G^-1.5; half a unit of the last digit:
//   cone  G = 4.57e-8 exp(0.149 x 0.776529) = 4.57e-8 x 1.122662 = 5.130566e-8,  K = 8.6050e10
//   worn  G = 3.86e-8 exp(0.115 x 0.776529) = 3.86e-8 x 1.093409 = 4.220561e-8,  K = 1.15331e11
TEST(ZhaiContactConstant, OfAWheelOf460MillimetresIsThatWorkedOutByHand) {
  EXPECT_NEAR(easydyn::track::zhai_contact_constant(0.46, false), 8.6050e10, 0.00005e10);
  EXPECT_NEAR(easydyn::track::zhai_contact_constant(0.46, true), 1.15331e11, 0.000005e11);
}

TEST(ZhaiContactConstant, RefusesAnImpossibleRadius) {
  EXPECT_THROW(easydyn::track::zhai_contact_constant(0, true), easydyn::ModelError);
  EXPECT_THROW(easydyn::track::zhai_contact_constant(std::nan(""), false), easydyn::ModelError);
}

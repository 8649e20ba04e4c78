#include "track/profile.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "easydyn/error.hpp"

namespace {

using namespace easydyn::track;

constexpr double R = 0.32, h = 1e-3;

TEST(StepProfile, HasARampOf25MillimetresForAWheelOf320) {
  const StepProfile step(0, h);
  EXPECT_NEAR(step.ramp_length(R), 25.3e-3, 0.05e-3);
  EXPECT_EQ(step.at(-25.4e-3, R).r, 0);
  EXPECT_GT(step.at(-25.2e-3, R).r, 0);
  EXPECT_EQ(step.at(0, R).r, h);
}

TEST(StepProfile, KeepsTheWheelOnTheEdgeAlongTheRamp) {
  const StepProfile step(2, h);
  for (const double s : {-0.025, -0.02, -0.01, -0.001}) {
    const double centre = R + step.at(2 + s, R).r;  // height of the wheel centre above the low side
    EXPECT_NEAR(std::hypot(s, centre - h), R, 1e-15);
  }
}

TEST(StepProfile, StepsDownAsItStepsUpSeenFromBehind) {
  const StepProfile up(1, h), down(1, -h);
  for (const double s : {-0.03, -0.02, -0.005, 0.005, 0.02, 0.03}) {
    EXPECT_NEAR(down.at(1 + s, R).r, up.at(1 - s, R).r - h, 1e-16);
    EXPECT_NEAR(down.at(1 + s, R).dr, -up.at(1 - s, R).dr, 1e-15);
    EXPECT_NEAR(down.at(1 + s, R).ddr, up.at(1 - s, R).ddr, 1e-13);
  }
}

TEST(StepProfile, IsContinuousAndHasASlopeJumpAtFirstTouchAndAtLandingOnly) {
  const double e = 1e-12, slope = std::sqrt(2 * R * h - h * h) / (R - h);
  const StepProfile up(0, h), down(0, -h);
  const double a = up.ramp_length(R);
  for (const double x : {-a, 0.0}) EXPECT_NEAR(up.at(x - e, R).r, up.at(x + e, R).r, 2 * e);
  for (const double x : {0.0, a}) EXPECT_NEAR(down.at(x - e, R).r, down.at(x + e, R).r, 2 * e);
  EXPECT_EQ(up.at(-a - e, R).dr, 0);
  EXPECT_NEAR(up.at(-a + e, R).dr, slope, 1e-9);
  EXPECT_NEAR(up.at(-e, R).dr, 0, 1e-9);
  EXPECT_NEAR(down.at(e, R).dr, 0, 1e-9);
  EXPECT_NEAR(down.at(a - e, R).dr, -slope, 1e-9);
  EXPECT_EQ(down.at(a + e, R).dr, 0);
  EXPECT_NEAR(slope, 0.079, 0.0005);  // the figure quoted in profile.hpp
}

TEST(Profile, DerivativesAgreeWithDifferences) {
  const auto up = std::make_shared<StepProfile>(0, h), down = std::make_shared<StepProfile>(0.01, -2 * h);
  const ProfileSum sum({up, down, std::make_shared<FlatProfile>()});
  const double e = 1e-5;  // central differences of a circle of radius R: error of order (e / R)^2
  for (const double x : {-0.1, -0.02, -0.01, 0.005, 0.02, 0.03, 0.2}) {
    const ProfilePoint p = sum.at(x, R), before = sum.at(x - e, R), after = sum.at(x + e, R);
    EXPECT_NEAR((after.r - before.r) / (2 * e), p.dr, 1e-9);
    EXPECT_NEAR((after.dr - before.dr) / (2 * e), p.ddr, 1e-7);
  }
}

TEST(StepProfile, IsFilteredMoreByALargeWheelThanByASmallOne) {
  const StepProfile step(0, h);
  // r = h - R + sqrt(R^2 - s^2) by hand at s = -10 mm, half a unit of the last digit
  EXPECT_NEAR(step.at(-0.01, 0.32).r, 0.84371e-3, 0.5e-8);
  EXPECT_NEAR(step.at(-0.01, 0.1875).r, 0.73314e-3, 0.5e-8);
  // a = sqrt(h (2 R - h)): the large wheel touches sooner and rises less steeply, slope a / (R - h);
  // 1e-5: a rounded to 0.5e-6 m
  EXPECT_NEAR(step.ramp_length(0.1875), 19.34e-3, 0.005e-3);
  EXPECT_EQ(step.at(-0.02, 0.1875).r, 0);
  EXPECT_GT(step.at(-0.02, 0.32).r, 0);
  EXPECT_NEAR(step.at(-step.ramp_length(0.1875), 0.1875).dr, 19.339e-3 / 0.1865, 1e-5);
  EXPECT_NEAR(step.at(-step.ramp_length(0.32), 0.32).dr, 25.278e-3 / 0.319, 1e-5);
}

TEST(StepProfile, OfNoHeightIsFlat) {
  const StepProfile step(0, 0);
  for (const double x : {-1e-3, 0.0, 1e-3}) EXPECT_EQ(step.at(x, R).r, 0);
}

TEST(StepProfile, RefusesAStepAsHighAsTheWheelAndBadNumbers) {
  using testing::HasSubstr;
  using testing::ThrowsMessage;
  EXPECT_THAT(
      [] { StepProfile(0, 0.4).at(0, R); },
      ThrowsMessage<easydyn::ModelError>(HasSubstr("wheel radius = 0.32 m, must be > |height| = 0.4 m")));
  EXPECT_THROW(StepProfile(0, std::numeric_limits<double>::quiet_NaN()), easydyn::ModelError);
  EXPECT_THROW(StepProfile(std::numeric_limits<double>::infinity(), h), easydyn::ModelError);
  EXPECT_THROW(ProfileSum({nullptr}), easydyn::ModelError);
}

}  // namespace

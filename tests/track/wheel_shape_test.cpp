#include "track/wheel_shape.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "easydyn/error.hpp"
#include "track/contact_loss_counter.hpp"
#include "track/defects.hpp"
#include "track/wheel_rail_contact.hpp"

namespace {

using namespace easydyn::track;
using easydyn::ModelError;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double R = 0.46, l = 0.05, pi = 3.14159265358979323846;

TEST(WheelFlat, FreshIsPassedLikeAGapOfItsLength) {
  // the corners of the chord stand on the rail as the edges of a gap stand under the rim
  const WheelFlat flat = WheelFlat::fresh(l);
  const auto gap = rail_gap(-l / 2, {.width = l});
  for (double s = -0.04; s < 0.04; s += 0.00171) {
    const ProfilePoint a = flat.at(s / R, R), b = gap->at(s, R);
    EXPECT_NEAR(a.r, b.r, 1e-15) << s;
    EXPECT_NEAR(a.dr, b.dr, 1e-13) << s;
    EXPECT_NEAR(a.ddr, b.ddr, 1e-11) << s;
  }
  EXPECT_NEAR(flat.depth(R) / (l * l / (8 * R)), 1, 1e-3);  // the square's error (l / R)^2 / 16 = 7e-4
  EXPECT_NEAR(flat.at(1e-12, R).dr - flat.at(-1e-12, R).dr, l / R, 2e-4);
}

TEST(WheelFlat, FreshIsTheHeightOfAWheelWithAChordCutOff) {
  // lowest point of the outline turned by the angle f from the chord: the corner, R cos(asin(l / 2R) - |f|)
  // below the centre. The path takes R f for the distance, the pivoting wheel R sin: l^4 / (64 R^3) = 1e-6 m at
  // most.
  const WheelFlat flat = WheelFlat::fresh(l);
  const double half = std::asin(l / 2 / R);
  for (double f = -half; f < half; f += half / 17)
    EXPECT_NEAR(flat.at(f, R).r, R * std::cos(half - std::abs(f)) - R, std::pow(l, 4) / (64 * R * R * R));
}

TEST(WheelFlat, ComesOncePerRevolution) {
  for (const WheelFlat& flat : {WheelFlat::fresh(l, 1), WheelFlat::rounded(l, 0, 1)}) {
    for (const double turns : {-3.0, 0.0, 1.0, 40.0}) {
      EXPECT_NEAR(flat.at(1 + 2 * pi * turns, R).r, -flat.depth(R), 1e-12);
      EXPECT_NEAR(flat.at(1.02 + 2 * pi * turns, R).r, flat.at(1.02, R).r, 1e-12);
      EXPECT_EQ(flat.at(1 + pi + 2 * pi * turns, R).r, 0);
    }
  }
}

TEST(WheelFlat, RoundedIsSmoothAndAsDeep) {
  const WheelFlat flat = WheelFlat::rounded(l), deep = WheelFlat::rounded(l, 1e-3);
  EXPECT_NEAR(flat.depth(R), l * l / (8 * R), 1e-16);
  EXPECT_NEAR(deep.depth(R), 1e-3, 1e-16);
  for (const double s : {-l / 2, 0.0, l / 2}) {
    EXPECT_NEAR(flat.at((s - 1e-9) / R, R).dr, flat.at((s + 1e-9) / R, R).dr, 1e-7);
    EXPECT_NEAR(flat.at(s / R, R).dr, 0, 1e-12);
  }
}

TEST(WheelShape, HasDerivativesWithRespectToTheDistance) {
  const auto flat = std::make_shared<WheelFlat>(WheelFlat::fresh(l)),
             worn = std::make_shared<WheelFlat>(WheelFlat::rounded(l, 0, 2));
  const auto polygon = std::make_shared<OutOfRoundness>(
      std::vector<OutOfRoundness::Order>{{1, 2e-4, 0.3}, {6, 1e-4}, {20, 1e-5, 1}});
  const WheelShapeSum sum({flat, worn, polygon});
  const double e = 1e-6;  // differences: error of order (e k)^2
  for (const double angle : {-0.03, 0.02, 0.5, 1.99, 2.03, 4.0}) {
    const ProfilePoint p = sum.at(angle, R), a = sum.at(angle - e / R, R), b = sum.at(angle + e / R, R);
    EXPECT_NEAR(p.dr, (b.r - a.r) / (2 * e), 1e-9);
    EXPECT_NEAR(p.ddr, (b.dr - a.dr) / (2 * e), 1e-7);
  }
}

TEST(OutOfRoundness, IsASumOfCosinesOfTheAngle) {
  const OutOfRoundness polygon({{3, 1e-4, 0.5}});
  EXPECT_NEAR(polygon.at(0.5 / 3, R).r, 1e-4, 1e-18);
  EXPECT_NEAR(polygon.at(0.5 / 3 + pi / 3, R).r, -1e-4, 1e-18);
  EXPECT_NEAR(polygon.at(0.7 + 2 * pi, R).r, polygon.at(0.7, R).r, 1e-17);
  EXPECT_NEAR(polygon.at(0.5 / 3, R).ddr, -1e-4 * 9 / (R * R), 1e-15);
}

TEST(WheelShape, RefusesImpossibleValues) {
  EXPECT_THROW(WheelFlat::fresh(0), ModelError);
  EXPECT_THROW(WheelFlat::rounded(l, -1e-3), ModelError);
  EXPECT_THROW(WheelFlat::fresh(l, std::nan("")), ModelError);
  EXPECT_THAT([] { WheelFlat::fresh(1).at(0, 0.4); },
              ThrowsMessage<ModelError>(HasSubstr("wheel radius = 0.4 m, must be > length / 2 = 0.5 m")));
  EXPECT_THROW(OutOfRoundness({{0, 1e-4}}), ModelError);
  EXPECT_THROW(OutOfRoundness({{1, std::nan("")}}), ModelError);
  EXPECT_THROW(WheelShapeSum({nullptr}), ModelError);
}

TEST(WheelRailContact, AddsTheShapeOfTheWheelToTheProfile) {
  const auto step = std::make_shared<StepProfile>(0, 1e-3);
  WheelRailContact contact("wheel", HertzContact(), R, 1e5, step);
  EXPECT_EQ(contact.path_at(0.1).r, 1e-3);
  const auto polygon = std::make_shared<OutOfRoundness>(std::vector<OutOfRoundness::Order>{{2, 1e-4}});
  contact.set_wheel_shape(polygon, {.phase = 0.2});
  const ProfilePoint own = polygon->at(0.1 / R + 0.2, R);
  EXPECT_NEAR(contact.path_at(0.1).r, 1e-3 + own.r, 1e-18);
  EXPECT_NEAR(contact.path_at(0.1).dr, own.dr, 1e-18);
  EXPECT_NEAR(contact.path_at(0.1).ddr, own.ddr, 1e-15);

  contact.set_wheel_shape(polygon, {.fade_begin = 1, .fade_length = 2});
  EXPECT_EQ(contact.path_at(0.9).r, 1e-3);
  EXPECT_NEAR(contact.path_at(2).r, 1e-3 + polygon->at(2 / R, R).r / 2, 1e-17);
  EXPECT_NEAR(contact.path_at(3.3).r, 1e-3 + polygon->at(3.3 / R, R).r, 1e-17);
  const double e = 1e-6;
  EXPECT_NEAR(contact.path_at(1.7).dr, (contact.path_at(1.7 + e).r - contact.path_at(1.7 - e).r) / (2 * e),
              1e-9);

  contact.set_wheel_shape(nullptr);
  EXPECT_EQ(contact.path_at(3.3).r, 1e-3);
  EXPECT_THROW(contact.set_wheel_shape(polygon, {.fade_length = -1}), ModelError);
  EXPECT_THAT([&] { contact.set_wheel_shape(std::make_shared<WheelFlat>(WheelFlat::fresh(1))); },
              ThrowsMessage<ModelError>(HasSubstr("wheel radius = 0.46 m")));
}

TEST(ContactLossCounter, CountsLossesAndTheirDurations) {
  ContactLossCounter losses;
  // closed to 1 s, open to 3 s, closed to 4 s, open to 5 s and on
  const bool closed[] = {true, true, false, false, true, false};
  for (int i = 0; i < 6; ++i) losses.update(i, closed[i]);
  EXPECT_EQ(losses.count(), 2);
  EXPECT_EQ(losses.total_duration(), 3);
  EXPECT_EQ(losses.longest_duration(), 2);
  EXPECT_TRUE(losses.is_open());
  losses.update(8, false);
  EXPECT_EQ(losses.count(), 2);
  EXPECT_EQ(losses.total_duration(), 6);
  EXPECT_EQ(losses.longest_duration(), 4);
}

TEST(ContactLossCounter, BeginsInEitherState) {
  ContactLossCounter open, closed;
  open.update(5, false);
  EXPECT_EQ(open.count(), 1);
  EXPECT_EQ(open.total_duration(), 0);
  open.update(5.5, true);
  EXPECT_EQ(open.total_duration(), 0);
  EXPECT_FALSE(open.is_open());
  EXPECT_EQ(closed.count(), 0);
  closed.update(0, true);
  EXPECT_EQ(closed.count(), 0);
}

TEST(ContactLossCounter, RefusesTimeThatDoesNotAdvance) {
  ContactLossCounter losses;
  losses.update(1, true);
  EXPECT_THAT([&] { losses.update(1, true); },
              ThrowsMessage<ModelError>(HasSubstr("time = 1 s, must be > 1 s")));
  EXPECT_THROW(losses.update(std::nan(""), true), ModelError);
}

}  // namespace

#include "track/defects.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <thread>

#include "easydyn/error.hpp"
#include "track/polyline_profile.hpp"
#include "track/rolled_profile.hpp"

namespace {

using namespace easydyn::track;
using easydyn::ModelError;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double R = 0.46, pi = 3.14159265358979323846;

class Surface : public Profile {
 public:
  explicit Surface(std::function<ProfilePoint(double)> p) : p_(std::move(p)) {}
  ProfilePoint at(double x, double) const override { return p_(x); }

 private:
  std::function<ProfilePoint(double)> p_;
};

std::shared_ptr<const Surface> surface(std::function<ProfilePoint(double)> p) {
  return std::make_shared<Surface>(std::move(p));
}

// max over s by trial at steps of 2e-6 m: low by (p'' + 1/R) (1e-6 m)^2 / 2, below 1e-11 m.
double brute_force(const std::function<double(double)>& p, double x, double radius) {
  double best = -1;
  for (int i = -100000; i <= 100000; ++i) {
    const double s = 2e-6 * i;
    if (std::abs(s) < radius)
      best = std::max(best, p(x + s) - s * s / (radius + std::sqrt(radius * radius - s * s)));
  }
  return best;
}

// Slope and curvature by differences, away from kinks.
void expect_consistent(const Profile& profile, double x, double slope_tolerance, double curvature_tolerance) {
  const double e = 1e-6;
  const ProfilePoint p = profile.at(x, R), a = profile.at(x - e, R), b = profile.at(x + e, R);
  EXPECT_NEAR(p.dr, (b.r - a.r) / (2 * e), slope_tolerance) << x;
  EXPECT_NEAR(p.ddr, (b.dr - a.dr) / (2 * e), curvature_tolerance) << x;
}

TEST(PolylineProfile, OfAVerticalEdgeIsTheStep) {
  for (const double h : {3e-3, -3e-3}) {
    const PolylineProfile edge("edge", {{2, 0}, {2, h}});
    const StepProfile step(2, h);
    for (double x = 1.9; x < 2.1; x += 0.00137) {
      const ProfilePoint a = edge.at(x, R), b = step.at(x, R);
      EXPECT_NEAR(a.r, b.r, 1e-16);
      EXPECT_NEAR(a.dr, b.dr, 1e-14);
      EXPECT_NEAR(a.ddr, b.ddr, 1e-12);
    }
  }
}

TEST(PolylineProfile, RunsParallelToASlopeAndBridgesAValley) {
  // slopes -+m meet in a valley at x = 0: the wheel touches both sides, its centre on the bisector, where
  // r = -R + R sqrt(1 + m^2) above the bottom (by hand: the distance of the centre from both lines is R)
  const double m = 0.01, n = std::sqrt(1 + m * m);
  const PolylineProfile valley("valley", {{-1, 0}, {0, -m}, {1, 0}});
  EXPECT_NEAR(valley.at(0, R).r, -m + R * (n - 1), 1e-15);
  EXPECT_NEAR(valley.at(-0.5, R).r, -m / 2 + R * (n - 1), 1e-15);
  EXPECT_NEAR(valley.at(0, R).dr, m, 1e-15);  // of the side ahead
  EXPECT_NEAR(valley.at(-1e-9, R).dr, -m, 1e-15);
  EXPECT_EQ(valley.at(-1.5, R).r, 0);
  EXPECT_EQ(valley.at(1.5, R).r, 0);
}

TEST(PolylineProfile, AgreesWithBruteForce) {
  const std::vector<PolylineProfile::Point> points = {
      {0, 0}, {0.1, -2e-3}, {0.1, -4e-3}, {0.12, -1e-3}, {0.15, 1e-3}};
  const PolylineProfile path("polyline", points);
  const auto p = [&](double x) {
    if (x <= points.front().x) return points.front().y;
    for (std::size_t i = 1; i < points.size(); ++i)
      if (x <= points[i].x && points[i].x > points[i - 1].x)
        return points[i - 1].y +
               (points[i].y - points[i - 1].y) * (x - points[i - 1].x) / (points[i].x - points[i - 1].x);
    return points.back().y;
  };
  // 4e-8: a corner may be missed by 2e-6 m on a slope of 0.1, less where the wheel's is alike; measured 1e-10
  for (double x = -0.1; x < 0.25; x += 0.0093)
    for (const double radius : {0.1875, 0.46})
      EXPECT_NEAR(path.at(x, radius).r, brute_force(p, x, radius), 1e-9) << x;
}

TEST(PolylineProfile, RefusesImpossiblePointsAndWheels) {
  EXPECT_THROW(PolylineProfile("p", {}), ModelError);
  EXPECT_THAT(
      [] {
        PolylineProfile("p", {{1, 0}, {0, 0}});
      },
      ThrowsMessage<ModelError>(HasSubstr("position of point 2 = 0 m, must be >= 1 m")));
  EXPECT_THROW(PolylineProfile("p", {{0, std::nan("")}}), ModelError);
  EXPECT_THAT(
      [] {
        PolylineProfile("p", {{0, 0}, {0, 0.2}}).at(0, 0.1);
      },
      ThrowsMessage<ModelError>(HasSubstr("wheel radius = 0.1 m, must be > 0.2 m")));
}

TEST(RolledProfile, OfAStepIsItsClosedForm) {
  for (const double h : {1e-3, 3e-3, -3e-3}) {
    const auto raw = surface([h](double x) { return ProfilePoint{x < 2 ? 0 : h, 0, 0}; });
    const RolledProfile rolled("step", raw, {.begin = 1.95, .end = 2.05, .breaks = {2}});
    const StepProfile step(2, h);
    const double a = step.ramp_length(R), kink = h > 0 ? 2 - a : 2 + a, corner = 2;
    const std::vector<double> kinks = rolled.kinks(R);
    ASSERT_EQ(kinks.size(), 1u);
    EXPECT_NEAR(kinks[0], kink, 1e-10);  // found by bisection to 1e-11
    for (double x = 1.9; x < 2.1; x += 0.000173) {
      const ProfilePoint p = rolled.at(x, R), exact = step.at(x, R);
      // in the cell of the edge, where r'' jumps by 1/R: step^2 / R / 50 = 3e-9; elsewhere rounding
      const bool at_corner = std::abs(x - corner) < 5e-4;
      EXPECT_NEAR(p.r, exact.r, at_corner ? 3e-9 : 1e-13) << x;
      EXPECT_NEAR(p.dr, exact.dr, at_corner ? 1e-4 : 1e-9) << x;
      if (!at_corner) {
        EXPECT_NEAR(p.ddr, exact.ddr, 1e-6) << x;
      }
      EXPECT_NEAR(rolled.compute(x, R).r, exact.r, 1e-15) << x;
    }
  }
}

TEST(RolledProfile, IsTheSurfaceItselfWhereTheWheelFitsButForItsSlope) {
  // parallel curve: the contact lies at c = x + R sin(slope angle); here by Newton's iteration, written out
  const double A = 1e-3, k = 2 * pi / 0.8;  // A k^2 = 0.06 << 1/R
  const auto raw = surface([=](double x) {
    return ProfilePoint{A * std::sin(k * x), A * k * std::cos(k * x), -A * k * k * std::sin(k * x)};
  });
  const RolledProfile rolled("wave", raw, {.begin = 0, .end = 1.6});
  EXPECT_TRUE(rolled.kinks(R).size() <= 2);  // where the wave joins the level ends, in valleys
  for (double x = 0.2; x < 1.4; x += 0.0137) {
    double c = x;
    for (int i = 0; i < 50; ++i) c = x + R * std::sin(std::atan(A * k * std::cos(k * c)));
    const double exact = A * std::sin(k * c) + std::sqrt(R * R - (c - x) * (c - x)) - R;
    EXPECT_NEAR(rolled.at(x, R).r, exact, 1e-13);
    EXPECT_NEAR(rolled.at(x, R).dr, A * k * std::cos(k * c), 1e-9);
    // r'' = p'' g / (g - p''), g = R^2 / (R^2 - s^2)^(3/2); the cubic's own error h^2 r'''' / 12
    const double g = R * R / std::pow(R * R - (c - x) * (c - x), 1.5), p2 = -A * k * k * std::sin(k * c);
    EXPECT_NEAR(rolled.compute(x, R).ddr, p2 * g / (g - p2), 1e-9);
    EXPECT_NEAR(rolled.at(x, R).ddr, p2 * g / (g - p2), 1e-6);
  }
}

TEST(RolledProfile, OfACrossingIsTheExactPolyline) {
  const std::vector<PolylineProfile::Point> points = {{-0.5, 0}, {0, -2e-3}, {0, -4e-3}, {0.3, 0}};
  const auto raw = surface([](double x) {
    if (x <= -0.5 || x >= 0.3) return ProfilePoint{};
    if (x < 0) return ProfilePoint{-4e-3 * (x + 0.5), -4e-3, 0};
    return ProfilePoint{-4e-3 + 4e-3 / 0.3 * x, 4e-3 / 0.3, 0};
  });
  const PolylineProfile exact("crossing", points);
  const RolledProfile rolled("crossing", raw, {.begin = -0.5, .end = 0.3, .breaks = {-0.5, 0, 0.3}});
  for (double x = -0.6; x < 0.4; x += 0.00071) {
    // where the wheel rolls onto or off a corner r'' jumps by 1/R: step^2 / R / 50 = 3e-9
    EXPECT_NEAR(rolled.at(x, R).r, exact.at(x, R).r, 3e-9) << x;
    EXPECT_NEAR(rolled.compute(x, R).r, exact.at(x, R).r, 1e-14) << x;
  }
}

TEST(RolledProfile, GivesTheSameToSeveralThreads) {
  const auto joint = dipped_joint(0);
  std::vector<double> seen(4);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < 4; ++i)
    threads.emplace_back([&, i] { seen[i] = joint->at(0.01, i % 2 ? 0.46 : 0.32).r; });
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(seen[0], seen[2]);
  EXPECT_EQ(seen[1], seen[3]);
  EXPECT_NE(seen[0], seen[1]);
}

TEST(RolledProfile, RefusesImpossibleOptions) {
  const auto flat = std::make_shared<FlatProfile>();
  EXPECT_THROW(RolledProfile("r", nullptr, {.begin = 0, .end = 1}), ModelError);
  EXPECT_THROW(RolledProfile("r", flat, {.begin = 1, .end = 1}), ModelError);
  EXPECT_THROW(RolledProfile("r", flat, {.begin = 0, .end = 1, .step = 0}), ModelError);
  EXPECT_THROW(RolledProfile("r", flat, {.begin = 0, .end = 1, .step = 0.5}), ModelError);
  EXPECT_THROW(RolledProfile("r", flat, {.begin = 0, .end = 1, .step = 1e-9}), ModelError);
  EXPECT_THAT([&] { RolledProfile("r", flat, {.begin = 0, .end = 1, .breaks = {2}}); },
              ThrowsMessage<ModelError>(HasSubstr("break = 2 m, must be 0 m to 1 m")));
  const auto high = surface([](double x) { return ProfilePoint{x, 1, 0}; });
  EXPECT_THROW(RolledProfile("r", high, {.begin = 0, .end = 1}).at(0.5, R), ModelError);
}

TEST(DippedJoint, IsThatOfKaboSeenThroughTheWheel) {
  const auto joint = dipped_joint(5, {.depth = 3e-3, .length = 1});
  const auto p = [](double x) {
    const double s = 0.5 - std::abs(x - 5);
    return s > 0 ? -3e-3 * (1 - std::cos(pi * s)) : 0;
  };
  for (double x = 4.4; x < 5.6; x += 0.0371) EXPECT_NEAR(joint->at(x, R).r, brute_force(p, x, R), 1e-10) << x;
  for (const double x : {4.99, 4.997, 5.0, 5.002, 5.01})
    EXPECT_NEAR(joint->at(x, R).r, brute_force(p, x, R), 1e-10);
  // over the joint: both sides have the slope 3 mm pi, nearly straight over the 4 mm between the contacts, so that
  // r = -3 mm + R (sqrt(1 + slope^2) - 1), as over a straight valley; curvature 0.03/m (2 R slope)^2 / 8 < 3e-7
  const double slope = 3e-3 * pi;
  EXPECT_NEAR(joint->at(5, R).r, -3e-3 + R * (std::sqrt(1 + slope * slope) - 1), 3e-7);
  EXPECT_NEAR(joint->at(5 + 1e-7, R).dr, slope, 1e-5);
  EXPECT_NEAR(joint->at(5 - 1e-7, R).dr, -slope, 1e-5);
  const auto& rolled = dynamic_cast<const RolledProfile&>(*joint);
  ASSERT_EQ(rolled.kinks(R).size(), 1u);
  EXPECT_NEAR(rolled.kinks(R)[0], 5, 1e-10);
  for (const double x : {4.3, 4.6, 4.9, 4.98, 5.02, 5.3, 5.6}) expect_consistent(*joint, x, 1e-8, 1e-4);
}

TEST(Pulse, IsABumpOrAHollowSeenThroughTheWheel) {
  for (const double height : {1e-3, -1e-3})
    for (const double length : {0.05, 0.4}) {
      const auto bump = pulse(1, {.height = height, .length = length});
      const auto p = [=](double x) {
        return std::abs(x - 1) < length / 2 ? height / 2 * (1 + std::cos(2 * pi * (x - 1) / length)) : 0;
      };
      for (double x = 0.75; x < 1.25; x += 0.0213)
        EXPECT_NEAR(bump->at(x, R).r, brute_force(p, x, R), 1e-9) << x;
      if (height > 0) {
        EXPECT_NEAR(bump->at(1, R).r, height, 1e-12);
      }
    }
  // a hollow of 5 cm and 1 mm, curvature 8/m > 1/R: the wheel bridges it and sinks to 0.68 mm at most, l^2 / (8 R)
  EXPECT_GT(pulse(0, {.height = -1e-3, .length = 0.05})->at(0, R).r, -0.05 * 0.05 / (8 * R));
}

TEST(RailGap, LetsTheWheelDipByTheSquareOfItsWidth) {
  const auto gap = rail_gap(0, {.width = 20e-3});
  EXPECT_NEAR(gap->at(10e-3, R).r, std::sqrt(R * R - 1e-4) - R, 1e-16);  // on both edges
  EXPECT_NEAR(gap->at(10e-3, R).r, -4e-4 / (8 * R), 1e-7);
  EXPECT_EQ(gap->at(-1e-6, R).r, 0);
  EXPECT_EQ(gap->at(20.001e-3, R).r, 0);
  // kink of 2 (width / 2) / sqrt(R^2 - width^2 / 4)
  EXPECT_NEAR(gap->at(10e-3 + 1e-9, R).dr - gap->at(10e-3 - 1e-9, R).dr, 20e-3 / std::sqrt(R * R - 1e-4),
              1e-7);
  const auto high = rail_gap(0, {.width = 20e-3, .height_difference = 2e-3});
  EXPECT_NEAR(high->at(0.02, R).r, 2e-3, 1e-16);
  // before the second edge as over a step of 2 mm there
  EXPECT_NEAR(high->at(0.0, R).r, std::max(0.0, StepProfile(0.02, 2e-3).at(0, R).r), 1e-16);
  EXPECT_NEAR(rail_gap(0, {.width = 20e-3, .height_difference = -2e-3})->at(0.1, R).r, -2e-3, 1e-16);
}

TEST(SwitchAndCrossing, AreContinuousEndLevelAndTurnAroundWhenTrailing) {
  const auto facing = crossing(3, {.gap = 0.04}), trailing = crossing(3, {.gap = 0.04, .is_trailing = true});
  const auto blade = switch_transfer(3, {.height_difference = 1e-3}),
             back = switch_transfer(3, {.height_difference = 1e-3, .is_trailing = true});
  for (double x = -1.5; x < 1.5; x += 0.00517) {
    for (const auto& profile : {facing, trailing, blade, back})
      EXPECT_NEAR(profile->at(3 + x, R).r, profile->at(3 + x + 1e-9, R).r, 1e-9 * 0.3);
    EXPECT_NEAR(facing->at(3 + x, R).r, trailing->at(3 - x, R).r, 1e-15);
    EXPECT_NEAR(blade->at(3 + x, R).r, back->at(3 - x, R).r, 1e-15);
  }
  for (const auto& profile : {facing, trailing, blade, back})
    for (const double x : {1.5, 4.5}) EXPECT_EQ(profile->at(x, R).r, 0);
  // half-way along the wing: 1 mm down, R m^2 / 2 up (m = 2 mm / 0.5 m)
  EXPECT_NEAR(facing->at(2.75, R).r, -1e-3 + R * (std::sqrt(1 + 16e-6) - 1), 1e-15);
  // on the last point of the wing and before that of the nose
  EXPECT_NEAR(facing->at(3, R).r, -2e-3, 1e-5);
  for (const double x : {2.6, 2.9, 3.01, 3.03, 3.2}) expect_consistent(*facing, x, 1e-7, 1e-5);
}

TEST(Defects, RefuseImpossibleSizes) {
  const double nan = std::nan("");
  EXPECT_THROW(dipped_joint(0, {.depth = -1e-3}), ModelError);
  EXPECT_THROW(dipped_joint(nan), ModelError);
  EXPECT_THROW(pulse(0, {.length = 0}), ModelError);
  EXPECT_THROW(pulse(0, {.height = nan}), ModelError);
  EXPECT_THROW(rail_gap(0, {.width = 0}), ModelError);
  EXPECT_THROW(switch_transfer(0, {.length = -1}), ModelError);
  EXPECT_THROW(crossing(0, {.gap = -1e-3}), ModelError);
  EXPECT_THAT([] { crossing(0, {.nose_depth = -1e-3}); },
              ThrowsMessage<ModelError>(HasSubstr("crossing: nose depth = -0.001 m, must be >= 0")));
}

}  // namespace

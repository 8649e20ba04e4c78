#include "track/profile_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "easydyn/error.hpp"
#include "tests/temporary_folder.hpp"

namespace {

using namespace easydyn::track;
using easydyn::InputError;
using easydyn::ModelError;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double R = 0.4, pi = 3.14159265358979323846;

TEST(SplineProfile, IsExactForACubicThatIsLevelAtBothEnds) {
  const auto f = [](double x) { return x * x * (3 - 2 * x); };
  std::vector<double> x = {0, 0.1, 0.35, 0.4, 0.8, 1}, r;
  for (const double place : x) r.push_back(f(place));
  const SplineProfile s("cubic", x, r);
  for (double place = 0; place <= 1; place += 0.0137) {
    EXPECT_NEAR(s.at(place, R).r, f(place), 1e-15);
    EXPECT_NEAR(s.at(place, R).dr, 6 * place * (1 - place), 1e-13);
    EXPECT_NEAR(s.at(place, R).ddr, 6 - 12 * place, 1e-12);
  }
}

TEST(SplineProfile, ConvergesAtFourthOrderAndIsTwiceContinuouslyDifferentiable) {
  const auto error = [](int pieces) {
    std::vector<double> x, r;
    for (int i = 0; i <= pieces; ++i) {
      x.push_back(2.0 * i / pieces);
      r.push_back(1e-3 * std::cos(pi * x.back()));
    }
    const SplineProfile s("cosine", x, r);
    for (int i = 1; i < pieces; ++i) {
      const double e = 1e-10, at = x[static_cast<std::size_t>(i)];
      EXPECT_NEAR(s.at(at - e, R).ddr, s.at(at + e, R).ddr, 1e-9);  // 2 e r''' < 1e-11
    }
    double worst = 0;
    for (double place = 0; place <= 2; place += 0.00317)
      worst = std::max(worst, std::abs(s.at(place, R).r - 1e-3 * std::cos(pi * place)));
    return worst;
  };
  const double coarse = error(20), fine = error(40);
  EXPECT_NEAR(std::log2(coarse / fine), 4, 0.1);
  // h^4 max|r''''| 5/384 = 0.05^4 1e-3 pi^4 5/384 = 7.9e-9
  EXPECT_LT(fine, 8e-9);
}

TEST(SplineProfile, GoesOnLevelOrTapersToZero) {
  const std::vector<double> x = {0, 1, 2, 3, 4, 5}, r = {1e-3, 2e-3, 1e-3, 3e-3, 2e-3, 2e-3};
  const SplineProfile held("p", x, r), zero("p", x, r, {.beyond = BeyondPoints::zero, .taper = 2});
  EXPECT_EQ(held.at(-1, R).r, 1e-3);
  EXPECT_EQ(held.at(6, R).r, 2e-3);
  EXPECT_EQ(held.at(6, R).dr, 0);
  EXPECT_NEAR(held.at(1e-9, R).dr, 0, 1e-11);
  EXPECT_EQ(zero.at(-1, R).r, 0);
  EXPECT_EQ(zero.at(6, R).r, 0);
  EXPECT_NEAR(zero.at(1e-6, R).r, 0, 1e-18);
  EXPECT_NEAR(zero.at(1, R).r, 1e-3, 1e-16);  // half-way up the taper: a half of 2 mm
  EXPECT_NEAR(zero.at(2.5, R).r, held.at(2.5, R).r, 1e-18);
  const double e = 1e-5;  // differences: error of order e^2 r'''
  for (const double place : {0.3, 1.7, 2.4, 4.1}) {
    EXPECT_NEAR(zero.at(place, R).dr, (zero.at(place + e, R).r - zero.at(place - e, R).r) / (2 * e), 1e-10);
    EXPECT_NEAR(zero.at(place, R).ddr, (zero.at(place + e, R).dr - zero.at(place - e, R).dr) / (2 * e), 1e-9);
  }
}

TEST(SplineProfile, RefusesImpossiblePoints) {
  const std::vector<double> x = {0, 1, 2, 3}, r = {0, 1e-3, 0, 0};
  EXPECT_THAT(
      [] {
        SplineProfile("p", {0, 1, 2}, {0, 0, 0});
      },
      ThrowsMessage<ModelError>(HasSubstr("number of points = 3, must be >= 4")));
  EXPECT_THAT(
      [&] {
        SplineProfile("p", {0, 1, 1, 2}, r);
      },
      ThrowsMessage<ModelError>(HasSubstr("position of point 3 = 1 m, must be > 1 m")));
  EXPECT_THROW(SplineProfile("p", {0, 1, 2, std::nan("")}, r), ModelError);
  EXPECT_THROW(SplineProfile("p", x, {0, 0, std::nan(""), 0}), ModelError);
  EXPECT_THROW(SplineProfile("p", x, {0, 0, 0}), ModelError);
  EXPECT_THROW(SplineProfile("p", x, {1e-3, 0, 0, 0}, {.beyond = BeyondPoints::zero}), ModelError);
  EXPECT_THROW(SplineProfile("p", x, r, {.beyond = BeyondPoints::zero, .taper = 1.6}), ModelError);
  EXPECT_THROW(SplineProfile("p", x, r, {.beyond = BeyondPoints::held, .taper = 1}), ModelError);
}

class ProfileFile : public testing::Test {
 protected:
  SplineProfile read(const std::string& text, const ProfileFileOptions& options = {}) {
    std::ofstream(path_, std::ios::binary) << text;
    return read_profile(path_, options);
  }
  // The message after the name of the file: ":line:column: what".
  void expect_refusal(const std::string& text, const std::string& message,
                      const ProfileFileOptions& options = {}) {
    EXPECT_THAT([&] { read(text, options); }, ThrowsMessage<InputError>(HasSubstr("profile.csv" + message)))
        << text;
  }

 private:
  easydyn::testing::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "profile.csv";
};

TEST_F(ProfileFile, IsReadWithUnitsOfTheHeader) {
  const auto p = read("# measured\nx [m], r [mm]\n0, 0\n0.25, 0.4 # top\n\n+0.5,-1e-1\n1,0\n");
  EXPECT_EQ(p.x(), (std::vector<double>{0, 0.25, 0.5, 1}));
  EXPECT_EQ(p.r(), (std::vector<double>{0, 0.4 * 1e-3, -0.1 * 1e-3, 0}));
  EXPECT_EQ(p.at(0.25, R).r, 0.4 * 1e-3);
}

TEST_F(ProfileFile, IsReadWithSemicolonsWindowsLinesAByteOrderMarkAndUnitsOfTheOptions) {
  const auto p = read(
      "\xEF\xBB\xBF"
      "0;0\r\n1;2\r\n2;1\r\n3;0\r\n",
      {.x_unit = "km", .r_unit = "um"});
  EXPECT_EQ(p.x(), (std::vector<double>{0, 1000, 2000, 3000}));
  EXPECT_EQ(p.r()[1], 2 * 1e-6);
  const auto named = read("position;height\n0;0\n1;2\n2;1\n3;0", {.x_unit = "m", .r_unit = "mm"});
  EXPECT_EQ(named.r()[1], 2 * 1e-3);
}

TEST_F(ProfileFile, IsRefusedWhereItIsMalformed) {
  const std::string header = "x [m],r [mm]\n", rows = "0,0\n1,0\n2,0\n";
  expect_refusal("", ":1:1: 0 points, must be >= 4");
  expect_refusal(header + rows, ":4:1: 3 points, must be >= 4");
  expect_refusal(header + rows + "3\n", ":5:1: \"3\", must be two columns separated by ,");
  expect_refusal(header + rows + "3,1,2\n", ":5:1: \"3,1,2\", must be two columns");
  expect_refusal(header + rows + "3;1\n", ":5:1: \"3;1\", must be two columns separated by ,");
  expect_refusal(header + rows + "3, one\n", ":5:4: height \"one\", must be a number with a decimal point");
  expect_refusal(header + rows + "3,\n", ":5:3: height \"\", must be a number");
  expect_refusal(header + rows + "3, 1.5 mm\n", ":5:4: height \"1.5 mm\", must be a number");
  expect_refusal("x [m];r [mm]\n0;0,5\n", ":2:3: height \"0,5\", must be a number with a decimal point");
  expect_refusal(header + rows + "3, nan\n", ":5:4: height = nan, must be finite");
  expect_refusal(header + rows + "inf,0\n", ":5:1: position = inf, must be finite");
  expect_refusal(header + rows + "3,1e999\n", ":5:3: height \"1e999\", must be a number");
  expect_refusal(header + rows + "2,0\n", ":5:1: position = 2 m, must be > 2 m");
  expect_refusal(header + rows + "1.5,0\n", ":5:1: position = 1.5 m, must be > 2 m");
  expect_refusal("nan,0\n", ":1:1: position = nan, must be finite", {.x_unit = "m", .r_unit = "m"});
  expect_refusal("just words\n", ":1:1: \"just words\", must be two columns separated by , or ;");
}

TEST_F(ProfileFile, IsRefusedWithoutOrWithDoubtfulUnits) {
  expect_refusal("0,0\n1,0\n2,0\n3,0\n", ":1:1: the unit of x is not known");
  expect_refusal("x [m],r\n0,0\n", ":2:1: the unit of r is not known");
  expect_refusal("x [m],r [inch]\n0,0\n", ":1:9: unit \"inch\", must be m, dm, cm, mm, um or km");
  expect_refusal("x [m],r [mm\n0,0\n", ":1:7: \"r [mm\", must be a name and a unit in brackets");
  expect_refusal("x [m],r [mm]\n0,0\n", ":1:9: unit \"mm\", must be \"m\" as in the options",
                 {.r_unit = "m"});
  expect_refusal("x [m],r [mm]\n", ": unit \"ft\" in the options", {.x_unit = "ft"});
}

TEST_F(ProfileFile, SaysWhatTheWholeShows) {
  expect_refusal("x [m],r [m]\n0,1e-3\n1,0\n2,0\n3,0\n",
                 ":5:1: profile \"profile.csv\": height of an end = 0.001 m",
                 {.spline = {.beyond = BeyondPoints::zero}});
  EXPECT_THROW(read_profile("/no/such/profile.csv"), InputError);
}

}  // namespace

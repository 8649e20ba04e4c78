#include "easydyn/visu/chart.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "easydyn/error.hpp"
#include "easydyn/visu/json.hpp"
#include "tests/temporary_folder.hpp"

using namespace easydyn;
using namespace easydyn::visu;
using easydyn::testing::message_of;
using ::testing::HasSubstr;

namespace {

const double gap = std::numeric_limits<double>::quiet_NaN();

Chart chart_of(Eigen::VectorXd x, Eigen::VectorXd y) {
  return {.title = "force", .x = {"time", "s"}, .y = {"force", "kN"}, .series = {{"wheel", x, y}}};
}

}  // namespace

TEST(Thinning, KeepsAShortCurveWhole) {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(100, 0, 1);
  EXPECT_EQ(thinned_indices(x, x, 100).size(), 100u);
}

TEST(Thinning, KeepsEndsAndExtremesWithinTheGivenNumber) {
  const Eigen::Index n = 100000;
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(n, 0, 10);
  Eigen::VectorXd y = (50 * x).array().sin();
  y(31234) = 7;
  y(77777) = -9;
  const auto kept = thinned_indices(x, y, 1000);
  EXPECT_LE(kept.size(), 1001u);
  EXPECT_GT(kept.size(), 600u);
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  const std::set<Eigen::Index> set(kept.begin(), kept.end());
  EXPECT_EQ(set.size(), kept.size());
  for (const Eigen::Index i : {Eigen::Index(0), Eigen::Index(31234), Eigen::Index(77777), n - 1})
    EXPECT_TRUE(set.count(i)) << i;
}

TEST(Thinning, KeepsTheExtremesOfSeveralCurvesOverOneX) {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(5000, 0, 1);
  Eigen::MatrixXd y = Eigen::MatrixXd::Zero(5000, 2);
  y(1111, 0) = 1;
  y(4321, 1) = -1;
  const auto kept = thinned_indices(x, y, 200);
  EXPECT_THAT(kept, ::testing::Contains(1111));
  EXPECT_THAT(kept, ::testing::Contains(4321));
}

TEST(Thinning, KeepsGapsAsGaps) {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(10000, 0, 1);
  Eigen::VectorXd y = x;
  y.segment(5003, 2).setConstant(gap);
  const auto kept = thinned_indices(x, y, 100);
  for (const int i : {5002, 5003, 5004, 5005}) EXPECT_THAT(kept, ::testing::Contains(i));
}

TEST(ChartJson, WritesNanAsNanForTheViewerToLeaveAGap) {
  const auto json = json::parse(to_json(chart_of(Eigen::Vector3d(0, 1, 2), Eigen::Vector3d(1, gap, 3))), "t");
  const auto y = json::floats_from_base64(json.at("series").array()[0].at("y").string());
  EXPECT_EQ(y[0], 1);
  EXPECT_TRUE(std::isnan(y[1]));
  EXPECT_EQ(y[2], 3);
}

TEST(ChartJson, SharesTheXOfCurvesThatHaveTheSame) {
  Chart chart = chart_of(Eigen::Vector3d(0, 1, 2), Eigen::Vector3d(1, 2, 3));
  chart.series.push_back({"other", chart.series[0].x, Eigen::Vector3d(4, 5, 6)});
  chart.series.push_back({"later", Eigen::Vector3d(5, 6, 7), Eigen::Vector3d(4, 5, 6)});
  const auto json = json::parse(to_json(chart), "t");
  EXPECT_EQ(json.at("xs").array().size(), 2u);
  EXPECT_EQ(json.at("series").array()[1].at("x").number(), 0);
  EXPECT_EQ(json.at("series").array()[2].at("x").number(), 1);
}

TEST(ChartCheck, NamesTheSeriesThatIsWrong) {
  const auto message = [](const Chart& chart) { return message_of<ModelError>([&] { check(chart); }); };
  EXPECT_THAT(message(chart_of(Eigen::Vector3d(0, 1, 2), Eigen::Vector2d(1, 2))),
              HasSubstr("chart \"force\", series \"wheel\": 3 values of x, 2 of y"));
  EXPECT_THAT(message(chart_of(Eigen::Vector3d(0, 2, 1), Eigen::Vector3d(1, 2, 3))),
              HasSubstr("x[2] = 1 follows 2"));
  EXPECT_THAT(message(chart_of(Eigen::Vector2d(0, gap), Eigen::Vector2d(1, 2))), HasSubstr("not finite"));
  Chart logarithmic = chart_of(Eigen::Vector2d(0, 1), Eigen::Vector2d(1, 2));
  logarithmic.x.scale = Scale::logarithmic;
  EXPECT_THAT(message(logarithmic), HasSubstr("x[0] = 0 on a logarithmic axis"));
  Chart empty;
  empty.title = "empty";
  EXPECT_THAT(message(empty), HasSubstr("chart \"empty\": nothing to draw"));
}

#include "tests/browser/browser.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "easydyn/visu/report.hpp"
#include "soil/report/prediction_report.hpp"
#include "tests/browser/synthetic_results.hpp"
#include "tests/temporary_folder.hpp"

using namespace easydyn;
using namespace easydyn::testing;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

namespace {

class Browser : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_browser()) GTEST_SKIP() << "no Chromium on this machine";
  }
  TemporaryFolder folder_;
};

void expect_complete(const Visit& seen) {
  EXPECT_THAT(seen.root, HasSubstr("data-ready=\"true\""));
  EXPECT_THAT(seen.root, Not(HasSubstr("data-failure")));
  EXPECT_THAT(seen.console, IsEmpty());
  EXPECT_THAT(seen.requests, IsEmpty());
}

/// A double pendulum that swings as two sines: the page of a small example.
void write_pendulum_page(const std::filesystem::path& path) {
  visu::Scene scene;
  scene.name = "Two rods";
  scene.time = Eigen::VectorXd::LinSpaced(400, 0, 8);
  visu::MovingFrame upper{"upper rod", {}}, lower{"lower rod", {}};
  Eigen::VectorXd a(400), b(400);
  for (Eigen::Index i = 0; i < 400; ++i) {
    a(i) = 0.8 * std::cos(2.2 * scene.time(i));
    b(i) = 1.1 * std::cos(5.1 * scene.time(i));
    const Eigen::Quaterniond q1(Eigen::AngleAxisd(a(i), Eigen::Vector3d::UnitY()));
    const Eigen::Quaterniond q2(Eigen::AngleAxisd(a(i) + b(i), Eigen::Vector3d::UnitY()));
    const Eigen::Vector3d hinge = q1 * Eigen::Vector3d(0, 0, -1.2);
    upper.poses.push_back({0.5 * hinge, q1});
    lower.poses.push_back({hinge + q2 * Eigen::Vector3d(0, 0, -0.5), q2});
  }
  scene.frames = {upper, lower};
  scene.items = {{.name = "upper", .frame = "upper rod", .size = {0.08, 0.08, 1.2}},
                 {.name = "lower", .frame = "lower rod", .size = {0.08, 0.08, 1.0}, .colour = "#ee6677"},
                 {.name = "bob",
                  .frame = "lower rod",
                  .shape = visu::Shape::sphere,
                  .size = {0.12, 0, 0},
                  .colour = "#228833",
                  .offset = {{0, 0, -0.5}}}};
  scene.camera = {.target = {0, 0, -1}, .width = 5, .azimuth = -80, .elevation = 8};
  visu::write_animation_page(path, "Double pendulum", scene,
                             {{.title = "Angles",
                               .x = {"time", "s"},
                               .y = {"angle", "rad"},
                               .series = {{"a, upper rod", scene.time, a}, {"b, lower rod", scene.time, b}}}},
                             "Two rods swing about parallel axes.");
}

}  // namespace

TEST_F(Browser, SeesWhatAPageSaysAndAsksFor) {
  // the eyes of the other tests: a message and two requests must not escape them
  const auto page = folder_.write("page.html",
                                  "<img src='http://127.0.0.1:9/picture.png'><script>console.log('hello');"
                                  "fetch('http://localhost:9/data').catch(() => {});</script>");
  const Visit seen = visit(page, folder_.path());
  EXPECT_THAT(seen.console, ::testing::Contains(HasSubstr("hello")));
  EXPECT_THAT(seen.requests, ::testing::Contains(HasSubstr("picture.png")));
  EXPECT_THAT(seen.requests, ::testing::Contains(HasSubstr("localhost:9/data")));
}

TEST_F(Browser, DrawsThePredictionReportAndAsksForNothing) {
  write_synthetic_results(folder_.path());
  soil::write_prediction_report(folder_.path(), folder_ / "report.html");
  EXPECT_LT(std::filesystem::file_size(folder_ / "report.html"), 5'000'000u);
  const Visit seen = visit(folder_ / "report.html", folder_.path());
  expect_complete(seen);
  EXPECT_THAT(seen.root, HasSubstr("data-animations=\"1\""));
  EXPECT_THAT(seen.body, HasSubstr("deflections × 200"));
  EXPECT_THAT(seen.root, Not(HasSubstr("data-charts=\"0\"")));
}

TEST_F(Browser, DrawsAnAnimationPage) {
  write_pendulum_page(folder_ / "pendulum.html");
  const Visit seen = visit(folder_ / "pendulum.html", folder_.path());
  expect_complete(seen);
  EXPECT_THAT(seen.root, HasSubstr("data-charts=\"1\" data-animations=\"1\""));
}

TEST_F(Browser, SaysSoWithoutWebGlAndDrawsTheCharts) {
  write_pendulum_page(folder_ / "pendulum.html");
  const Visit seen = visit(folder_ / "pendulum.html", folder_.path(), "--disable-3d-apis");
  expect_complete(seen);
  EXPECT_THAT(seen.root, HasSubstr("data-charts=\"1\" data-animations=\"0\""));
  EXPECT_THAT(seen.body, HasSubstr("class=\"animation without-webgl\""));
}

TEST_F(Browser, ReportsAChartWithNothingInIt) {
  visu::Report report("page");
  report.add_chart({.title = "empty",
                    .x = {"x", ""},
                    .y = {"y", ""},
                    .series = {{"gap", Eigen::Vector2d(0, 1), Eigen::Vector2d::Constant(std::nan(""))}}});
  report.write(folder_ / "empty.html");
  const Visit seen = visit(folder_ / "empty.html", folder_.path());
  EXPECT_THAT(seen.root, HasSubstr("data-failure=\"nothing drawn in chart 1\""));
  EXPECT_THAT(seen.root, Not(HasSubstr("data-ready")));
}

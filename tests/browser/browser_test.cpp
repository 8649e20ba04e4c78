#include "tests/browser/browser.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "easydyn/visu/report.hpp"
#include "soil/report/comparison_report.hpp"
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

TEST_F(Browser, DrawsAComparisonOfResults) {
  for (const char* name : {"plain", "trench"}) {
    std::filesystem::create_directory(folder_ / name);
    write_synthetic_results(folder_ / name);
  }
  soil::write_comparison_report({folder_ / "plain", folder_ / "trench"}, folder_ / "comparison.html");
  EXPECT_LT(std::filesystem::file_size(folder_ / "comparison.html"), 5'000'000u);
  const Visit seen = visit(folder_ / "comparison.html", folder_.path());
  expect_complete(seen);
  EXPECT_THAT(seen.root, Not(HasSubstr("data-charts=\"0\"")));
}

TEST_F(Browser, DrawsAnAnimationPage) {
  write_pendulum_page(folder_ / "pendulum.html");
  const Visit seen = visit(folder_ / "pendulum.html", folder_.path());
  expect_complete(seen);
  EXPECT_THAT(seen.root, HasSubstr("data-charts=\"1\" data-animations=\"1\""));
}

TEST_F(Browser, PlacesAnItemWhereItsFrameTakesIt) {
  // a ball 1 m below a frame that has turned by 90 degrees about y, magnified twice from a rest at 45 degrees,
  // stands at x = -1 m: a quarter from the left of a picture that is 4 m wide, at mid-height
  const auto turn = [](double degrees) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(degrees * std::numbers::pi / 180, Eigen::Vector3d::UnitY()));
  };
  visu::Scene scene;
  scene.time = Eigen::Vector2d(0, 1);
  const visu::Pose pose{{0, 0, 1}, turn(67.5)};
  scene.frames = {{"arm", {pose, pose}, visu::Pose{{0, 0, 2}, turn(45)}}};
  scene.items = {{.name = "ball",
                  .frame = "arm",
                  .shape = visu::Shape::sphere,
                  .size = {0.2, 0, 0},
                  .colour = "#aa0000",
                  .offset = {{0, 0, -1}}}};
  scene.exaggeration = 2;
  scene.camera = {.target = {0, 0, 0}, .width = 4, .azimuth = -90, .elevation = 0};
  visu::write_animation_page(folder_ / "page.html", "Arm", scene);
  std::ofstream(folder_ / "page.html", std::ios::app) << R"(<script>setTimeout(() => {
    const canvas = document.createElement('canvas'); canvas.width = 400; canvas.height = 100;
    const context = canvas.getContext('2d');
    context.drawImage(document.querySelector('.stage canvas'), 0, 0, 400, 100);
    const pixels = context.getImageData(0, 0, 400, 100).data;
    let n = 0, x = 0, y = 0;
    for (let i = 0; i < pixels.length; i += 4)
      if (pixels[i + 1] < 100) { n++; x += (i / 4) % 400; y += Math.floor(i / 1600); }
    document.documentElement.dataset.x = Math.round(x / n / 10);
    document.documentElement.dataset.y = Math.round(y / n / 10);
  }, 500)</script>)";
  const Visit seen = visit(folder_ / "page.html", folder_.path());
  expect_complete(seen);
  EXPECT_THAT(seen.root, HasSubstr("data-x=\"10\" data-y=\"5\""));  // of 40 x 10
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

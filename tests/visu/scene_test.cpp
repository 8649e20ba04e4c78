#include "easydyn/visu/scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "easydyn/error.hpp"
#include "tests/temporary_folder.hpp"

using namespace easydyn;
using namespace easydyn::visu;
using easydyn::testing::message_of;
using ::testing::HasSubstr;

namespace {

/// A wheel that rolls over a deflecting rail, on a spring.
Scene rolling_wheel(int times) {
  Scene scene;
  scene.name = "wheel \"on\" rail";
  scene.time = Eigen::VectorXd::LinSpaced(times, 0, 2);
  MovingFrame wheel{"wheel", {}, Pose{{0, 0, 0.4}, Eigen::Quaterniond::Identity()}};
  for (const double t : scene.time)
    wheel.poses.push_back(
        {{10 * t, 0, 0.4 - 1e-3 * t}, Eigen::Quaterniond(Eigen::AngleAxisd(t, Eigen::Vector3d::UnitY()))});
  scene.frames = {wheel};
  scene.items = {
      {.name = "tread", .frame = "wheel", .shape = Shape::wheel, .size = {0.4, 0.13, 0}, .opacity = 0.5}};
  scene.links = {{"spring", {"wheel", {0, 0, 0}}, {"", {0, 0, 2}}, LinkShape::spring}};
  DeformingLine rail{.name = "rail", .x = Eigen::VectorXd::LinSpaced(5, 0, 20)};
  rail.deflection = -1e-3 * scene.time * rail.x.transpose();
  rail.block = Eigen::Vector3d(0.2, 2.5, 0.1);
  scene.lines = {rail};
  scene.exaggeration = 100;
  scene.ground = -0.5;
  scene.camera.follow = "wheel";
  return scene;
}

}  // namespace

TEST(SceneJson, ReadsBackWhatWasWritten) {
  const Scene scene = rolling_wheel(7), back = scene_from_json(to_json(scene));
  EXPECT_EQ(back.name, scene.name);
  EXPECT_TRUE(back.time.isApprox(scene.time, 1e-6));  // stored as float32
  ASSERT_EQ(back.frames.size(), 1u);
  EXPECT_TRUE(back.frames[0].rest.has_value());
  ASSERT_EQ(back.frames[0].poses.size(), 7u);
  for (size_t i = 0; i < 7; ++i) {
    EXPECT_TRUE(back.frames[0].poses[i].position.isApprox(scene.frames[0].poses[i].position, 1e-6));
    EXPECT_LT(back.frames[0].poses[i].orientation.angularDistance(scene.frames[0].poses[i].orientation),
              1e-3);
  }
  EXPECT_EQ(back.items[0].shape, Shape::wheel);
  EXPECT_EQ(back.items[0].opacity, 0.5);
  EXPECT_EQ(back.links[0].shape, LinkShape::spring);
  EXPECT_TRUE(back.lines[0].deflection.isApprox(scene.lines[0].deflection, 1e-6));
  EXPECT_EQ(*back.lines[0].block, *scene.lines[0].block);
  EXPECT_EQ(back.exaggeration, 100);
  EXPECT_EQ(back.ground, -0.5);
  EXPECT_EQ(back.camera.follow, "wheel");
}

TEST(SceneThinning, KeepsFirstAndLastTimeAndSpreadsTheOthers) {
  const Scene thin = thinned(rolling_wheel(1001), 11);
  EXPECT_TRUE(thin.time.isApprox(Eigen::VectorXd::LinSpaced(11, 0, 2)));
  EXPECT_NEAR(thin.frames[0].poses[5].position.x(), 10, 1e-12);
  EXPECT_EQ(thin.lines[0].deflection.rows(), 11);
  check(thin);
}

TEST(SceneThinning, KeepsAnEncodedSceneSmall) {
  // 600 times x (7 + 5 numbers) x 4 bytes x 4/3 = 38 kB and the names
  EXPECT_LT(to_json(rolling_wheel(100000), 600).size(), 45000u);
}

TEST(SceneCheck, NamesWhatDoesNotFit) {
  const auto message = [](auto change) {
    Scene scene = rolling_wheel(4);
    change(scene);
    return message_of<ModelError>([&] { check(scene); });
  };
  EXPECT_THAT(message([](Scene& s) { s.frames[0].poses.pop_back(); }),
              HasSubstr("frame \"wheel\" has 3 poses, must be 4"));
  EXPECT_THAT(message([](Scene& s) { s.items[0].frame = "wheal"; }),
              HasSubstr("item \"tread\" names the unknown frame \"wheal\""));
  EXPECT_THAT(message([](Scene& s) { s.items[0].size.x() = 0; }), HasSubstr("item \"tread\" has a size"));
  EXPECT_THAT(message([](Scene& s) { s.frames[0].poses[2].position.x() = std::nan(""); }),
              HasSubstr("not finite"));
  EXPECT_THAT(message([](Scene& s) { s.lines[0].x(2) = 0; }), HasSubstr("line \"rail\": x must ascend"));
  EXPECT_THAT(message([](Scene& s) { s.lines[0].deflection.conservativeResize(3, 5); }), HasSubstr("3 x 5"));
  EXPECT_THAT(message([](Scene& s) { s.time(2) = 0; }), HasSubstr("time must ascend"));
  EXPECT_THAT(message([](Scene& s) { s.exaggeration = 0; }), HasSubstr("exaggeration = 0"));
  EXPECT_THAT(message([](Scene& s) { s.links[0].radius = -1; }), HasSubstr("link \"spring\": radius = -1"));
  EXPECT_THAT(message([](Scene& s) { s.camera.follow = "?"; }), HasSubstr("the camera names"));
  EXPECT_THAT(message([](Scene& s) { s.frames.push_back(s.frames[0]); }), HasSubstr("used twice"));
  EXPECT_THAT(message([](Scene& s) { s.time.resize(0); }), HasSubstr("no times"));
}

TEST(SceneJson, RefusesATextThatIsNoScene) {
  const auto message = [](const std::string& text) {
    return message_of<InputError>([&] { scene_from_json(text, "results.h5:/scene"); });
  };
  EXPECT_THAT(message("{"), HasSubstr("results.h5:/scene:1:2: "));
  EXPECT_THAT(message("{}"), HasSubstr("results.h5:/scene: JSON: member \"format\" is missing"));
  EXPECT_THAT(message(R"({"format":"x"})"), HasSubstr("expected \"easydyn-scene-1\""));
}

#include "easydyn/sim/mode_scene.hpp"

#include <gtest/gtest.h>

#include "easydyn/easydyn.hpp"

using namespace easydyn;

namespace {

class TwoMasses : public System {
 public:
  Coordinate a = coordinate("a"), b = coordinate("b");
  Body& first = body("first", 1.0);
  Body& second = body("second", 1.0);
  SpringDamper left{"left", 100, 0, 1}, middle{"middle", 100, 0, 1};

  TwoMasses() : System("two masses") {}

 protected:
  void positions() override {
    first = translate(1 + a, 0, 0);
    second = translate(2 + b, 0, 0);
  }
  void forces() override {
    left.apply({}, {0, 0, 0}, first, {0, 0, 0});
    middle.apply(first, {0, 0, 0}, second, {0, 0, 0});
  }
};

TEST(ModeScene, MovesTheBodiesAlongTheShapeForOnePeriod) {
  TwoMasses system;
  const State rest = system.initial_state();
  const std::vector<Mode> modes = compute_modes(linearize(system, rest));
  const visu::Scene scene =
      mode_scene(system, rest, modes[0], {.amplitude = 0.2, .duration = 3, .times = 8, .periods = 1});
  visu::check(scene);
  ASSERT_EQ(scene.time.size(), 9);
  EXPECT_EQ(scene.time[8], 3);
  ASSERT_EQ(scene.frames.size(), 2u);
  EXPECT_EQ(scene.frames[1].name, "second");
  // the golden ratio: the second mass moves most, the first 0.618 of it; both turn at half the period
  EXPECT_NEAR(scene.frames[1].poses[0].position.x(), 2.2, 1e-6);
  EXPECT_NEAR(scene.frames[0].poses[0].position.x(), 1 + 0.2 * 0.6180339887, 1e-6);
  EXPECT_NEAR(scene.frames[1].poses[4].position.x(), 1.8, 1e-6);
  EXPECT_NEAR(scene.frames[1].poses[8].position.x(), 2.2, 1e-6);
}

TEST(ModeScene, RefusesWhatCannotBeDrawn) {
  TwoMasses system;
  const State rest = system.initial_state();
  const Mode mode = compute_modes(linearize(system, rest))[0];
  EXPECT_THROW(mode_scene(system, rest, mode, {.amplitude = 0}), ModelError);
  EXPECT_THROW(mode_scene(system, rest, mode, {.times = 1}), ModelError);
  EXPECT_THROW(mode_scene(system, rest, mode, {.periods = 0}), ModelError);
  Mode other = mode;
  other.shape.conservativeResize(1);
  EXPECT_THROW(mode_scene(system, rest, other), ModelError);
}

}  // namespace

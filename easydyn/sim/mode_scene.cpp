#include "easydyn/sim/mode_scene.hpp"

#include <fmt/format.h>

#include <numbers>

#include "easydyn/require.hpp"

namespace easydyn {

visu::Scene mode_scene(System& system, const State& about, const Mode& mode,
                       const ModeSceneOptions& options) {
  require_positive("mode scene", "amplitude", options.amplitude, "m or rad");
  require_positive("mode scene", "duration", options.duration, "s");
  require(options.times >= 2, "mode scene", "times", options.times, "", ">= 2");
  require(options.periods >= 1, "mode scene", "periods", options.periods, "", ">= 1");
  if (mode.shape.size() != system.size())
    throw ModelError(fmt::format("mode scene: the shape has {} coordinates, system \"{}\" has {}",
                                 mode.shape.size(), system.name(), system.size()));

  visu::Scene scene;
  scene.name = fmt::format("{}, {:.3g} Hz", system.name(), mode.frequency);
  scene.time =
      Eigen::VectorXd::LinSpaced(options.periods * options.times + 1, 0, options.periods * options.duration);
  for (const Body& b : system.bodies()) scene.frames.push_back({b.name(), {}, std::nullopt});
  State state = about;
  state.qd.setZero();
  for (const double t : scene.time) {
    const double phase = 2 * std::numbers::pi * t / options.duration;
    state.q = about.q + options.amplitude * (mode.shape * std::polar(1.0, phase)).real();
    system.evaluate(state);
    std::size_t i = 0;
    for (const Body& b : system.bodies())
      scene.frames[i++].poses.push_back({b.position(), Eigen::Quaterniond(b.frame().rotation())});
  }
  return scene;
}

}  // namespace easydyn

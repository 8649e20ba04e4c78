#pragma once

#include "easydyn/mbs/system.hpp"
#include "easydyn/sim/modes.hpp"
#include "easydyn/visu/scene.hpp"

namespace easydyn {

struct ModeSceneOptions {
  double amplitude = 0.1;  ///< of the coordinate that moves most [m or rad], > 0
  double duration = 2;     ///< of one period on the screen [s], > 0
  int times = 48;          ///< pictures per period, >= 2
  int periods = 5;         ///< shown, >= 1
};

/// A mode as an animated scene:
///
///   q = q_0 + amplitude Re(shape exp(i phase))        phase 0 ... 2 pi in each period
///
/// Damping is left out, phases between the coordinates are kept. One moving frame per body, named after it, and no items
/// yet: add what the bodies look like.
/// @param about  the state that the modes belong to
/// @throws ModelError if an option is out of its range or the shape is not that of the system
visu::Scene mode_scene(System& system, const State& about, const Mode& mode,
                       const ModeSceneOptions& options = {});

}  // namespace easydyn

#pragma once

#include "easydyn/visu/scene.hpp"
#include "track/passage.hpp"
#include "track/track_data.hpp"

namespace easydyn::track {

/// Adds the deflecting rails and the sleepers of a passage to a scene with the same times: the rails' top at
/// z = `rail_top` [m], the sleepers below, both lowered by their deflection times the scene's exaggeration.
/// @param rows  rows of the passage, one per time of the scene
void add_track(visu::Scene& scene, const Passage& passage, const TrackData& data,
               const std::vector<Eigen::Index>& rows, double rail_top = 0, double gauge = 1.435);

}  // namespace easydyn::track

#pragma once

#include <string>
#include <vector>

#include "soil/layered/layered_ground.hpp"
#include "soil/mobility_file.hpp"
#include "soil/site.hpp"
#include "soil/wave_solver.hpp"

namespace easydyn::soil {

/// StoredMobility::method.
inline constexpr const char* layered_method = "layered half-space";
inline constexpr const char* element_method = "finite elements";

/// Row of the parameters that says up to which distance [m] of footprints responses by finite elements are the layered
/// half-space's, and from which on.
inline constexpr const char* near_footprints_row =
    "footprints nearer to each other are by the layered half-space";
inline constexpr const char* far_footprints_row =
    "footprints farther away along x are by the layered half-space";

/// Raised with every change of the program that changes the numbers of impulse responses, so that files written before
/// are computed anew.
inline constexpr int response_revision = 2;

/// What stands for the ground in impulse responses, a line for each value, e.g. "layer 1: cs = 109 m/s": layers, blocks,
/// highest frequency and that of the damping. Names, sources, receivers and loads do not count.
std::vector<std::string> describe_ground(const Site& site);

/// The same with all else that the responses depend on but their distances and length: version of the program and
/// response_revision, damping, method and mesh.
/// @param elements  options of the finite elements; nullptr: layered half-space
std::vector<std::string> describe_responses(const Site& site, GroundDamping damping,
                                            const SolverOptions* elements);

/// The first difference as a sentence, e.g. "layer 1: cs = 109 m/s there, layer 1: cs = 110 m/s here"; empty: none.
std::string find_difference(const std::vector<std::string>& there, const std::vector<std::string>& here);

/// Whether the responses are shorter than this window [s], as a sentence; empty: they are not, to 1e-6 of their step, by
/// which a length that was rebuilt from the times of a file may differ.
std::string find_shortage(const StoredMobility& stored, double window);

/// The first distance, or the size of the footprint, that a mobility lacks, as a sentence; empty if it covers all.
std::string find_missing(const Mobility& mobility, const Mobility& needed);

}  // namespace easydyn::soil

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "easydyn/parameter.hpp"
#include "easydyn/results/result_file.hpp"
#include "soil/layered/layered_ground.hpp"
#include "soil/mobility.hpp"
#include "soil/response_rest.hpp"
#include "soil/site.hpp"

namespace easydyn::soil {

/// Impulse responses and the site that they belong to: what `mobility.h5` holds (docs/formats.md).
struct StoredMobility {
  Mobility mobility;
  Site site;
  GroundDamping damping = GroundDamping::maxwell_body;
  std::string method;  ///< how the responses were computed, e.g. "layered half-space"
  /// How those of each of mobility.shifts were (layered_method, element_method); by finite elements, footprints near to each
  /// other and far from each other have the layered half-space's. None: all by `method`, but for finite elements without
  /// blocks in a file of an earlier version, where it is not known.
  std::vector<std::string> shift_methods;
  std::vector<std::string> identity;  ///< describe_responses(); none in a file of an earlier version
  std::vector<Parameter> parameters;  ///< of the method: mesh, boundary, time step; rest
  double window = 0;  ///< [s] that all responses hold; the samples reach farther where far footprints need it
  ResponseRest rest;  ///< of those just computed; a file has its size in the parameters
};

/// @throws ModelError if sizes disagree or a value is not finite; InputError if the file cannot be written
void write_mobility(const std::filesystem::path& path, const StoredMobility& stored,
                    const results::Provenance& provenance);

/// @throws InputError naming the file, the dataset and what is wrong
StoredMobility read_mobility(const std::filesystem::path& path);

/// Damping by the name that options and files use: none, stiffness, constant (the finite elements' body) or
/// constant-q. @throws InputError for another name
GroundDamping find_ground_damping(const std::string& name);
std::string name_of(GroundDamping damping);

}  // namespace easydyn::soil

#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "easydyn/parameter.hpp"
#include "examples/passage_program/passage_program.hpp"
#include "track_on_soil/critical_speed.hpp"
#include "track_on_soil/site_foundation.hpp"

namespace easydyn::examples {

/// What --site makes of a run: the foundation that stands for this ground, and the speeds of its waves.
struct SiteOfRun {
  std::filesystem::path file;
  soil::Site site;
  std::optional<track_on_soil::FoundationOnSite> foundation;  ///< none for rigid ground
  double rayleigh_speed = 0;                                  ///< of the upper layer [m/s]
  std::optional<soil::ModeCrossing> crossing;                 ///< of the waves of track and ground
  track_on_soil::DeflectionOverSpeed response;
};

/// @param foundation  option --foundation
/// @throws InputError, ModelError, SolverError as read_site(), find_foundation()
SiteOfRun read_site_of_run(const std::filesystem::path& file, const PassageProgram& program,
                           const std::string& foundation);

/// The program with foundation and speeds of waves of a site.
PassageProgram place_on(const SiteOfRun& site, PassageProgram program);

std::string describe(
    const SiteOfRun& site);  ///< one sentence: where the foundation came from, how well it fits
std::vector<std::string> warn_of(
    const SiteOfRun& site);  ///< what the site has and the foundation does not know
std::vector<Parameter> parameters_of(const SiteOfRun& site);

}  // namespace easydyn::examples

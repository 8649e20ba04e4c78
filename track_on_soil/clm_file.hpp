#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "soil/site.hpp"
#include "track/clm_calibration.hpp"
#include "track_on_soil/site_compliance.hpp"

namespace easydyn::track_on_soil {

/// The coupled lumped mass foundation of a track on a site, how it was fitted, and what it belongs to.
struct SiteClm {
  std::vector<soil::Layer> layers;  ///< of the site; a file keeps neither their names nor their sources
  double damping_frequency = 0;     ///< at which they hold [Hz]
  FootprintRow row;
  double lowest = 0, highest = 0;  ///< band of the fit that was asked for [Hz]
  int foundations = 0;             ///< of the chain that was fitted; 0: infinitely many
  track::ClmFit fit;

  /// Whether layers and footprints are these. Neither receivers nor settings of the solver matter, and band and chain are
  /// a choice.
  bool belongs_to(const soil::Site& site, const FootprintRow& footprints) const;
};

/// The file beside a site file: SITE.toml has SITE.clm.toml.
std::filesystem::path clm_file_of(const std::filesystem::path& site);

/// Writes a TOML file (docs/formats.md) under a temporary name and renames it when complete. All numbers come back as they
/// were, bit by bit.
/// @throws InputError if it cannot be written
void write_clm(const std::filesystem::path& path, const SiteClm& clm);

/// @throws InputError `file:line:column: object: key = value, must be ...`; ModelError naming the file if the chain is not
/// passive
SiteClm read_clm(const std::filesystem::path& path);

}  // namespace easydyn::track_on_soil

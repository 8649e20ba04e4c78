#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "soil/layered/layered_ground.hpp"
#include "soil/site.hpp"
#include "track/clm_calibration.hpp"
#include "track_on_soil/site_compliance.hpp"

namespace easydyn::track_on_soil {

/// Revision of the fit: to be raised with any change that alters its numbers, so that stored ones are fitted anew.
inline constexpr int fit_revision = 2;

/// Whether a foundation can be fitted to impulse responses with this damping: only where the damping ratio of the ground is the
/// site's, nearly or quite, at all frequencies.
bool has_constant_ratio(soil::GroundDamping damping);

/// The coupled lumped mass foundation of a track on a site, how it was fitted, and what it belongs to.
struct SiteClm {
  std::vector<soil::Layer> layers;  ///< of the site; a file keeps neither their names nor their sources
  std::vector<soil::Block> blocks;  ///< of the site; their names are not kept either
  double damping_frequency = 0;     ///< at which they hold [Hz]
  std::string method;               ///< of the ground's compliance, as ComplianceOrigin::method
  soil::GroundDamping damping = soil::GroundDamping::constant_q;  ///< of the ground's compliance
  int revision = fit_revision;                                    ///< of the fit; 0: a file that names none
  FootprintRow row;
  double lowest = 0, highest = 0;  ///< band of the fit that was asked for [Hz]
  int foundations = 0;             ///< of the chain that was fitted; 0: infinitely many
  track::ClmFit fit;

  /// Whether the compliance is that of the whole site: blocks of other material count with finite elements only.
  bool knows_blocks() const;

  /// What keeps it from holding for a site, e.g. "belongs to other layers"; empty if nothing does: layers, blocks and
  /// footprints are these, the damping ratio is constant and the fit is of this revision. Neither receivers nor settings of
  /// the solver matter; band, chain and method are a choice (find_foundation() asks for the infinite chain).
  std::string find_mismatch(const soil::Site& site, const FootprintRow& footprints) const;
  bool belongs_to(const soil::Site& site, const FootprintRow& footprints) const {
    return find_mismatch(site, footprints).empty();
  }
};

/// The file beside a site file: SITE.toml has SITE.clm.toml.
std::filesystem::path clm_file_of(const std::filesystem::path& site);

/// Writes a TOML file (docs/formats.md) under a temporary name and renames it when complete. All numbers come back as they
/// were, bit by bit.
/// @throws InputError if it cannot be written
void write_clm(const std::filesystem::path& path, const SiteClm& clm);

/// A file of format 1, without blocks, method, damping and revision, comes back with revision 0.
/// @throws InputError `file:line:column: object: key = value, must be ...`; ModelError naming the file if the chain is not
/// passive
SiteClm read_clm(const std::filesystem::path& path);

}  // namespace easydyn::track_on_soil

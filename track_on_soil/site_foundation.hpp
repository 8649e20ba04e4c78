#pragma once

#include <filesystem>
#include <string>

#include "track_on_soil/clm_file.hpp"

namespace easydyn::track_on_soil {

/// Frequencies of a calibration over a band: both ends, at most 1 Hz apart, at least 12 [Hz].
Eigen::VectorXd calibration_frequencies(double lowest, double highest);

/// The coupled lumped masses that follow the layers of a site best (track::calibrate_clm on compute_site_compliance).
/// Unless the options say otherwise, errors weigh 1 / f, so that each octave counts alike: what a train does to its
/// foundation lies at low frequencies, and errors of equal weight let a layer's resonance spoil the stiffness there.
/// @param options  band, chain and weights, one per calibration_frequencies()
/// @throws ModelError, SolverError as these do
SiteClm calibrate_on_site(const soil::Site& site, const FootprintRow& row,
                          const track::ClmFitOptions& options = {}, int threads = 0);

/// The same from impulse responses, by finite elements or not.
/// @param file  what messages and the source of the constants name
/// @throws InputError if their damping is not that of a constant ratio (has_constant_ratio), or as transform_mobility()
SiteClm calibrate_on_mobility(const soil::StoredMobility& stored, const std::string& file, double spacing,
                              const track::ClmFitOptions& options = {});

/// Where the foundation of a run came from.
struct FoundationOnSite {
  SiteClm clm;
  std::string origin;  ///< a sentence, e.g. "fitted to tram.toml and written to tram.clm.toml"
};

/// Foundation of a track on a site: that of the file beside the site file (clm_file_of) if it belongs to this ground and
/// these footprints (SiteClm::find_mismatch) and is of the infinite chain, as the foundation of a track is, whatever its
/// band and method; else fitted to the layers over 2 to 50 Hz, each octave alike, and written there, over what was there.
/// Where it cannot be written, `origin` says so.
/// @throws InputError if a file cannot be read or is not what it should be, ModelError, SolverError as above
FoundationOnSite find_foundation(const std::filesystem::path& site_file, const soil::Site& site,
                                 const FootprintRow& row);

}  // namespace easydyn::track_on_soil

#pragma once

#include <Eigen/Core>

#include "soil/mobility_file.hpp"
#include "soil/site.hpp"
#include "track/clm_calibration.hpp"
#include "track/track_data.hpp"

namespace easydyn::track_on_soil {

/// A row of equal footprints along the track, as the sleepers press on the ground.
struct FootprintRow {
  double length = 0;   ///< of one, along the track [m]
  double width = 0;    ///< across it [m]
  double spacing = 0;  ///< between centres [m]

  bool operator==(const FootprintRow&) const = default;
};

FootprintRow footprints_of(const track::TrackData& data);

/// Compliances H_0n of a row of footprints on the layers of a site (soil::compute_compliances), with the site's damping
/// ratio at all frequencies (soil::GroundDamping::constant_q), whatever the settings of the solver. Blocks of other
/// material do not count.
/// @param frequencies  [Hz], ascending, > 0
/// @param count        of footprints, n = 0 ... count - 1, >= 2
/// @throws ModelError if a value is out of range, or a layer has no damping
track::GroundCompliance compute_site_compliance(const soil::Site& site, const FootprintRow& row,
                                                const Eigen::VectorXd& frequencies, int count,
                                                int threads = 0);

/// Footprint of a file of impulse responses, with the smallest distance along the track between its footprints.
/// @throws InputError naming `file` if it holds no two footprints in line
FootprintRow footprints_of(const soil::StoredMobility& stored, const std::string& file);

/// Method of compliances of which some are by finite elements and some by the layered half-space.
inline constexpr const char* mixed_method = "finite elements and layered half-space";

/// How compliances H_00 to H_0(count - 1) from impulse responses were computed.
struct ComplianceOrigin {
  std::string method;       ///< soil::layered_method, soil::element_method or mixed_method
  std::string description;  ///< e.g. "finite elements; H_00 layered half-space"
};

/// By finite elements on a ground without blocks, the responses of footprints nearer to each other than an element is long
/// are the layered half-space's, H_00 always (soil::ElementMobility).
/// @throws InputError naming `file` if a distance n spacing is missing
ComplianceOrigin find_origin(const soil::StoredMobility& stored, const std::string& file, double spacing,
                             int count);

/// Compliances from the impulse responses h_n between neighbouring footprints: H_0n(f) = sum_i h_n(t_i) exp(-i w t_i) dt.
/// @param file  what messages name
/// Their source names `file` and find_origin().
/// @throws InputError if a distance n spacing is missing, or a frequency is above 1.25 times the highest of the file
track::GroundCompliance transform_mobility(const soil::StoredMobility& stored, const std::string& file,
                                           double spacing, const Eigen::VectorXd& frequencies, int count);

}  // namespace easydyn::track_on_soil

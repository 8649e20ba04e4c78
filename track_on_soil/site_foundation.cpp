#include "track_on_soil/site_foundation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "easydyn/error.hpp"
#include "easydyn/require.hpp"
#include "soil/mobility_identity.hpp"

namespace easydyn::track_on_soil {
namespace {

SiteClm fit_to(const track::GroundCompliance& compliance, const soil::Site& site, const FootprintRow& row,
               const std::string& method, soil::GroundDamping damping, track::ClmFitOptions options) {
  if (options.weight.size() == 0)  // each octave alike
    options.weight = compliance.frequency.cwiseInverse();
  return {site.layers,
          site.blocks,
          site.damping_frequency,
          method,
          damping,
          fit_revision,
          row,
          options.lowest,
          options.highest,
          options.foundations,
          calibrate_clm(compliance, options)};
}

}  // namespace

Eigen::VectorXd calibration_frequencies(double lowest, double highest) {
  const char* const object = "calibration of the CLM";
  require_positive(object, "lowest frequency", lowest, "Hz");
  require(highest > lowest, object, "highest frequency", highest, "Hz",
          fmt::format("> {:g}, the lowest", lowest));
  const auto steps = static_cast<Eigen::Index>(std::ceil(highest - lowest - 1e-9));
  return Eigen::VectorXd::LinSpaced(std::max<Eigen::Index>(steps, 11) + 1, lowest, highest);
}

SiteClm calibrate_on_site(const soil::Site& site, const FootprintRow& row,
                          const track::ClmFitOptions& options, int threads) {
  return fit_to(compute_site_compliance(site, row, calibration_frequencies(options.lowest, options.highest),
                                        std::max(2, options.foundations), threads),
                site, row, soil::layered_method, soil::GroundDamping::constant_q, options);
}

SiteClm calibrate_on_mobility(const soil::StoredMobility& stored, const std::string& file, double spacing,
                              const track::ClmFitOptions& options) {
  if (!has_constant_ratio(stored.damping))
    throw InputError(
        fmt::format("{}: damping = {}, must be {} or {}: a foundation is that of a constant damping ratio",
                    file, soil::name_of(stored.damping), soil::name_of(soil::GroundDamping::maxwell_body),
                    soil::name_of(soil::GroundDamping::constant_q)));
  const int count = std::max(2, options.foundations);
  return fit_to(transform_mobility(stored, file, spacing,
                                   calibration_frequencies(options.lowest, options.highest), count),
                stored.site, {stored.mobility.length, stored.mobility.width, spacing},
                find_origin(stored, file, spacing, count).method, stored.damping, options);
}

FoundationOnSite find_foundation(const std::filesystem::path& site_file, const soil::Site& site,
                                 const FootprintRow& row) {
  const std::filesystem::path cache = clm_file_of(site_file);
  const std::string name = site_file.filename().string(), cache_name = cache.filename().string();
  std::string why;
  if (std::filesystem::exists(cache)) {
    FoundationOnSite found{read_clm(cache), fmt::format("taken from {}", cache_name)};
    std::string mismatch = found.clm.find_mismatch(site, row);
    if (mismatch.empty() && found.clm.foundations != 0)
      mismatch = fmt::format("is fitted to a {}, not to the infinite chain", found.clm.fit.system);
    if (mismatch.empty()) return found;
    why = fmt::format(", since {} {}", cache_name, mismatch);
  }
  FoundationOnSite fitted{calibrate_on_site(site, row), fmt::format("fitted to {}{}", name, why)};
  try {
    write_clm(cache, fitted.clm);
    fitted.origin += fmt::format(", and written to {}", cache_name);
  } catch (const InputError&) {
    fitted.origin += fmt::format("; {} cannot be written: every run will fit anew", cache.string());
  }
  return fitted;
}

}  // namespace easydyn::track_on_soil

#include "track_on_soil/site_compliance.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <string>
#include <vector>

#include "easydyn/error.hpp"
#include "easydyn/math/units.hpp"
#include "easydyn/require.hpp"
#include "soil/frequency_filter.hpp"
#include "soil/layered/footprint_response.hpp"
#include "soil/mobility_identity.hpp"

namespace easydyn::track_on_soil {
namespace {

constexpr double same_place = 1e-4;  // [m]

// Of the footprint n spacings away along the track.
std::size_t find_column(const soil::StoredMobility& stored, const std::string& file, double distance) {
  const auto& shifts = stored.mobility.shifts;
  const auto there = std::ranges::find_if(shifts, [&](const auto& shift) {
    return std::abs(shift[0] - distance) < same_place && shift[1] < same_place;
  });
  if (there == shifts.end())
    throw InputError(fmt::format("{}: \"/neighbour/offset\" has no footprint {:g} m away along the track",
                                 file, distance));
  return static_cast<std::size_t>(there - shifts.begin());
}

}  // namespace

FootprintRow footprints_of(const track::TrackData& data) {
  return {data.footprint_length, data.footprint_width, data.sleeper_spacing};
}

track::GroundCompliance compute_site_compliance(const soil::Site& site, const FootprintRow& row,
                                                const Eigen::VectorXd& frequencies, int count, int threads) {
  for (const soil::Layer& layer : site.layers)
    require(layer.damping > 0, fmt::format("site \"{}\", layer \"{}\"", site.name, layer.name), "damping",
            layer.damping, "", "> 0 for a compliance in the frequency domain");
  const soil::LayeredGround ground(site, soil::GroundDamping::constant_q);
  return {frequencies,
          soil::compute_compliances(ground, row.length, row.width, row.spacing, count, frequencies, threads),
          row.spacing, fmt::format("the layered half-space \"{}\"", site.name)};
}

FootprintRow footprints_of(const soil::StoredMobility& stored, const std::string& file) {
  double spacing = std::numeric_limits<double>::infinity();
  for (const auto& [dx, dy] : stored.mobility.shifts)
    if (dy < same_place && dx > same_place) spacing = std::min(spacing, dx);
  if (!std::isfinite(spacing))
    throw InputError(
        fmt::format("{}: \"/neighbour/offset\" holds no neighbour along the track, must hold at least one "
                    "(`soil mobility --loads` or `--count 2` and more)",
                    file));
  return {stored.mobility.length, stored.mobility.width, spacing};
}

ComplianceOrigin find_origin(const soil::StoredMobility& stored, const std::string& file, double spacing,
                             int count) {
  if (stored.shift_methods.empty()) {
    if (stored.method == soil::element_method && stored.site.blocks.empty())
      return {mixed_method, stored.method + "; those of near footprints may be of the layered half-space"};
    return {stored.method, stored.method};
  }
  std::vector<std::string> layered;
  for (int n = 0; n < count; ++n)
    if (stored.shift_methods[find_column(stored, file, n * spacing)] == soil::layered_method)
      layered.push_back(fmt::format("H_0{}", n));
  if (layered.empty()) return {soil::element_method, soil::element_method};
  if (layered.size() == static_cast<std::size_t>(count)) return {soil::layered_method, soil::layered_method};
  const std::string which = layered.size() <= 3 ? fmt::format("{}", fmt::join(layered, ", "))
                                                : fmt::format("{} of {}", layered.size(), count);
  return {mixed_method, fmt::format("{}; {} {}", soil::element_method, which, soil::layered_method)};
}

track::GroundCompliance transform_mobility(const soil::StoredMobility& stored, const std::string& file,
                                           double spacing, const Eigen::VectorXd& frequencies, int count) {
  const soil::Mobility& m = stored.mobility;
  const double limit = soil::roll_off * m.highest_frequency;
  if (frequencies.size() > 0 && frequencies.maxCoeff() > limit)
    throw InputError(fmt::format("{}: frequency = {:g} Hz, must be <= {:g}, up to which the responses hold",
                                 file, frequencies.maxCoeff(), limit));
  track::GroundCompliance compliance{
      frequencies,
      {},
      spacing,
      fmt::format("{} ({})", file, find_origin(stored, file, spacing, count).description)};
  compliance.H.resize(frequencies.size(), count);
  for (int n = 0; n < count; ++n) {
    const auto column = static_cast<Eigen::Index>(find_column(stored, file, n * spacing));
    for (Eigen::Index i = 0; i < frequencies.size(); ++i) {
      const double w = 2 * units::pi * frequencies[i];
      std::complex<double> sum = 0;
      for (Eigen::Index t = 0; t < m.mean.rows(); ++t)
        sum += m.mean(t, column) * std::polar(1.0, -w * m.step * static_cast<double>(t - m.before));
      compliance.H(i, n) = m.step * sum;
    }
  }
  return compliance;
}

}  // namespace easydyn::track_on_soil

#include "track_on_soil/site_compliance.hpp"

#include <cmath>
#include <complex>
#include <limits>

#include "easydyn/error.hpp"
#include "easydyn/math/units.hpp"
#include "easydyn/require.hpp"
#include "soil/frequency_filter.hpp"
#include "soil/layered/footprint_response.hpp"

namespace easydyn::track_on_soil {
namespace {

constexpr double same_place = 1e-4;  // [m]

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

track::GroundCompliance transform_mobility(const soil::StoredMobility& stored, const std::string& file,
                                           double spacing, const Eigen::VectorXd& frequencies, int count) {
  const soil::Mobility& m = stored.mobility;
  const double limit = soil::roll_off * m.highest_frequency;
  if (frequencies.size() > 0 && frequencies.maxCoeff() > limit)
    throw InputError(fmt::format("{}: frequency = {:g} Hz, must be <= {:g}, up to which the responses hold",
                                 file, frequencies.maxCoeff(), limit));
  track::GroundCompliance compliance{frequencies, {}, spacing, fmt::format("{} ({})", file, stored.method)};
  compliance.H.resize(frequencies.size(), count);
  for (int n = 0; n < count; ++n) {
    Eigen::Index column = -1;
    for (std::size_t s = 0; s < m.shifts.size(); ++s)
      if (std::abs(m.shifts[s][0] - n * spacing) < same_place && m.shifts[s][1] < same_place)
        column = static_cast<Eigen::Index>(s);
    if (column < 0)
      throw InputError(fmt::format("{}: \"/neighbour/offset\" has no footprint {:g} m away along the track",
                                   file, n * spacing));
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

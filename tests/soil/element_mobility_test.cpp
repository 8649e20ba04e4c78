// Impulse responses by finite elements against the layered half-space and against direct runs.

#include "soil/element_mobility.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "easydyn/error.hpp"
#include "soil/impulse_synthesis.hpp"
#include "soil/layered/layered_mobility.hpp"
#include "soil/layered/superposition.hpp"
#include "soil/prediction.hpp"
#include "tests/soil/small_ground.hpp"

namespace easydyn::soil {
namespace {

using Eigen::Index;

Site make_site(double highest_frequency, double points) {
  Site site;
  Layer top{.name = "top", .thickness = 2, .density = 1800, .cs = 150, .cp = 300, .damping = 0.03, .source = ""};
  Layer bottom = top;
  bottom.cs = 300;
  bottom.cp = 600;
  site.layers = {top, bottom};
  site.receivers = {{"4 m", {0, 4, 0}}, {"8 m", {1.2, 8, 0}}};
  site.highest_frequency = highest_frequency;
  site.damping_frequency = 20;
  site.points_per_wavelength = points;
  site.taper_length = 0;
  site.margin = 6;
  return site;
}

// What loads up to the highest frequency see of a difference: |H - H'| / |H'| from 1/4 of it to it.
double compare(const Eigen::MatrixXd& h, const Eigen::MatrixXd& reference, double step, double highest_frequency) {
  double difference = 0, size = 0;
  const Index nt = std::min(h.rows(), reference.rows());
  for (double f = highest_frequency / 4; f <= highest_frequency; f += highest_frequency / 40) {
    Eigen::VectorXcd wave(nt);
    for (Index i = 0; i < nt; ++i) wave(i) = std::polar(1.0, -2 * std::numbers::pi * f * step * double(i));
    difference += (wave.transpose() * (h - reference).topRows(nt)).squaredNorm();
    size += (wave.transpose() * reference.topRows(nt)).squaredNorm();
  }
  return std::sqrt(difference / size);
}

TEST(DISABLED_Degrees, A) {
  for (const auto& [degree, points] : {std::pair{4, 5.3}, {5, 5.3}, {5, 4.5}, {6, 4.5}, {6, 4.0}}) {
    Site site = make_site(40, points);
    site.receivers = {{"4 m", {0, 4, 0}}, {"8 m", {1.2, 8, 0}}, {"16 m", {1.2, 16, 0}}};
    const std::vector<Footprint> footprints = {{0, 0, 0.3, 2.5}, {0.6, 0, 0.3, 2.5}, {1.2, 0, 0.3, 2.5}};
    ElementMobility elements(site, footprints, {.solver = {.degree = degree}});
    const Mobility m = elements.compute().mobility;
    Mobility layered = list_distances(footprints, site.receivers);
    layered.shifts = m.shifts;
    update_mobility(LayeredGround(site, GroundDamping::maxwell_body), 40, layered, elements.window());
    const RunSummary s = elements.solver().compute_summary();
    std::printf("degree %d points %g: work %.3g, hz %.4f hy %.4f mean %.4f rest %.4f\n", degree, points,
                double(s.dofs) * double(s.steps), compare(m.hz, layered.hz, m.step, 40),
                compare(m.hy, layered.hy, m.step, 40), compare(m.mean, layered.mean, m.step, 40), elements.rest());
    for (Index c = 0; c < m.hz.cols(); ++c)
      std::printf("  %g %g: %.4f\n", m.places[c][0], m.places[c][1], compare(m.hz.col(c), layered.hz.col(c), m.step, 40));
  }
}

}  // namespace
}  // namespace easydyn::soil

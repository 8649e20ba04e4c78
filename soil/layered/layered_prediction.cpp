#include "soil/layered/layered_prediction.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <utility>

#include "easydyn/error.hpp"
#include "soil/layered/layered_mobility.hpp"
#include "soil/layered/superposition.hpp"
#include "soil/mobility_identity.hpp"
#include "soil/recoupling.hpp"

namespace easydyn::soil {
namespace {

using Eigen::Index;

// NaN where the reference is nothing beside the whole motion (a component that symmetry makes zero).
double compute_ratio(double difference, double reference, double whole) {
  return reference > 1e-6 * whole ? difference / reference : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

StoredMobility compute_mobility(const Site& site, const std::vector<Footprint>& footprints,
                                GroundDamping damping, double window, int threads) {
  if (!site.blocks.empty()) {
    throw ModelError(fmt::format(
        "layered half-space: the site has the block \"{}\", must have none: the ground must be the "
        "same along x and y (soil run computes blocks)",
        site.blocks.front().name));
  }
  StoredMobility stored;
  stored.site = site;
  stored.damping = damping;
  stored.method = layered_method;
  stored.identity = describe_responses(site, damping, nullptr);
  stored.mobility = list_distances(footprints, site.receivers);
  update_mobility(LayeredGround(site, damping), site.highest_frequency, stored.mobility, window, threads);
  stored.window = stored.mobility.window();
  stored.rest = find_rest(stored.mobility);
  stored.parameters.push_back(describe_rest(stored.rest));
  return stored;
}

SemiAnalyticalMotion compute_semi_analytical_motion(const Site& site, const SurfaceLoads& loads,
                                                    GroundDamping damping, int threads) {
  const StoredMobility stored = compute_mobility(site, loads.footprints, damping, 0, threads);
  GroundMotion motion =
      superpose(stored.mobility, site, loads, {.samples_per_period = 24, .threads = threads});
  return {.time = std::move(motion.time),
          .vx = std::move(motion.vx),
          .vy = std::move(motion.vy),
          .vz = std::move(motion.vz),
          .footprint_displacement = std::move(motion.footprint_displacement)};
}

std::vector<MotionDifference> compare_with_semi_analytical(const Vibrations& v) {
  std::vector<MotionDifference> differences;
  if (!v.semi_analytical) return differences;
  const SemiAnalyticalMotion& s = *v.semi_analytical;
  // Times that both have.
  Index count = 0;
  while (count < v.time.size() && v.time(count) <= s.time(s.time.size() - 1)) ++count;
  const Eigen::VectorXd time = v.time.head(count);
  const double step = time(1) - time(0);
  const Eigen::MatrixXd own[3] = {v.vx.topRows(count), v.vy.topRows(count), v.vz.topRows(count)};
  const Eigen::MatrixXd other[3] = {interpolate(s.time, s.vx, time), interpolate(s.time, s.vy, time),
                                    interpolate(s.time, s.vz, time)};
  const Eigen::MatrixXd slow = compute_slow_part(own[2], step, recoupling_split_frequency);
  const Eigen::MatrixXd other_slow = compute_slow_part(other[2], step, recoupling_split_frequency);
  for (Index r = 0; r < v.vz.cols(); ++r) {
    MotionDifference d;
    d.receiver = v.receivers[static_cast<std::size_t>(r)].name;
    const double whole = std::hypot(other[0].col(r).norm(), other[1].col(r).norm(), other[2].col(r).norm());
    for (int c = 0; c < 3; ++c)
      d.l2[c] = compute_ratio((own[c].col(r) - other[c].col(r)).norm(), other[c].col(r).norm(), whole);
    const Eigen::VectorXd quick = own[2].col(r) - slow.col(r),
                          other_quick = other[2].col(r) - other_slow.col(r);
    d.dynamic_l2_z = compute_ratio((quick - other_quick).norm(), other_quick.norm(), whole);
    d.ppv_z[0] = compute_peak(v.vz.col(r));
    d.ppv_z[1] = compute_peak(s.vz.col(r));
    differences.push_back(d);
  }
  return differences;
}

}  // namespace easydyn::soil

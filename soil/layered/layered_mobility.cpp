#include "soil/layered/layered_mobility.hpp"

#include "easydyn/require.hpp"
#include "soil/impulse_synthesis.hpp"
#include "soil/layered/footprint_response.hpp"

namespace easydyn::soil {

void update_mobility(const LayeredGround& ground, double highest_frequency, Mobility& mobility, double window,
                     int threads) {
  require_positive("mobility", "highest frequency", highest_frequency, "Hz");
  require_not_negative("mobility", "window", window, "s");
  if (window == 0) window = estimate_window(ground.slowest_cs(), mobility);
  const ImpulseSynthesis synthesis(highest_frequency, window, threads);

  FootprintRequest request;
  request.length = mobility.length;
  request.width = mobility.width;
  request.points = mobility.places;
  request.threads = threads;
  for (const auto& shift : mobility.shifts) {
    request.means.push_back({shift[0], shift[1], mobility.length, mobility.width});
  }
  const FootprintResponse response = compute_footprint_response(ground, request, synthesis.w());
  synthesis.update(mobility, response.ux, response.uy, response.uz, response.mean);
  for (auto& [direction, horizontal] : mobility.horizontal) {
    request.direction = direction;
    const FootprintResponse u = compute_footprint_response(ground, request, synthesis.w());
    horizontal = {synthesis.transform(u.ux),     synthesis.transform(u.uy),     synthesis.transform(u.uz),
                  synthesis.transform(u.mean_x), synthesis.transform(u.mean_y), synthesis.transform(u.mean)};
  }
}

}  // namespace easydyn::soil

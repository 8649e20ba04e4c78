#include "soil/layered/layered_mobility.hpp"

#include <fmt/format.h>

#include "easydyn/require.hpp"
#include "soil/impulse_synthesis.hpp"
#include "soil/layered/footprint_response.hpp"
#include "soil/physical_memory.hpp"

namespace easydyn::soil {

void update_mobility(const LayeredGround& ground, double highest_frequency, Mobility& mobility, double window,
                     int threads) {
  require_positive("mobility", "highest frequency", highest_frequency, "Hz");
  require_not_negative("mobility", "window", window, "s");
  if (window == 0) window = estimate_window(ground.slowest_cs(), mobility);
  const ImpulseSynthesis synthesis(highest_frequency, window, threads);

  // Responses of all loads, and the spectra of one: of complex values at 1.75 / 4 of the samples.
  const double samples = (window + 16 / highest_frequency) * 4 * highest_frequency,
               places = static_cast<double>(mobility.places.size()),
               shifts = static_cast<double>(mobility.shifts.size()),
               directions = static_cast<double>(mobility.horizontal.size()),
               columns = 3 * places + (directions > 0 ? 3 : 1) * shifts;
  require_memory(
      samples * (8 * (3 * places + shifts + directions * 3 * (places + shifts)) + 7 * columns),
      fmt::format("impulse responses of {:.3g} s at {} distances of receivers and {} of footprints", window,
                  mobility.places.size(), mobility.shifts.size()),
      "take fewer receivers or a shorter window");

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

#include "soil/layered/superposition_memory.hpp"

#include <algorithm>

namespace easydyn::soil {

double estimate_memory(const SuperpositionSize& size) {
  constexpr double real = 8, complex = 16;  // [byte]
  const auto footprints = static_cast<double>(size.footprints),
             receivers = static_cast<double>(size.receivers), lines = static_cast<double>(size.lines),
             outputs = static_cast<double>(size.outputs), circle = static_cast<double>(size.circle),
             horizontal = static_cast<double>(size.horizontal);
  // Signal, spectrum, and the factors and copies of the FFT, of each thread.
  const auto transform = [&](double length) { return 6 * real * length * size.threads; };
  const double spectra_of_loads = complex * lines * footprints;

  // Loads with their band limited, their splines, and at the step of the responses, twice while they are turned round.
  const double samples = real * static_cast<double>(size.samples) * footprints;
  const double loads = 3 * real * static_cast<double>(size.given) * footprints + samples +
                       std::max(samples, spectra_of_loads + transform(circle));

  // Three components at the receivers: responses, sums, and each sum over again times its rate.
  const double column = complex * lines * static_cast<double>(size.places);
  const double record = real * outputs * receivers;
  const double of_receivers =
      spectra_of_loads + 3 * (1 + horizontal) * column +
      std::max(column + transform(circle),
               4 * complex * lines * receivers + 3 * record + transform(size.refinement * circle));

  // Mean displacements of the footprints; an even row turns loads, responses and sums round.
  const double means = complex * lines * static_cast<double>(size.shifts) * (1 + 3 * horizontal);
  const double of_footprints =
      spectra_of_loads + 3 * record + means +
      std::max((size.is_even_row ? 4 : 1) * spectra_of_loads,
               spectra_of_loads + real * outputs * footprints + transform(size.refinement * circle));
  return std::max({loads, of_receivers, of_footprints});
}

}  // namespace easydyn::soil

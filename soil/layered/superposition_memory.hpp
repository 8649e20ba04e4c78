#pragma once

#include <Eigen/Core>

namespace easydyn::soil {

/// What superpose() works on, as numbers.
struct SuperpositionSize {
  Eigen::Index footprints = 0, receivers = 0;
  Eigen::Index places = 0, shifts = 0;  ///< distances of receivers and of footprints, as Mobility has them
  Eigen::Index horizontal = 0;          ///< directions in Mobility::horizontal
  Eigen::Index given = 0;               ///< samples of the loads as given
  Eigen::Index samples = 0;             ///< of the loads at the step of the responses
  Eigen::Index circle = 0;              ///< samples on which loads and responses are folded
  Eigen::Index lines = 0;               ///< of a spectrum
  Eigen::Index outputs = 0;             ///< samples of the record
  int refinement = 3;                   ///< steps of the record in a step of the responses
  int threads = 1;
  bool is_even_row = true;  ///< of footprints
};

/// Largest memory that superpose() takes at a time beside its arguments, its result included [byte].
double estimate_memory(const SuperpositionSize& size);

}  // namespace easydyn::soil

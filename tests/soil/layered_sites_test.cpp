// Finite elements against the semi-analytical half-space: far from the load, and with a layer slower than the one above.

#include <gtest/gtest.h>

#include "tests/soil/layered_comparison.hpp"
#include "tests/soil/verification_record.hpp"

namespace easydyn::soil {
namespace {

using test::compare_with_layered_half_space;
using test::damped_layer;
using test::record_verification;

TEST(FiniteElements, AgreeWithTheLayeredHalfSpaceUpToFiftyMetres) {
  Site site;
  site.layers = {damped_layer(5, 150), damped_layer(0, 300)};
  site.highest_frequency = 40;
  site.margin = 6;
  site.duration = 0.8;
  const std::vector<double> errors = compare_with_layered_half_space(site, {5, 10, 20, 30, 50}, 10);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_LT(errors[k], 0.01);
  EXPECT_LT(errors[4], 0.025);
  record_verification("layered-30-m", 100 * *std::max_element(errors.begin(), errors.end() - 1));
  record_verification("layered-50-m", 100 * errors[4]);
}

TEST(FiniteElements, AgreeWithTheLayeredHalfSpaceOverALayerOfLowVelocity) {
  Site site;
  site.layers = {damped_layer(2, 180), damped_layer(2, 100), damped_layer(3, 220), damped_layer(0, 300)};
  site.highest_frequency = 30;
  site.margin = 6;
  site.duration = 0.5;
  const std::vector<double> errors = compare_with_layered_half_space(site, {5, 10, 20}, 10);
  for (const double error : errors) EXPECT_LT(error, 0.01);
  record_verification("low-velocity-layer", 100 * *std::max_element(errors.begin(), errors.end()));
}

}  // namespace
}  // namespace easydyn::soil

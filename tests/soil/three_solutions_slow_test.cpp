#include <gtest/gtest.h>

#include "tests/soil/three_solutions.hpp"

namespace easydyn::soil {
namespace {

TEST(ThreeSolutions, AgreeOnTheTramsGroundUpTo80Hz) {
  const Site site = read_site(std::filesystem::path(EASYDYN_SITES) / "tram.toml");
  const test::Differences d = test::solve_in_three_ways(site, test::make_tram_loads(14.1, 30, 80));
  EXPECT_LT(d.elements_from_layered, 0.03);
  EXPECT_LT(d.direct_from_layered, 0.03);
  EXPECT_LT(d.elements_from_direct, 0.03);
}

}  // namespace
}  // namespace easydyn::soil

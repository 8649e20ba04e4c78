#include "tests/soil/three_solutions.hpp"

#include <gtest/gtest.h>

namespace easydyn::soil {
namespace {

TEST(ThreeSolutions, AgreeOnTheTramsGroundUpTo40Hz) {
  Site site = read_site(std::filesystem::path(EASYDYN_SITES) / "tram.toml");
  site.highest_frequency = 40;
  site.receivers.pop_back();  // 16 m: to be quick
  const SurfaceLoads loads = test::make_tram_loads(10.1, 30, 40);
  const test::Differences d = test::solve_in_three_ways(site, loads);
  EXPECT_LT(d.elements_from_layered, 0.03);
  EXPECT_LT(d.direct_from_layered, 0.03);
  EXPECT_LT(d.elements_from_direct, 0.03);
}

}  // namespace
}  // namespace easydyn::soil

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/examples/tram_on_its_ground.hpp"
#include "tests/soil/verification_record.hpp"
#include "tests/temporary_folder.hpp"

namespace easydyn::examples {
namespace {

// ./run tram as it is, up to 80 Hz and at all its receivers, until its front bogie has crossed the joint, at 1.68 and 1.9 s:
// the other four blows are of the same kind, and the direct run would take more than twice as long.
TEST(TramOnItsGround, MovesItAlikeInThreeWaysUpTo80Hz) {
  const easydyn::testing::TemporaryFolder folder;
  folder.write("tram.toml",
               easydyn::testing::read_whole_file(std::filesystem::path(EASYDYN_SITES) / "tram.toml") +
                   "\n[loads]\nduration = 2.5\n");
  const test::TramOnItsGround tram = test::solve_tram(folder.path(), "");
  EXPECT_EQ(tram.direct.highest_frequency, 80);
  EXPECT_EQ(tram.direct.receivers.size(), 4u);
  const test::TramDifferences elements = test::compare("elements, layered", tram.elements, tram.layered),
                              direct = test::compare("direct, layered", tram.direct, tram.layered),
                              both = test::compare("elements, direct", tram.elements, tram.direct);
  test::expect_verified_alike(tram);
  soil::test::record_verification("tram-elements", 100 * std::max(elements.whole, elements.quick));
  soil::test::record_verification("tram-direct", 100 * std::max(direct.whole, direct.quick));
  soil::test::record_verification("tram-both", 100 * std::max(both.whole, both.quick));
  soil::test::record_verification("tram-peaks", 100 * std::max({elements.ppv, direct.ppv, both.ppv}));
  soil::test::record_verification("tram-kb", 100 * std::max({elements.kb, direct.kb, both.kb}));
  soil::test::record_verification("tram-octaves", std::max({elements.octaves, direct.octaves, both.octaves}));
  for (const test::TramDifferences& d : {elements, direct, both}) test::expect_alike(d);
  // The same elements and the time error taken from both: 0.64 % at 2 m, 0.1 % from 4 m on.
  EXPECT_LT(both.whole, 0.01);
}

}  // namespace
}  // namespace easydyn::examples

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cstdlib>

#include "easydyn/results/result_file.hpp"
#include "soil/vibrations.hpp"
#include "tests/browser/browser.hpp"
#include "tests/temporary_folder.hpp"

namespace easydyn::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

// Two layers and so low a highest frequency that the waves take seconds.
const char* const coarse_site = R"(name = "coarse"
[[layer]]
thickness = 3
density = 1900
cs = 150
nu = 0.35
damping = 0.03
[[layer]]
density = 1900
cs = 250
nu = 0.35
damping = 0.03
[[receiver]]
name = "4 m"
distance = 4
[[receiver]]
name = "12 m"
distance = 12
[solver]
highest_frequency = 12
damping_frequency = 6
points_per_wavelength = 4
)";

/// The built programs one after the other, as `./run tram` calls them.
class TramReport : public ::testing::Test {
 protected:
  void call(const std::string& command) {
    const std::string log = (folder_ / "log.txt").string();
    const int status = std::system(fmt::format("{} >'{}' 2>&1", command, log).c_str());
    ASSERT_EQ(status, 0) << command << "\n" << read_whole_file(log);
  }
  TemporaryFolder folder_;
};

TEST_F(TramReport, IsDrawnFromARealPassageAndAsksForNothing) {
  const std::string results = folder_.path().string();
  const std::string site = folder_.write("site.toml", coarse_site).string();
  ASSERT_NO_FATAL_FAILURE(call(fmt::format("'{}' --speed 90 --output '{}'", TRAM_PROGRAM, results)));
  ASSERT_NO_FATAL_FAILURE(call(fmt::format("'{}' run '{}' '{}/surface_loads.h5' --output '{}'", SOIL_PROGRAM,
                                           site, results, results)));
  ASSERT_NO_FATAL_FAILURE(call(fmt::format("'{}' report '{}'", SOIL_PROGRAM, results)));

  const soil::Vibrations v = soil::read_vibrations(folder_ / "vibrations.h5");
  ASSERT_EQ(v.indicators.size(), 2u);
  EXPECT_GT(v.indicators[1].ppv[3], 0);
  EXPECT_GT(v.indicators[0].ppv[3], v.indicators[1].ppv[3]);

  const std::string page = read_whole_file(folder_ / "report.html");
  EXPECT_THAT(page, HasSubstr("at 90 km/h over a rail step of 1 mm"));
  EXPECT_THAT(page, HasSubstr("band-limited to 12 Hz"));
  EXPECT_THAT(page, HasSubstr("recoupling error"));
  EXPECT_LT(page.size(), 10'000'000u);
  if (!has_browser()) GTEST_SKIP() << "no Chromium on this machine";
  const Visit seen = visit(folder_ / "report.html", folder_.path());
  EXPECT_THAT(seen.root, HasSubstr("data-ready=\"true\""));
  EXPECT_THAT(seen.root, Not(HasSubstr("data-failure")));
  EXPECT_THAT(seen.root, HasSubstr("data-animations=\"1\""));
  EXPECT_THAT(seen.root, Not(HasSubstr("data-charts=\"0\"")));
  EXPECT_THAT(seen.console, IsEmpty());
  EXPECT_THAT(seen.requests, IsEmpty());
}

}  // namespace
}  // namespace easydyn::testing

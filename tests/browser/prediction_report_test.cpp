#include "soil/report/prediction_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "easydyn/error.hpp"
#include "tests/browser/synthetic_results.hpp"
#include "tests/temporary_folder.hpp"

using namespace easydyn;
using namespace easydyn::testing;
using ::testing::HasSubstr;
using ::testing::Not;

namespace {

class PredictionReport : public ::testing::Test {
 protected:
  std::string write() {
    soil::write_prediction_report(folder_.path(), folder_ / "report.html");
    return read_whole_file(folder_ / "report.html");
  }
  TemporaryFolder folder_;
};

}  // namespace

TEST_F(PredictionReport, HoldsBothStepsTheirMeetingAndTheirParameters) {
  write_synthetic_results(folder_.path());
  const std::string page = write();
  for (const char* text :
       {"Railway ground vibration: prediction", "Step 1: vehicle and track", "Step 2: ground vibration",
        "recoupling error", "band-limited to 50 Hz", "no better than about 10 dB", "dB re 5·10⁻⁸ m/s",
        "synthetic --speed 30 --out &lt;folder&gt;", "M-l: made up", "F: made up &lt;&amp;&gt;", "cs = 150",
        "Limits and assumptions"}) {
    EXPECT_THAT(page, HasSubstr(text));
  }
}

TEST_F(PredictionReport, ShowsTheVehicleTheRailAndTheLossesOfContact) {
  write_synthetic_results(folder_.path());
  const std::string page = write();
  EXPECT_THAT(page, HasSubstr("<svg role=\"img\" viewBox=\"0 0 100 20\"><title>Made-up tram</title>"));
  EXPECT_LT(page.find("Made-up tram"), page.find("Made-up masses"));
  EXPECT_LT(page.find("Made-up masses"), page.find("Rail profile"));
  EXPECT_LT(page.find("Rail profile"), page.find("Wheel/rail contact forces"));
  EXPECT_THAT(page, HasSubstr("made-up heights"));
  EXPECT_THAT(
      page,
      HasSubstr("1 of 6 wheelsets left the rail, 2 times in all, longest 17.0 ms (middle gear, front)"));
  for (const char* text : {"losses of contact", "longest [ms]", "in total [ms]", "largest / static"})
    EXPECT_THAT(page, HasSubstr(text));
}

TEST_F(PredictionReport, QuotesTheRecouplingErrorWithTheSemiAnalyticalSoilToo) {
  const auto errors = [&](bool has_semi_analytical) {  // of the quasi-static part: cells after its name
    write_synthetic_results(folder_.path(), has_semi_analytical);
    const std::string page = write();
    EXPECT_EQ(page.find("relative L2, semi-analytical soil [%]") != page.npos, has_semi_analytical);
    std::size_t at = page.find("quasi-static, below 2 Hz</td>");
    const std::string row = page.substr(at, page.find("</tr>", at) - at);
    std::vector<double> cells;
    for (at = 0; (at = row.find("<td", at)) != row.npos; ++at)
      cells.push_back(std::stod(row.substr(row.find('>', at) + 1)));
    return cells;
  };
  const std::vector<double> both = errors(true);
  EXPECT_EQ(errors(false).size(), 2u);
  ASSERT_EQ(both.size(), 4u);
  EXPECT_NEAR(both[0], 8.7, 0.1);  // 1 / 0.92 - 1 = 8.7 %
  EXPECT_LT(both[2], 0.1);
}

TEST_F(PredictionReport, HoldsOneStepIfThereIsOne) {
  write_synthetic_results(folder_.path());
  std::filesystem::remove(folder_ / "vibrations.h5");
  std::string page = write();
  EXPECT_THAT(page, HasSubstr("Step 1: vehicle and track"));
  EXPECT_THAT(page, Not(HasSubstr("Step 2: ground vibration")));

  write_synthetic_results(folder_.path());
  std::filesystem::remove(folder_ / "results.h5");
  page = write();
  EXPECT_THAT(page, Not(HasSubstr("Step 1: vehicle and track")));
  EXPECT_THAT(page, HasSubstr("Step 2: ground vibration"));
  EXPECT_THAT(page, Not(HasSubstr("Where both steps meet")));
}

TEST_F(PredictionReport, RefusesAFolderWithoutResults) {
  EXPECT_THAT(message_of<InputError>([&] { write(); }),
              HasSubstr(folder_.path().string() + ": holds neither results.h5 nor vibrations.h5"));
}

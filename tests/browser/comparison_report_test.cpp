#include "soil/report/comparison_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "easydyn/error.hpp"
#include "soil/report/comparison.hpp"
#include "soil/vibrations.hpp"
#include "tests/temporary_folder.hpp"

using namespace easydyn;
using namespace easydyn::testing;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

namespace {

using soil::Vibrations;

/// A pulse of some 20 Hz that passes three receivers, the farther the weaker: up to 50 Hz, 4 s.
Vibrations make_passage() {
  Vibrations v;
  v.time = Eigen::VectorXd::LinSpaced(2000, 0, 3.998);
  v.receivers = {{"8 m", {0, 8, 0}, ""}, {"16 m", {0, 16, 0}, ""}, {"32 m", {0, 32, 0}, ""}};
  v.vz.resize(v.time.size(), 3);
  for (Eigen::Index r = 0; r < 3; ++r) {
    const auto since = v.time.array() - 1 - 0.05 * double(r);
    v.vz.col(r) =
        1e-3 / double(1 << r) * (-(since / 0.03).square()).exp() * (2 * std::numbers::pi * 20 * since).sin();
  }
  v.vx = 0.3 * v.vz;
  v.vy = 0.5 * v.vz;
  v.footprint_x = v.footprint_taper = Eigen::VectorXd::Ones(1);
  v.footprint_displacement = Eigen::MatrixXd::Zero(v.time.size(), 1);
  v.highest_frequency = 50;
  v.method = "made up";
  v.parameters = {{"layer 1", "shear wave speed", 150, "m/s", "made up"}, {"mesh", "steps", 4000, "1", "-"}};
  return v;
}

class ComparisonReport : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, Vibrations v) {
    std::filesystem::create_directories(folder_ / name);
    soil::update_indicators(v);
    soil::write_vibrations(folder_ / name / "vibrations.h5", v, {.program = "test", .command = "made up"});
    return folder_ / name;
  }
  std::string compare(const std::vector<std::filesystem::path>& folders) {
    soil::write_comparison_report(folders, folder_ / "comparison.html");
    return read_whole_file(folder_ / "comparison.html");
  }
  std::string fault(const std::vector<std::filesystem::path>& folders) {
    const std::string message = message_of<InputError>([&] { compare(folders); });
    EXPECT_FALSE(std::filesystem::exists(folder_ / "comparison.html"));
    return message;
  }
  TemporaryFolder folder_;
};

/// The cells of the table with this caption, row by row; numbers with a true minus sign as printed.
std::vector<std::vector<std::string>> rows_of(const std::string& page, const std::string& caption) {
  std::size_t at = page.find(caption);
  EXPECT_NE(at, page.npos) << caption;
  at = page.find("<tbody>", at);
  std::istringstream body(page.substr(at, page.find("</tbody>", at) - at));
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(body, line);) {
    if (!line.starts_with("<tr>")) continue;
    rows.emplace_back();
    for (std::size_t cell = 0; (cell = line.find("<td", cell)) != line.npos;) {
      const std::size_t from = line.find('>', cell) + 1;
      cell = line.find("</td>", from);
      rows.back().push_back(line.substr(from, cell - from));
    }
  }
  return rows;
}

double number_of(std::string text) {
  if (text.starts_with("\u2212")) text.replace(0, std::string("\u2212").size(), "-");
  return std::stod(text);
}

}  // namespace

TEST_F(ComparisonReport, SaysHowMuchLouderEachReceiverIs) {
  const auto plain = write("plain", make_passage());
  Vibrations v = make_passage();
  v.vx *= 2, v.vy *= 2, v.vz *= 2;
  v.parameters[0].value = 120;
  const std::string page = compare({plain, write("louder", v)});
  const auto rows = rows_of(page, "Indicators, and their change");
  ASSERT_EQ(rows.size(), 6u);
  for (std::size_t r = 1; r < 6; r += 2) {  // twice the motion: 20 log10(2) = 6.02 dB of every indicator
    EXPECT_EQ(rows[r][1], "louder");
    for (const std::size_t c : {3u, 5u, 7u, 9u}) EXPECT_EQ(rows[r][c], "+6.0") << r << ", " << c;
  }
  EXPECT_EQ(rows[0][0], "8 m");
  EXPECT_NEAR(number_of(rows[1][2]), 2 * number_of(rows[0][2]), 0.006);  // of three digits [mm/s]
  int known = 0;
  for (const auto& band : rows_of(page, "Insertion loss, louder against plain [dB]"))
    if (band[1] != "\u2013") {
      EXPECT_EQ(band[1], "\u22126.0") << band[0];  // louder: a negative loss
      ++known;
    }
  EXPECT_GT(known, 10);
  for (const char* text :
       {"plain \u00b7 louder", "Vertical velocity at 16 m", "One-third octave spectra of v_z at 32 m",
        "Insertion loss at 8 m", "no better than about 10 dB"})
    EXPECT_THAT(page, HasSubstr(text));
  EXPECT_THAT(rows_of(page, "Parameters that differ"),
              ElementsAre(ElementsAre("layer 1", "shear wave speed", "m/s", "150", "120")));
  EXPECT_THAT(page, Not(HasSubstr("records differ in length")));
}

TEST_F(ComparisonReport, ShowsReceiversThatTwoResultsShareAtWhateverPlaceInTheFile) {
  Vibrations other = make_passage();
  std::swap(other.receivers[0], other.receivers[2]);  // 32, 16 and 8 m
  other.receivers[1] = {"20 m", {0, 20, 0}, ""};
  other.receivers[0].position[1] += 5e-4;  // half a millimetre off: rounding of another file
  Vibrations third = make_passage();
  third.receivers[1] = {"here 20 m", {0, 20, 0}, ""};
  third.receivers[2] = {"40 m", {0, 40, 0}, ""};
  third.receivers[0] = {"8 m, deep", {0, 8, -2}, ""};
  const std::string page = compare({write("a", make_passage()), write("b", other), write("c", third)});
  const auto rows = rows_of(page, "Indicators, and their change");
  ASSERT_EQ(rows.size(), 6u);
  EXPECT_THAT((std::vector<std::string>{rows[0][0], rows[2][0], rows[4][0]}),
              ElementsAre("8 m", "20 m", "32 m"));
  EXPECT_EQ(rows[1][1], "b");
  EXPECT_EQ(rows[1][3], "\u221212.0");  // in b the quarter of 20 log10(1/4) = -12.04 dB stands at 8 m
  EXPECT_EQ(rows[3][1], "c");           // 20 m: the first result does not have it
  EXPECT_EQ(rows[5][3], "+12.0");
  EXPECT_THAT(page, HasSubstr("Against b, the first result with this receiver."));
  for (const char* text : {"at 16 m", "at 40 m", "at 8 m, deep"}) EXPECT_THAT(page, Not(HasSubstr(text)));
}

TEST_F(ComparisonReport, ComparesEnergiesOfRecordsOfUnlikeLength) {
  Vibrations longer = make_passage();  // the same passage, and as long a rest after it
  const Eigen::Index n = longer.time.size();
  longer.time = Eigen::VectorXd::LinSpaced(2 * n, 0, 0.002 * double(2 * n - 1));
  for (Eigen::MatrixXd* m : {&longer.vx, &longer.vy, &longer.vz, &longer.footprint_displacement}) {
    const Eigen::MatrixXd motion = *m;
    m->setZero(2 * n, motion.cols());
    m->topRows(n) = motion;
  }
  const std::string page = compare({write("short", make_passage()), write("long", longer)});
  EXPECT_THAT(page, HasSubstr("The records differ in length"));
  // The rms of the longer record is 3 dB lower; what is left are lines of half the width at the bands' edges.
  double largest = 0;
  for (const auto& band : rows_of(page, "Insertion loss, long against short [dB]"))
    if (band[1] != "\u2013") largest = std::max(largest, std::abs(number_of(band[1])));
  EXPECT_LT(largest, 0.15);  // measured: 0.1
}

TEST_F(ComparisonReport, SaysThatHighestFrequenciesDiffer) {
  Vibrations lower = make_passage();
  lower.highest_frequency = 25;
  const std::string page = compare({write("a", make_passage()), write("b", lower)});
  EXPECT_THAT(page, HasSubstr("The highest frequencies differ"));
  for (const auto& band : rows_of(page, "Insertion loss, b against a [dB]")) {
    if (std::stod(band[0]) > 24) {
      EXPECT_EQ(band[1], "\u2013") << band[0];
    }
  }
}

TEST_F(ComparisonReport, TellsFoldersOfOneNameApart) {
  using soil::report::make_labels;
  EXPECT_THAT(make_labels({"results/plain", "results/trench/"}), ElementsAre("plain", "trench"));
  EXPECT_THAT(make_labels({"a/out", "b/./out", "c"}), ElementsAre("a/out", "b/out", "c"));
  EXPECT_THAT(make_labels({"/a/x/out", "/b/x/out", "/b/y/out"}), ElementsAre("a/x/out", "b/x/out", "y/out"));
  EXPECT_THAT(make_labels({"/", "a"}), ElementsAre("/", "a"));
  EXPECT_THAT(make_labels({"/out", "/out/out"}), ElementsAre("out", "out/out"));
  EXPECT_THAT(message_of<InputError>([] {
                make_labels({"a/out", "a/b/../out/"});
              }),
              HasSubstr("a/b/../out/: given twice"));

  std::filesystem::create_directories(folder_ / "a");
  std::filesystem::create_directories(folder_ / "b");
  EXPECT_THAT(
      compare({write("a/out", make_passage()), write("b/out", make_passage())}),
      AllOf(HasSubstr("a/out \u00b7 b/out"), HasSubstr("No parameter of train, track or ground differs")));
}

TEST_F(ComparisonReport, RefusesWhatCannotBeCompared) {
  const auto a = write("a", make_passage());
  std::filesystem::create_directory(folder_ / "empty");
  EXPECT_THAT(fault({a, folder_ / "empty"}), HasSubstr("empty: holds no vibrations.h5"));
  EXPECT_THAT(fault({folder_ / "missing", a}), HasSubstr("missing: no such folder"));
  EXPECT_THAT(fault({a}), HasSubstr("1 folder, must be at least 2"));
  Vibrations elsewhere = make_passage();
  for (auto& receiver : elsewhere.receivers) receiver.position[0] = 3;
  EXPECT_THAT(fault({a, write("b", elsewhere)}),
              AllOf(HasSubstr("no two results have a receiver in common"),
                    HasSubstr("a: (0, 8, 0), (0, 16, 0), (0, 32, 0)"), HasSubstr("b: (3, 8, 0), ")));
}

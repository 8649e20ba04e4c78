// The programs of trains from outside: what their options change, what they print, write and return.

#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cstdio>
#include <fstream>

#include "soil/surface_loads.hpp"
#include "tests/temporary_folder.hpp"

namespace easydyn::examples {
namespace {

namespace fs = std::filesystem;
using easydyn::testing::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

struct Outcome {
  int status = 0;
  std::string text;  // both streams
};

/// Quick: with the longest step that the output allows.
Outcome run_program(const std::string& program, const std::string& options) {
  const std::string command = program + " --time-step 5e-4 " + options + " 2>&1";
  Outcome outcome;
  FILE* const pipe = popen(command.c_str(), "r");
  char buffer[4096];
  for (std::size_t n; (n = fread(buffer, 1, sizeof buffer, pipe)) > 0;) outcome.text.append(buffer, n);
  outcome.status = WEXITSTATUS(pclose(pipe));
  return outcome;
}

Outcome run_tram(const std::string& options) {
  return run_program(TRAM_PROGRAM, options);
}

/// A figure of the summary that the program prints.
double figure(const std::string& text, const std::string& name) {
  const std::size_t at = text.find(name);
  if (at == std::string::npos) ADD_FAILURE() << "no \"" << name << "\" in\n" << text;
  return at == std::string::npos ? std::nan("") : std::stod(text.substr(at + name.size()));
}

TEST(PassageProgram, ChangesTheExcitationAsItsOptionsSay) {
  const TemporaryFolder folder;
  const std::string quick = "--speed 100 --output " + folder.path().string();
  const auto largest = [&](const std::string& options) {
    const Outcome outcome = run_tram(quick + " " + options);
    EXPECT_EQ(outcome.status, 0) << outcome.text;
    return figure(outcome.text, "largest dynamic load factor of a wheel pair");
  };
  const double perfect = largest("--step-height 0");
  EXPECT_LT(perfect, 1.02);  // the ripple of the sleepers
  EXPECT_GT(largest("--step-height 0.3"), 1.5);
  EXPECT_GT(largest("--step-height 0 --wheel-flat 40"), 1.5);
  const double seed_1 = largest("--step-height 0 --irregularity sncf_good"),
               seed_2 = largest("--step-height 0 --irregularity sncf_good --seed 2");
  EXPECT_GT(seed_1, 1.05);
  EXPECT_NE(seed_1, seed_2);
  EXPECT_EQ(seed_1, largest("--step-height 0 --irregularity sncf_good --seed 1"));

  // A sine of 3 m and 2 mm, measured every 0.1 m.
  const fs::path profile = folder.path() / "profile.csv";
  std::ofstream file(profile);
  file << "x [m], r [mm]\n";
  for (int i = -300; i <= 300; ++i)
    file << 0.1 * i << "," << 2 * std::sin(2 * std::acos(-1.0) * 0.1 * i / 3) << "\n";
  file.close();
  EXPECT_GT(largest("--step-height 0 --profile " + profile.string()), 1.05);
}

TEST(PassageProgram, TakesSimplerTrainsAndFoundations) {
  const TemporaryFolder folder;
  const std::string quick = "--speed 100 --step-height 0 --output " + folder.path().string();
  const double weight = figure(run_tram(quick).text, "vehicle weight");
  double rigid = 0, winkler = 0;
  for (const std::string detail : {"three-masses", "quarter", "wheel-pair"}) {
    const Outcome outcome = run_tram(quick + " --foundation winkler --detail " + detail);
    ASSERT_EQ(outcome.status, 0) << outcome.text;
    EXPECT_THAT(outcome.text, AllOf(HasSubstr("in the detail \"" + detail + "\""), HasSubstr("Winkler")));
    EXPECT_NEAR(figure(outcome.text, "vehicle weight"), weight, 1e-3 * weight);
    winkler = figure(outcome.text, "largest rail deflection");
  }
  rigid = figure(run_tram(quick + " --foundation rigid").text, "largest rail deflection");
  EXPECT_LT(rigid, winkler);

  // What is left for the ground is that of the last run: its time, its sleepers within 14 m.
  const soil::SurfaceLoads loads = soil::read_surface_loads(folder.path() / "surface_loads.h5");
  for (const soil::Footprint& footprint : loads.footprints) EXPECT_LE(std::abs(footprint.x), 14);
  EXPECT_GT(loads.footprints.size(), 36u);
  EXPECT_TRUE(fs::exists(folder.path() / "results.h5"));
  EXPECT_TRUE(fs::exists(folder.path() / "channels.csv"));
}

TEST(PassageProgram, TakesMovingLoadsAndALongerLoadedGround) {
  const TemporaryFolder folder;
  const Outcome outcome =
      run_tram("--speed 100 --detail moving-loads --loaded 20 --output " + folder.path().string());
  ASSERT_EQ(outcome.status, 0) << outcome.text;
  // Constant forces: the step of the rail and the sleepers do not matter to them.
  EXPECT_NEAR(figure(outcome.text, "largest dynamic load factor of a wheel pair"), 1, 1e-12);
  EXPECT_NEAR(figure(outcome.text, "vehicle weight"), 358.1, 0.1);  // 36.5 t
  const soil::SurfaceLoads loads = soil::read_surface_loads(folder.path() / "surface_loads.h5");
  double farthest = 0;
  for (const soil::Footprint& footprint : loads.footprints)
    farthest = std::max(farthest, std::abs(footprint.x));
  EXPECT_GT(farthest, 19);
  EXPECT_LE(farthest, 20);
}

TEST(PassageProgram, WarnsOfATrainFasterThanTheWavesOfTheGround) {
  const TemporaryFolder folder;
  const std::string options =
      "--detail moving-loads --irregularity none --loaded 5 --output " + folder.path().string();
  const auto run_hst = [&](const std::string& speed) {
    const Outcome outcome = run_program(HST_PROGRAM, "--speed " + speed + " " + options);
    EXPECT_EQ(outcome.status, 0) << outcome.text;
    return outcome.text;
  };
  // c_R = 0.932 x 80 m/s = 74.6 m/s; warned from 0.7 c_R = 52 m/s = 188 km/h on
  EXPECT_THAT(run_hst("300"), HasSubstr("speed 83.3 m/s is 1.12 of the Rayleigh speed 74.6 m/s"));
  EXPECT_THAT(run_hst("200"), HasSubstr("its waves gather around the train"));
  EXPECT_THAT(run_hst("150"), Not(HasSubstr("Rayleigh")));
}

TEST(PassageProgram, SweepsSpeedsToATableAndChartsWithoutLoads) {
  const TemporaryFolder folder;
  const Outcome outcome = run_tram("--speed 100,60,80 --step-height 0 --output " + folder.path().string());
  EXPECT_EQ(outcome.status, 0);
  // sorted, whatever the order given
  EXPECT_LT(outcome.text.rfind("      60 "), outcome.text.rfind("      80 "));
  EXPECT_LT(outcome.text.rfind("      80 "), outcome.text.rfind("     100 "));
  EXPECT_TRUE(fs::exists(folder.path() / "sweep.html"));
  EXPECT_FALSE(fs::exists(folder.path() / "surface_loads.h5"));
}

TEST(PassageProgram, RefusesOptionsOutOfRangeAndFilesThatAreNoProfile) {
  const TemporaryFolder folder;
  const std::string output = " --output " + (folder.path() / "none").string();
  const auto expect_refusal = [&](const std::string& options, int status, const std::string& message) {
    const Outcome outcome = run_tram(options + output);
    EXPECT_EQ(outcome.status, status) << options;
    EXPECT_THAT(outcome.text, HasSubstr(message)) << options;
  };
  expect_refusal("--speed 500", 2, "500, must be a number from");
  expect_refusal("--speed nan", 2, "nan, must be a number from");
  expect_refusal("--step-height 30", 2, "30, must be a number from -20 to 20");
  expect_refusal("--irregularity smooth", 2, "smooth");
  expect_refusal("--detail half", 2, "half");
  const fs::path profile = folder.path() / "profile.csv";
  std::ofstream(profile) << "x [m], r [mm]\n0,0\n0.1,x\n";
  expect_refusal("--profile " + profile.string(), 1, "profile.csv:3");
  EXPECT_FALSE(fs::exists(folder.path() / "none" / "results.h5"));
}

}  // namespace
}  // namespace easydyn::examples

// `soil run` on several ranks from outside, against the same run on one.

#include <gmock/gmock.h>
#include <sys/wait.h>

#include <array>
#include <cstdlib>
#include <map>
#include <numbers>

#include "soil/surface_loads.hpp"
#include "soil/vibrations.hpp"
#include "tests/temporary_folder.hpp"
#include "tests/vtu_reader.hpp"

namespace easydyn::soil {
namespace {

namespace fs = std::filesystem;
using easydyn::testing::read_whole_file;
using easydyn::testing::TemporaryFolder;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string small_site = R"(name = "small"
[[layer]]
name = "loam"
thickness = 9
density = 1800
damping = 0.03
cs = 200
nu = 0.33
[[layer]]
density = 2000
damping = 0.02
cs = 300
nu = 0.33
[[receiver]]
name = "10 m"
distance = 10
[[receiver]]
name = "deep"
position = [3, 7, -4]
[solver]
highest_frequency = 10
damping_frequency = 5
points_per_wavelength = 4
margin = 0
[loads]
taper_length = 0
)";

const std::string wall = R"([[block]]
name = "wall"
x = [-6, 6]
y = [-5, 5]
z = [-6, 0]
density = 2400
cs = 600
nu = 0.2
damping = 0.01
)";

class RunOnRanks : public ::testing::Test {
 protected:
  RunOnRanks() {
    setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
    setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
    setenv("OMPI_MCA_mpi_yield_when_idle", "1", 1);  // more ranks than cores
    SurfaceLoads loads;
    loads.time = Eigen::VectorXd::LinSpaced(61, 0, 0.3);
    loads.footprints = {{0, 0, 2, 2.5}};
    loads.force =
        1e4 * (std::numbers::pi * ((loads.time.array() - 0.05) / 0.2).min(1).max(0)).sin().square().matrix();
    write_surface_loads(folder_ / "loads.h5", loads, {.program = "test"});
    set_site(small_site + "decay_time = 0.05\n");
  }

  // Tables come before the sections.
  static std::string with_tables(const std::string& tables) {
    std::string site = small_site;
    return site.insert(site.find("[solver]"), tables) + "decay_time = 0.05\n";
  }
  void set_site(const std::string& text) { folder_.write("site.toml", text); }

  std::string command(int ranks, const std::string& out, const std::string& options) const {
    const std::string run = std::string(SOIL_PROGRAM) + " run " + (folder_ / "site.toml").string() + " " +
                            (folder_ / "loads.h5").string() + " --threads 1 --output " +
                            (folder_ / out).string() + " " + options;
    if (ranks == 1) return run;
    return std::string(MPIEXEC) + " --oversubscribe --bind-to none -n " + std::to_string(ranks) + " " +
           (starter_.empty() ? "" : "sh " + starter_ + " ") + run;
  }
  // Exit status; output goes to OUT.log and OUT.err.
  int run(int ranks, const std::string& out, const std::string& options = "") const {
    const std::string file = (folder_ / out).string();
    return status_of(
        std::system((command(ranks, out, options) + " >" + file + ".log 2>" + file + ".err").c_str()));
  }
  static int status_of(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : -1; }
  std::string log(const std::string& out) const { return read_whole_file(folder_ / (out + ".log")); }
  std::string err(const std::string& out) const { return read_whole_file(folder_ / (out + ".err")); }
  Vibrations result(const std::string& out) const { return read_vibrations(folder_ / out / "vibrations.h5"); }
  static int count(const std::string& text, const std::string& word) {
    int found = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++found;
    return found;
  }

  void expect_same(const std::string& one, const std::string& other, double tolerance) const {
    const Vibrations a = result(one), b = result(other);
    ASSERT_EQ(a.time, b.time);
    const auto difference = [](const Eigen::MatrixXd& x, const Eigen::MatrixXd& y) {
      return (x - y).cwiseAbs().maxCoeff();
    };
    const double peak =
        std::max({a.vx.cwiseAbs().maxCoeff(), a.vy.cwiseAbs().maxCoeff(), a.vz.cwiseAbs().maxCoeff()});
    EXPECT_LE(difference(a.vx, b.vx), tolerance * peak);
    EXPECT_LE(difference(a.vy, b.vy), tolerance * peak);
    EXPECT_LE(difference(a.vz, b.vz), tolerance * peak);
    const double deepest = a.footprint_displacement.cwiseAbs().maxCoeff();
    ASSERT_GT(deepest, 0);
    EXPECT_LE(difference(a.footprint_displacement, b.footprint_displacement), tolerance * deepest);
  }
  void expect_same_on(int ranks, const std::string& options, double tolerance) {
    ASSERT_EQ(run(1, "one", options), 0) << err("one");
    ASSERT_EQ(run(ranks, "many", options), 0) << err("many");
    expect_same("one", "many", tolerance);
  }

  TemporaryFolder folder_;
  std::string starter_;  // shell script that starts a rank
};

// The promise: 1e-5 of the peak in single precision, 1e-12 in double.
TEST_F(RunOnRanks, GivesTheMotionOfOneRankInSinglePrecision) {
  expect_same_on(2, "", 1e-5);
  EXPECT_THAT(log("many"), HasSubstr("ranks     2: "));
  EXPECT_EQ(count(log("many"), "mesh "), 1);  // one rank prints
  EXPECT_EQ(err("many"), "");
  expect_same_on(3, "--full-model --degree 5", 1e-5);
}

TEST_F(RunOnRanks, GivesTheMotionOfOneRankInDoublePrecision) {
  expect_same_on(4, "--double", 1e-12);
  expect_same_on(3, "--double --damping stiffness", 1e-12);
  expect_same_on(2, "--double --damping none --quarter-model", 1e-12);
}

TEST_F(RunOnRanks, GivesTheMotionOfOneRankWithBlocks) {
  set_site(with_tables(wall));
  expect_same_on(4, "--double", 1e-12);
}

TEST_F(RunOnRanks, GivesTheMotionOfOneRankWithACrossover) {
  expect_same_on(4, "--double --crossover 3", 1e-12);
}

TEST_F(RunOnRanks, JoinsThePiecesOfAPicture) {
  std::string site = with_tables("[[snapshot]]\nz = 0\nstep = 0.1\n[[snapshot]]\nx = 1\nstep = 0.1\n");
  const std::string margin = "margin = 0";  // wide enough that several ranks hold undamped ground
  set_site(site.replace(site.find(margin), margin.size(), "margin = 25"));
  ASSERT_EQ(run(1, "one", "--full-model"), 0) << err("one");
  ASSERT_EQ(run(4, "many", "--full-model"), 0) << err("many");
  for (const std::string plane : {"surface", "x=1"}) {
    const fs::path whole_folder = folder_ / "one/snapshots", pieces_folder = folder_ / "many/snapshots";
    const std::string index = read_whole_file(pieces_folder / (plane + ".pvd"));
    EXPECT_THAT(index, HasSubstr(plane + "/00000.pvtu"));
    fs::path picture;  // the last one: the ground moves
    for (const auto& entry : fs::directory_iterator(whole_folder / plane))
      picture = std::max(picture, entry.path());
    const testing::VtuContent whole = testing::read_vtu(picture);
    const std::vector<float> points = whole.values<float>("Points"),
                             velocity = whole.values<float>("velocity");
    std::map<std::array<float, 3>, std::array<float, 3>> motion;
    double peak = 0;
    const auto point = [](const std::vector<float>& values, std::size_t i) {
      return std::array{values[3 * i], values[3 * i + 1], values[3 * i + 2]};
    };
    for (std::size_t i = 0; i < points.size() / 3; ++i) {
      motion[point(points, i)] = point(velocity, i);
      for (int c = 0; c < 3; ++c) peak = std::max(peak, std::abs(double(velocity[3 * i + c])));
    }
    ASSERT_GT(peak, 0);
    std::map<std::array<float, 3>, int> found;
    std::size_t quads = 0;
    int pieces = 0;
    const std::string joint = read_whole_file(pieces_folder / plane / (picture.stem().string() + ".pvtu"));
    for (const testing::XmlElement& element : testing::parse_xml(joint)) {
      if (element.name != "Piece") continue;
      ++pieces;
      const testing::VtuContent piece =
          testing::read_vtu(pieces_folder / plane / element.attributes.at("Source"));
      quads += piece.values<std::int32_t>("offsets").size();
      const std::vector<float> places = piece.values<float>("Points"), here = piece.values<float>("velocity");
      for (std::size_t i = 0; i < places.size() / 3; ++i) {
        const auto at = point(places, i);
        ASSERT_TRUE(motion.contains(at));
        ++found[at];
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(here[3 * i + c], motion[at][c], 1e-5 * peak);
      }
    }
    EXPECT_GT(pieces, 1);
    EXPECT_EQ(found.size(), motion.size());
    EXPECT_EQ(quads, whole.values<std::int32_t>("offsets").size());
  }
}

TEST_F(RunOnRanks, StopsAsOneAndGoesOnToTheSameBits) {
  set_site(small_site + "decay_time = 3\n");
  ASSERT_EQ(run(2, "whole"), 0) << err("whole");
  // The signal reaches one rank only.
  folder_.write("start.sh",
                "echo $$ > " + (folder_ / "pid").string() + "$OMPI_COMM_WORLD_RANK\nexec \"$@\"\n");
  starter_ = (folder_ / "start.sh").string();
  const std::string parts = (folder_ / "parts").string(), pid = (folder_ / "pid1").string();
  const std::string stop = command(2, "parts", "") + " >" + parts + ".log 2>" + parts +
                           ".err & job=$!; until grep -q '^checkpoint' " + parts +
                           ".log; do sleep 0.02; done; sleep 0.3; kill -TERM $(cat " + pid + "); wait $job";
  ASSERT_EQ(status_of(std::system(stop.c_str())), 143) << err("parts");  // 128 + SIGTERM
  EXPECT_THAT(err("parts"), HasSubstr("soil: SIGTERM: stopped at t = "));
  EXPECT_EQ(count(err("parts"), "soil: SIGTERM"), 1);
  EXPECT_THAT(err("parts"), HasSubstr("To go on: mpirun -n 2 "));
  EXPECT_TRUE(fs::exists(folder_ / "parts/checkpoint.bin"));
  starter_.clear();

  EXPECT_EQ(run(1, "parts", "--restart"), 1);
  EXPECT_THAT(err("parts"), HasSubstr("number of ranks was 2, is 1"));
  // One byte of the other rank's part of the set is wrong: said once, by name, and nothing is lost.
  fs::path other;
  for (const auto& entry : fs::directory_iterator(folder_ / "parts"))
    if (entry.path().filename().string().starts_with("checkpoint.rank1.step")) other = entry.path();
  ASSERT_FALSE(other.empty());
  const std::string set = read_whole_file(other);
  std::string damaged = set;
  damaged[set.size() / 2] = static_cast<char>(damaged[set.size() / 2] ^ 1);
  folder_.write("parts/" + other.filename().string(), damaged);
  EXPECT_EQ(run(2, "parts", "--restart"), 1);
  EXPECT_EQ(count(err("parts"), "soil: "), 1);
  EXPECT_THAT(err("parts"), HasSubstr(other.filename().string() + ": is damaged: its checksum is "));
  EXPECT_FALSE(fs::exists(folder_ / "parts/vibrations.h5"));
  fs::remove(other);
  EXPECT_EQ(run(2, "parts", "--restart"), 1);
  EXPECT_THAT(err("parts"), HasSubstr(other.filename().string() + ": cannot be read, "));
  folder_.write("parts/" + other.filename().string(), set);
  ASSERT_EQ(run(2, "parts", "--restart"), 0) << err("parts");
  expect_same("whole", "parts", 0);
  for (const auto& entry : fs::directory_iterator(folder_ / "parts"))
    EXPECT_THAT(entry.path().filename().string(), Not(HasSubstr("checkpoint")));
}

TEST_F(RunOnRanks, FailsWithOneMessage) {
  fs::remove(folder_ / "loads.h5");
  EXPECT_EQ(run(3, "out"), 1);
  EXPECT_EQ(count(err("out"), "soil: "), 1);
  EXPECT_THAT(err("out"), HasSubstr("loads.h5: no such file"));
}

TEST_F(RunOnRanks, RefusesMoreRanksThanTheLatticeServes) {
  EXPECT_EQ(run(37, "out", "--dry-run"), 1);
  EXPECT_EQ(count(err("out"), "soil: "), 1);
  EXPECT_THAT(err("out"), HasSubstr("37 ranks, must be a product of at most"));
}

}  // namespace
}  // namespace easydyn::soil

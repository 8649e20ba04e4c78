// A run of the program `soil` that is stopped by a signal, and goes on.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <numbers>
#include <thread>
#include <vector>

#include "soil/mobility_file.hpp"
#include "soil/surface_loads.hpp"
#include "soil/vibrations.hpp"
#include "tests/temporary_folder.hpp"

namespace easydyn::soil {
namespace {

using easydyn::testing::read_whole_file;
using easydyn::testing::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

// Long waves and a long record: a second or two for a core.
const std::string long_site = R"([[layer]]
density = 1800
damping = 0.03
cs = 200
nu = 0.33
[[receiver]]
name = "10 m"
distance = 10
[solver]
highest_frequency = 10
damping_frequency = 5
points_per_wavelength = 4
margin = 0
[loads]
taper_length = 0
duration = 3
)";

class StoppedRun : public ::testing::Test {
 protected:
  StoppedRun() {
    SurfaceLoads loads;
    loads.time = Eigen::VectorXd::LinSpaced(121, 0, 0.6);
    loads.footprints = {{0, 0, 2, 2.5}};
    loads.force = 1e4 * (std::numbers::pi * loads.time.array() / 0.6).sin().square().matrix();
    write_surface_loads(folder_ / "loads.h5", loads, {.program = "test"});
    folder_.write("site.toml", long_site);
  }

  // Starts `soil run ... --output OUT`; its output goes to the files OUT.log and OUT.err.
  pid_t start(const std::string& out, const std::vector<std::string>& options = {}) const {
    std::vector<std::string> words = {SOIL_PROGRAM,
                                      "run",
                                      (folder_ / "site.toml").string(),
                                      (folder_ / "loads.h5").string(),
                                      "--output",
                                      (folder_ / out).string(),
                                      "--threads",
                                      "1"};
    words.insert(words.end(), options.begin(), options.end());
    return start_program(out, words);
  }
  pid_t start_program(const std::string& out, std::vector<std::string> words) const {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const std::string log = (folder_ / (out + ".log")).string(), err = (folder_ / (out + ".err")).string();
    const pid_t child = fork();
    if (child == 0) {
      for (const auto& [file, descriptor] : {std::pair(log, 1), std::pair(err, 2)}) {
        const int opened = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        if (opened < 0 || dup2(opened, descriptor) < 0) _exit(126);
      }
      std::signal(SIGINT, SIG_DFL);  // whoever runs the tests may ignore it
      execv(words[0].c_str(), arguments.data());
      _exit(127);
    }
    return child;
  }
  // Until the run is about to compute; false after a minute.
  bool wait_for_run(const std::string& out) const {
    return wait_until([&] { return log(out).find("checkpoint ") != std::string::npos; });
  }
  template <class Condition>
  static bool wait_until(Condition condition) {
    for (int i = 0; i < 30000; ++i) {
      if (condition()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return false;
  }
  // Exit status; 1000 + signal if it was killed.
  static int finish(pid_t child) {
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  }
  std::string log(const std::string& out) const { return read_whole_file(folder_ / (out + ".log")); }
  std::string err(const std::string& out) const { return read_whole_file(folder_ / (out + ".err")); }
  bool has(const std::string& name) const { return std::filesystem::exists(folder_ / name); }

  TemporaryFolder folder_;
};

TEST_F(StoppedRun, GoesOnToTheSameBits) {
  ASSERT_EQ(finish(start("whole")), 0) << err("whole");

  pid_t child = start("parts");
  ASSERT_TRUE(wait_for_run("parts"));
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  kill(child, SIGTERM);
  ASSERT_EQ(finish(child), 143) << err("parts");  // 128 + SIGTERM
  EXPECT_THAT(err("parts"), AllOf(HasSubstr("soil: SIGTERM: stopped at t = "), HasSubstr("after step "),
                                  HasSubstr("\nTo go on: "), HasSubstr(" --restart\n")));
  EXPECT_TRUE(has("parts/checkpoint.bin"));
  EXPECT_FALSE(has("parts/checkpoint.bin.partial"));
  EXPECT_FALSE(has("parts/vibrations.h5"));

  child = start("parts", {"--restart"});
  ASSERT_TRUE(wait_for_run("parts"));
  std::this_thread::sleep_for(std::chrono::milliseconds(100));  // some way into the run
  kill(child, SIGINT);
  ASSERT_EQ(finish(child), 130) << err("parts");  // 128 + SIGINT
  EXPECT_THAT(err("parts"), AllOf(HasSubstr("soil: SIGINT: stopped"), Not(HasSubstr("--restart --restart"))));

  ASSERT_EQ(finish(start("parts", {"--restart"})), 0) << err("parts");
  EXPECT_FALSE(has("parts/checkpoint.bin"));
  const Vibrations whole = read_vibrations(folder_ / "whole/vibrations.h5"),
                   parts = read_vibrations(folder_ / "parts/vibrations.h5");
  ASSERT_GT(whole.vz.cwiseAbs().maxCoeff(), 0);
  EXPECT_EQ(parts.time, whole.time);
  EXPECT_EQ(parts.vx, whole.vx);
  EXPECT_EQ(parts.vy, whole.vy);
  EXPECT_EQ(parts.vz, whole.vz);
  EXPECT_EQ(parts.footprint_displacement, whole.footprint_displacement);
}

TEST_F(StoppedRun, GoesOnAfterItWasKilled) {
  pid_t child = start("out", {"--checkpoint-every", "0.0001"});
  ASSERT_TRUE(wait_until([&] { return has("out/checkpoint.bin"); }));
  kill(child, SIGKILL);
  ASSERT_EQ(finish(child), 1000 + SIGKILL);
  ASSERT_TRUE(has("out/checkpoint.bin"));

  // Another site is refused before anything is computed.
  std::string other = long_site;
  folder_.write("site.toml", other.replace(other.find("cs = 200"), 8, "cs = 201"));
  EXPECT_EQ(finish(start("out", {"--restart"})), 1);
  EXPECT_THAT(err("out"), HasSubstr("checkpoint.bin: belongs to another run: site was "));
  folder_.write("site.toml", long_site);
  EXPECT_EQ(finish(start("out", {"--restart", "--damping", "none"})), 1);
  EXPECT_THAT(err("out"), HasSubstr("option damping was constant, is none"));

  // One that was damaged on the disk as well.
  std::string bytes = read_whole_file(folder_ / "out/checkpoint.bin");
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  const std::string whole = read_whole_file(folder_ / "out/checkpoint.bin");
  folder_.write("out/checkpoint.bin", bytes);
  EXPECT_EQ(finish(start("out", {"--restart"})), 1);
  EXPECT_THAT(err("out"), HasSubstr("checkpoint.bin: is damaged"));
  EXPECT_FALSE(has("out/vibrations.h5"));
  folder_.write("out/checkpoint.bin", whole);

  EXPECT_EQ(finish(start("out", {"--restart"})), 0) << err("out");
  EXPECT_TRUE(has("out/vibrations.h5"));
  EXPECT_FALSE(has("out/checkpoint.bin"));
}

TEST_F(StoppedRun, IsKeptWhenTheNextOneStartsAnew) {
  const pid_t child = start("out");
  ASSERT_TRUE(wait_for_run("out"));
  kill(child, SIGINT);
  ASSERT_EQ(finish(child), 130);
  ASSERT_EQ(finish(start("out")), 0);
  EXPECT_THAT(err("out"), HasSubstr("without --restart; the checkpoint of the earlier one is now "
                                    "checkpoint.previous.bin"));
  EXPECT_TRUE(has("out/checkpoint.previous.bin"));
  EXPECT_FALSE(has("out/checkpoint.bin"));
}

TEST_F(StoppedRun, OfImpulseResponsesGoesOnWithTheSameCommand) {
  const auto start_mobility = [&](const std::string& name) {
    return start_program(name, {SOIL_PROGRAM, "mobility", (folder_ / "site.toml").string(), "--loads",
                                (folder_ / "loads.h5").string(), "--method", "elements", "--window", "3",
                                "--threads", "1", "--output", (folder_ / (name + ".h5")).string()});
  };
  ASSERT_EQ(finish(start_mobility("whole")), 0) << err("whole");
  const pid_t child = start_mobility("parts");
  ASSERT_TRUE(wait_for_run("parts"));
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  kill(child, SIGTERM);
  ASSERT_EQ(finish(child), 143) << err("parts");
  EXPECT_THAT(err("parts"), HasSubstr("To go on: "));
  EXPECT_TRUE(has("parts.checkpoint.bin"));
  EXPECT_FALSE(has("parts.h5"));
  ASSERT_EQ(finish(start_mobility("parts")), 0) << err("parts");
  EXPECT_EQ(err("parts"), "");  // it did not start anew
  EXPECT_FALSE(has("parts.checkpoint.bin"));
  EXPECT_EQ(read_mobility(folder_ / "parts.h5").mobility.hz, read_mobility(folder_ / "whole.h5").mobility.hz);
}

TEST_F(StoppedRun, NeedsACheckpointToGoOn) {
  EXPECT_EQ(finish(start("out", {"--restart"})), 1);
  EXPECT_THAT(err("out"), HasSubstr("out/checkpoint.bin: cannot be read"));
}

}  // namespace
}  // namespace easydyn::soil

// What memory a process may take, and what a superposition takes of it.

#include <gmock/gmock.h>
#include <malloc.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <limits>

#include "easydyn/error.hpp"
#include "soil/cgroup_memory.hpp"
#include "soil/frequency_filter.hpp"
#include "soil/layered/superposition.hpp"
#include "soil/layered/superposition_memory.hpp"
#include "soil/physical_memory.hpp"
#include "tests/temporary_folder.hpp"

namespace easydyn::soil {
namespace {

using easydyn::testing::message_of;
using easydyn::testing::TemporaryFolder;
using Eigen::Index;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double no_limit = std::numeric_limits<double>::infinity();

class CgroupMemory : public ::testing::Test {
 protected:
  void set(const std::string& group, const std::string& file, const std::string& text) {
    std::filesystem::create_directories(folder_ / group);
    folder_.write(group + "/" + file, text);
  }
  double find(const std::string& groups) { return find_cgroup_memory(groups, folder_.path()); }
  TemporaryFolder folder_;
};

TEST_F(CgroupMemory, IsTheSmallestLimitOfTheGroupAndThoseAboveIt) {
  set("slurm/job_7/step_0", "memory.max", "max\n");
  set("slurm/job_7", "memory.max", "4000000000\n");
  set("slurm", "memory.max", "9000000000\n");
  set("other", "memory.max", "1000\n");  // another's
  EXPECT_EQ(find("0::/slurm/job_7/step_0\n"), 4e9);
  EXPECT_EQ(find("0::/slurm\n"), 9e9);
  EXPECT_EQ(find("0::/\n"), no_limit);
}

TEST_F(CgroupMemory, KnowsBothVersions) {
  set("memory/docker/12ab", "memory.limit_in_bytes", "2000000000\n");
  set("memory", "memory.limit_in_bytes", "9223372036854771712\n");  // version 1: none
  const std::string text = "12:pids:/docker/12ab\n5:hugetlb,memory:/docker/12ab\n1:name=systemd:/x\n0::/y\n";
  EXPECT_EQ(find(text), 2e9);
  set(".", "memory.max", "1500000000\n");
  EXPECT_EQ(find(text), 1.5e9);
}

TEST_F(CgroupMemory, IsThatOfTheMountWhereAContainerHidesTheNameOfItsGroup) {
  set(".", "memory.max", "3000000000\n");
  EXPECT_EQ(find("0::/kubepods/pod1/12ab\n"), 3e9);
}

TEST_F(CgroupMemory, IsNotLimitedWithoutFilesOrByMax) {
  EXPECT_EQ(find(""), no_limit);
  EXPECT_EQ(find("0::/user\n3:memory:/user\n"), no_limit);
  set("user", "memory.max", "max\n");
  EXPECT_EQ(find("0::/user\n"), no_limit);
}

TEST(PhysicalMemory, IsAtMostThatOfTheMachine) {
  EXPECT_GT(physical_memory(), 1e6);
  EXPECT_LE(physical_memory(), double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGE_SIZE)));
  EXPECT_NO_THROW(require_memory(1e6, "fields", "take fewer"));
  EXPECT_EQ(message_of<ModelError>([] { require_memory(3e9, "fields", "take fewer", 2e9); }),
            "fields need 3 GB of memory, must be at most 2 GB: take fewer");
}

// Responses of noise to a row of footprints 0.6 m apart, receivers beside each of them; 1 s of loads at 1 kHz.
struct Problem {
  Mobility mobility;
  Site site;
  SurfaceLoads loads;
};
Problem make_problem(int footprints, int receivers, double duration) {
  Problem p;
  p.site.highest_frequency = p.mobility.highest_frequency = 80;
  p.site.duration = duration;
  p.site.taper_length = 0;
  p.mobility.length = 0.3;
  p.mobility.width = 2.5;
  p.mobility.step = 1 / (4 * 80.0);
  for (int j = 0; j < footprints; ++j) {
    p.loads.footprints.push_back({0.6 * j, 0, 0.3, 2.5});
    p.mobility.shifts.push_back({0.6 * j, 0});
  }
  for (int r = 0; r < receivers; ++r) p.site.receivers.push_back({"receiver", {0.6 * r, 8, 0}});
  for (int d = 0; d < std::max(footprints, receivers); ++d) p.mobility.places.push_back({0.6 * d, 8, 0});
  const auto places = static_cast<Index>(p.mobility.places.size());
  p.mobility.hx = p.mobility.hy = p.mobility.hz = Eigen::MatrixXd::Random(400, places);
  p.mobility.mean = Eigen::MatrixXd::Random(400, footprints);
  p.loads.time = Eigen::VectorXd::LinSpaced(1001, 0, 1);
  p.loads.force = Eigen::MatrixXd::Random(1001, footprints);
  return p;
}

// Peak of the memory of a process that superposes, over what it had before [byte].
double measure_memory(const Problem& p) {
  int channel[2];
  EXPECT_EQ(pipe(channel), 0);
  const pid_t child = fork();
  if (child == 0) {
    const auto peak = [] {
      rusage usage{};
      getrusage(RUSAGE_SELF, &usage);
      return 1024.0 * static_cast<double>(usage.ru_maxrss);
    };
    mallopt(M_MMAP_THRESHOLD, 1 << 16);  // what is freed goes back at once, as matrices above 32 MB do anyway
    const double before = peak();
    superpose(p.mobility, p.site, p.loads, {.threads = 1});
    const double taken = peak() - before;
    const ssize_t written = write(channel[1], &taken, sizeof taken);
    _exit(written == sizeof taken ? 0 : 1);
  }
  double taken = 0;
  EXPECT_EQ(read(channel[0], &taken, sizeof taken), ssize_t{sizeof taken});
  int status = 1;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  close(channel[0]);
  close(channel[1]);
  return taken;
}

// What the refusal says beside responses and loads, which are there already [byte]; three digits.
double find_need(const Problem& p) {
  const std::string refusal = message_of<ModelError>(
      [&] { superpose(p.mobility, p.site, p.loads, {.threads = 1, .memory_limit = 1}); });
  const std::size_t number = refusal.find(" need ");
  EXPECT_NE(number, std::string::npos) << refusal;
  const double kept =
      8.0 * static_cast<double>(3 * p.mobility.hz.size() + p.mobility.mean.size() + p.loads.force.size());
  return 1e9 * std::stod(refusal.substr(number + 6)) - kept;
}

TEST(SuperpositionMemory, IsWhatTheProcessTakes) {
  // Footprints alone, receivers alone, footprints in no even row, and all loaded along x: each its own largest step. Of
  // memory that the system counts in pages some megabytes are the stacks and tables of the process.
  std::vector<Problem> problems = {make_problem(400, 3, 10), make_problem(4, 250, 10),
                                   make_problem(300, 3, 10), make_problem(60, 120, 10)};
  problems[2].loads.footprints.back().x = 0;
  for (Footprint& f : problems[3].loads.footprints) f.direction = LoadDirection::x;
  const Mobility& m = problems[3].mobility;
  problems[3].mobility.horizontal[LoadDirection::x] = {m.hx, m.hy, m.hz, m.mean, m.mean, m.mean};
  for (const Problem& p : problems) {
    const double need = find_need(p), taken = measure_memory(p);
    std::printf("%zu footprints, %zu receivers: estimated %.1f MB, taken %.1f MB\n",
                p.loads.footprints.size(), p.site.receivers.size(), 1e-6 * need, 1e-6 * taken);
    EXPECT_NEAR(need, taken, 0.1 * taken);
  }
}

TEST(SuperpositionMemory, IsAskedForBeforeAnythingIsAllocated) {
  // Four months at 320 Hz: 3.2e9 samples; spectra of two footprints alone take 50 GB, and the records 77 GB each.
  Problem p = make_problem(2, 3, 1e7);
  EXPECT_THAT(message_of<ModelError>([&] { superpose(p.mobility, p.site, p.loads); }),
              AllOf(HasSubstr("2 footprints and 3 receivers over 1e+07 s need "), HasSubstr(" GB of memory"),
                    HasSubstr("take fewer receivers at a time")));
}

}  // namespace
}  // namespace easydyn::soil

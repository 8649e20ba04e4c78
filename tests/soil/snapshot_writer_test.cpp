#include "soil/snapshot_writer.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <set>

#include "easydyn/error.hpp"
#include "soil/disk_space.hpp"
#include "tests/soil/small_ground.hpp"
#include "tests/vtu_reader.hpp"

namespace easydyn::soil {
namespace {

using easydyn::testing::message_of;
using easydyn::testing::parse_xml;
using easydyn::testing::read_vtu;
using easydyn::testing::read_whole_file;
using easydyn::testing::TemporaryFolder;
using easydyn::testing::VtuContent;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// Surface and a section across every axis, one picture every 6 ms of an output step of 2 ms.
Site pictured_site() {
  Site site = test::small_site();
  site.snapshots = {{"surface", 2, 0, 0.006},
                    {"along", 1, 2.1, 0.006},
                    {"across", 0, 1.3, 0.006, 0.054, 0.09},
                    {"below", 2, -0.8, 0.006}};
  return site;
}

/// Three numbers at the point of the picture nearest to (x, y, z).
std::array<double, 3> value_at(const VtuContent& picture, const std::string& name,
                               const std::array<double, 3>& position) {
  const std::vector<float> points = picture.values<float>("Points"), values = picture.values<float>(name);
  std::size_t nearest = 0;
  double least = 1e300;
  for (std::size_t p = 0; p < points.size(); p += 3) {
    double distance = 0;
    for (std::size_t c = 0; c < 3; ++c) distance += std::pow(points[p + c] - position[c], 2);
    if (distance < least) {
      least = distance;
      nearest = p;
    }
  }
  EXPECT_LT(least, 1e-10);
  return {values[nearest], values[nearest + 1], values[nearest + 2]};
}

TEST(Snapshots, ShowWhatReceiversAtTheSameNodesSee) {
  const TemporaryFolder folder;
  Site site = pictured_site();
  RunControl control;
  control.snapshots = folder.path();
  WaveSolver first(site, test::small_loads(), test::small_options());
  first.run(control);
  // The points of each plane between the receivers that are there become receivers: the lattice stays as it is.
  std::vector<std::string> plane_of;
  for (const Snapshot& snapshot : site.snapshots) {
    const VtuContent picture = read_vtu(folder / (snapshot.name + "/00027.vtu"));
    const std::vector<float> points = picture.values<float>("Points");
    ASSERT_EQ(points.size(), 3 * picture.points);
    for (std::size_t p = 0; p < points.size(); p += 3) {
      if (points[p] < -0.7 || points[p] > 1.3 || points[p + 1] > 3.2 || points[p + 2] < -0.801) continue;
      const double z =
          std::max(-0.8, static_cast<double>(points[p + 2]));  // -0.8 in single precision is below
      const std::array<double, 3> position = {points[p], points[p + 1], z};
      site.receivers.push_back({snapshot.name, position});
      plane_of.push_back(snapshot.name);
    }
  }
  ASSERT_GE(std::set<std::string>(plane_of.begin(), plane_of.end()).size(), 4u);
  WaveSolver second(site, test::small_loads(), test::small_options());
  const Lattice& lattice = first.lattice();
  ASSERT_EQ(second.lattice().x, lattice.x);
  ASSERT_EQ(second.lattice().y, lattice.y);
  ASSERT_EQ(second.lattice().z, lattice.z);
  const GroundMotion motion = second.run();

  const double peak = motion.vz.cwiseAbs().maxCoeff();
  ASSERT_GT(peak, 0);
  for (const Eigen::Index row : {27, 36, 45}) {
    std::map<std::string, VtuContent> pictures;
    for (const Snapshot& snapshot : site.snapshots)
      pictures[snapshot.name] = read_vtu(folder / fmt::format("{}/{:05d}.vtu", snapshot.name, row));
    for (std::size_t r = 0; r < plane_of.size(); ++r) {
      const VtuContent& picture = pictures.at(plane_of[r]);
      EXPECT_NEAR(picture.time, motion.time(row), 1e-12);
      const auto column = static_cast<Eigen::Index>(r + 2);  // after the two receivers of the site
      const auto velocity = value_at(picture, "velocity", site.receivers[r + 2].position);
      // Single precision of the picture and of the position; the field itself is the same.
      EXPECT_NEAR(velocity[0], motion.vx(row, column), 2e-6 * peak) << plane_of[r] << " " << r;
      EXPECT_NEAR(velocity[1], motion.vy(row, column), 2e-6 * peak) << plane_of[r] << " " << r;
      EXPECT_NEAR(velocity[2], motion.vz(row, column), 2e-6 * peak) << plane_of[r] << " " << r;
    }
  }
}

TEST(Snapshots, HoldADisplacementWhoseRateIsTheVelocity) {
  const TemporaryFolder folder;
  Site site = test::small_site();
  site.snapshots = {{"surface", 2, 0, 0.002}};
  RunControl control;
  control.snapshots = folder.path();
  SolverOptions options = test::small_options();
  options.double_precision = true;
  const GroundMotion motion = WaveSolver(site, test::small_loads(), options).run(control);
  // Simpson's rule over the velocity from output 20 to 60 against the difference of the displacements.
  std::vector<double> sum;
  std::vector<float> first, last;
  for (int row = 20; row <= 60; ++row) {
    const VtuContent picture = read_vtu(folder / fmt::format("surface/{:05d}.vtu", row));
    const std::vector<float> velocity = picture.values<float>("velocity");
    if (row == 20) first = picture.values<float>("displacement");
    if (row == 60) last = picture.values<float>("displacement");
    sum.resize(velocity.size());
    const double weight = row == 20 || row == 60 ? 1 : row % 2 ? 4 : 2;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weight * 2e-3 / 3 * velocity[i];
  }
  double error = 0, largest = 0;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    error = std::max(error, std::abs(last[i] - first[i] - sum[i]));
    largest = std::max(largest, static_cast<double>(std::abs(last[i] - first[i])));
  }
  EXPECT_GT(largest, 1e-7);
  EXPECT_LT(error, 0.01 * largest);  // 25 outputs per shortest period: Simpson errs by 1e-3 of it at most
}

TEST(Snapshots, AreIndexedAndHaveTheSizeThatWasAnnounced) {
  const TemporaryFolder folder;
  RunControl control;
  control.snapshots = folder.path();
  WaveSolver solver(pictured_site(), test::small_loads(), test::small_options());
  const RunSummary summary = solver.compute_summary();
  EXPECT_THAT(summary.snapshot_text, HasSubstr("\"across\": "));
  EXPECT_THAT(summary.snapshot_text, HasSubstr("7 pictures, one every 6 ms"));  // 54, 60, ... 90 ms
  solver.run(control);
  double bytes = 0;
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
    if (!entry.is_regular_file()) continue;
    EXPECT_THAT(entry.path().extension().string(), ::testing::AnyOf(".vtu", ".pvd"));
    bytes += static_cast<double>(entry.file_size());
    if (entry.path().extension() == ".vtu") ++files;
  }
  EXPECT_EQ(files, 3 * 26 + 7);  // 0 to 150 ms
  EXPECT_NEAR(summary.snapshots, bytes, 0.02 * bytes);
  int listed = 0;
  for (const auto& element : parse_xml(read_whole_file(folder / "across.pvd"))) {
    if (element.name != "DataSet") continue;
    const VtuContent picture = read_vtu(folder / element.attributes.at("file"));
    EXPECT_EQ(picture.time, std::stod(element.attributes.at("timestep")));
    EXPECT_NEAR(picture.time, 0.054 + 0.006 * listed++, 1e-12);
  }
  EXPECT_EQ(listed, 7);
}

TEST(Snapshots, AreTheSameAfterARestart) {
  const TemporaryFolder whole, parts, state;
  RunControl control;
  control.snapshots = whole.path();
  WaveSolver solver(pictured_site(), test::small_loads(), test::small_options());
  solver.run(control);
  control.snapshots = parts.path();
  control.checkpoint = state / "checkpoint.bin";
  control.is_stop_wanted = [left = solver.steps() / 2]() mutable { return --left <= 0; };
  EXPECT_THROW(solver.run(control), RunStopped);
  control.is_stop_wanted = {};
  control.restart = true;
  solver.run(control);
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(whole.path())) {
    if (!entry.is_regular_file()) continue;
    const std::filesystem::path name = std::filesystem::relative(entry.path(), whole.path());
    EXPECT_EQ(read_whole_file(entry.path()), read_whole_file(parts.path() / name)) << name;
    ++files;
  }
  EXPECT_GT(files, 80);
}

TEST(Snapshots, NameWhatIsOutOfRange) {
  const auto fault = [](const Snapshot& snapshot) {
    Site site = test::small_site();
    site.snapshots = {snapshot};
    return message_of<ModelError>([&] { WaveSolver(site, test::small_loads(), test::small_options()); });
  };
  EXPECT_THAT(fault({"far", 0, 900, 0.01}),
              AllOf(HasSubstr("snapshot \"far\": x = 900 m, must be in "), HasSubstr("the undamped ground")));
  EXPECT_THAT(fault({"other side", 1, -1, 0.01}), HasSubstr("y = -1 m, must be in 0.."));  // half model
  EXPECT_THAT(fault({"fast", 2, 0, 0.001}), HasSubstr("step = 0.001 s, must be >= 0.002 s, the output step"));
  EXPECT_THAT(fault({"late", 2, 0, 0.01, 7}), HasSubstr("no output time between begin = 7 s"));
}

TEST(DiskSpace, IsRefusedWhereThereIsTooLittle) {
  const TemporaryFolder folder;
  EXPECT_NO_THROW(require_disk_space(folder.path(), 1, "snapshots"));
  EXPECT_NO_THROW(require_disk_space(folder / "not/yet/there", 1, "snapshots"));
  EXPECT_THAT(
      message_of<InputError>([&] { require_disk_space(folder.path(), 1e21, "snapshots"); }),
      AllOf(HasSubstr("snapshots need 1000000000000.0 GB, must be at most "), HasSubstr("free on the disk")));
}

TEST(DiskSpace, IsToldInUnitsOfPeople) {
  EXPECT_EQ(format_bytes(2048), "2 kB");
  EXPECT_EQ(format_bytes(12.3e6), "12 MB");
  EXPECT_EQ(format_bytes(3.44e9), "3.4 GB");
}

}  // namespace
}  // namespace easydyn::soil

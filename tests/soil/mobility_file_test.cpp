// Impulse responses in a file.

#include "soil/mobility_file.hpp"

#include <gmock/gmock.h>

#include "easydyn/error.hpp"
#include "tests/temporary_folder.hpp"

namespace easydyn::soil {
namespace {

using easydyn::testing::message_of;
using easydyn::testing::TemporaryFolder;

StoredMobility make_stored() {
  StoredMobility stored;
  stored.method = "layered half-space";
  stored.site.text =
      "name = \"a\"\n[[layer]]\nname = \"b\"\ndensity = 1800\ncs = 150\nnu = 0.3\ndamping = 0.03\n"
      "[[receiver]]\nname = \"c\"\nposition = [0, 8]\n";
  Mobility& m = stored.mobility;
  m.length = 0.3;
  m.width = 2.5;
  m.highest_frequency = 50;
  m.step = 0.005;
  m.before = 1;
  m.places = {{0, 8, 0}, {0.6, 8, 0}};
  m.shifts = {{0, 0}};
  const auto values = [](int columns, double start) -> Eigen::MatrixXd {
    return Eigen::VectorXd::LinSpaced(4, start, start + 1) * Eigen::RowVectorXd::Ones(columns);
  };
  m.hx = values(2, 1);
  m.hy = values(2, 2);
  m.hz = values(2, 3);
  m.mean = values(1, 4);
  m.horizontal[LoadDirection::y] = {values(2, 5), values(2, 6), values(2, 7),
                                    values(1, 8), values(1, 9), values(1, 10)};
  return stored;
}

TEST(MobilityFile, ComesBackWithHorizontalLoads) {
  const TemporaryFolder folder;
  const StoredMobility stored = make_stored();
  write_mobility(folder / "mobility.h5", stored, {.program = "test"});
  const Mobility read = read_mobility(folder / "mobility.h5").mobility;
  EXPECT_EQ(read.before, 1);
  EXPECT_EQ(read.hz, stored.mobility.hz);
  EXPECT_EQ(read.mean, stored.mobility.mean);
  ASSERT_EQ(read.horizontal.size(), 1u);
  const HorizontalResponse &there = read.horizontal.at(LoadDirection::y),
                           &here = stored.mobility.horizontal.at(LoadDirection::y);
  EXPECT_EQ(there.hx, here.hx);
  EXPECT_EQ(there.hy, here.hy);
  EXPECT_EQ(there.hz, here.hz);
  EXPECT_EQ(there.mean_x, here.mean_x);
  EXPECT_EQ(there.mean_y, here.mean_y);
  EXPECT_EQ(there.mean, here.mean);
}

TEST(MobilityFile, NamesTheResponseOfTheWrongSize) {
  const TemporaryFolder folder;
  StoredMobility stored = make_stored();
  stored.mobility.horizontal.at(LoadDirection::y).mean_x.resize(4, 2);
  EXPECT_THAT(
      message_of<ModelError>([&] { write_mobility(folder / "mobility.h5", stored, {.program = "test"}); }),
      ::testing::HasSubstr("\"/load_y/neighbour/x\" has the shape (4 x 2), must be (4 x 1)"));
}

}  // namespace
}  // namespace easydyn::soil

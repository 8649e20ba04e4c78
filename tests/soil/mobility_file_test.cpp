// Impulse responses in a file.

#include "soil/mobility_file.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>

#include "easydyn/error.hpp"
#include "soil/mobility_identity.hpp"
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

TEST(MobilityFile, HoldsForTheWindowThatItWasComputedWith) {
  // --window 0.8 at 80 Hz: 256 steps of 1/320 s after the impulse. Rebuilt from the times 0.8 s may come an ulp low.
  const TemporaryFolder folder;
  StoredMobility stored = make_stored();
  Mobility& m = stored.mobility;
  m.highest_frequency = 80;
  m.step = 1.0 / 320;
  m.before = 64;
  for (Eigen::MatrixXd* h : {&m.hx, &m.hy, &m.hz}) *h = Eigen::MatrixXd::Ones(320, 2);
  m.mean = Eigen::MatrixXd::Ones(320, 1);
  m.horizontal.clear();
  write_mobility(folder / "mobility.h5", stored, {.program = "test"});  // of an earlier version: no /window
  StoredMobility read = read_mobility(folder / "mobility.h5");
  EXPECT_NEAR(read.window, 0.8, 1e-12);
  EXPECT_EQ(find_shortage(read, 0.8), "");
  read.window = std::nextafter(0.8, 0);
  EXPECT_EQ(find_shortage(read, 0.8), "");
  EXPECT_EQ(find_shortage(read, 0.804), "responses of 0.8 s there, 0.804 s here");
  // Samples of far footprints go on after the window of the others.
  stored.window = 0.5;
  write_mobility(folder / "mobility.h5", stored, {.program = "test"});
  EXPECT_EQ(read_mobility(folder / "mobility.h5").window, 0.5);
  EXPECT_NE(find_shortage(read_mobility(folder / "mobility.h5"), 0.8), "");
}

TEST(MobilityFile, KnowsWhichFootprintsAreSemiAnalytical) {
  const TemporaryFolder folder;
  StoredMobility stored = make_stored();
  write_mobility(folder / "mobility.h5", stored, {.program = "test"});  // of an earlier version: does not say
  EXPECT_TRUE(read_mobility(folder / "mobility.h5").shift_methods.empty());
  stored.method = element_method;
  stored.shift_methods = {layered_method};
  write_mobility(folder / "mobility.h5", stored, {.program = "test"});
  EXPECT_EQ(read_mobility(folder / "mobility.h5").shift_methods, stored.shift_methods);
  const auto expect_refusal = [&](const std::vector<std::string>& methods, const std::string& message) {
    stored.shift_methods = methods;
    EXPECT_THAT(
        message_of<ModelError>([&] { write_mobility(folder / "mobility.h5", stored, {.program = "test"}); }),
        ::testing::HasSubstr(message));
  };
  expect_refusal({layered_method, element_method}, "\"/neighbour/method\" has 2 values, must have 1");
  expect_refusal({"guess"}, "\"/neighbour/method\" holds \"guess\", must be \"layered half-space\" or");
}

TEST(MobilityFile, IsOfTheRevisionOfTheNumbers) {
  EXPECT_THAT(describe_responses(make_stored().site, GroundDamping::none, nullptr),
              ::testing::Contains(fmt::format("revision of the responses = {}", response_revision)));
}

TEST(ResponseRest, IsThatOfThePlaceItself) {
  // Twenty samples after t = 0, the last two of them the last tenth. The far receiver moves with a hundredth of the near
  // one's motion: 0.001 / 0.01 of its own, a thousandth of the largest. Along x nothing but rounding, by symmetry.
  Mobility m = make_stored().mobility;
  m.horizontal.clear();
  m.hx = m.hy = m.hz = Eigen::MatrixXd::Zero(21, 2);
  m.mean = Eigen::MatrixXd::Zero(21, 1);
  m.hz(3, 0) = 1;
  m.hz(3, 1) = 0.01;
  m.hz(20, 1) = 0.001;
  m.hx.setConstant(1e-18);
  m.mean(5, 0) = 1;
  const ResponseRest rest = find_rest(m);
  EXPECT_NEAR(rest.share, 0.1, 1e-12);
  EXPECT_EQ(rest.where, "a receiver at (0.6, 8, 0) m from the footprint");
  EXPECT_NEAR(rest.window, 20 * 0.005, 1e-12);
  m.mean(19, 0) = -0.2;
  EXPECT_EQ(find_rest(m).where, "a footprint at (0, 0) m from the loaded one");
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

#include "easydyn/results/channels.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "easydyn/error.hpp"
#include "tests/temporary_folder.hpp"

namespace easydyn::results {
namespace {

using easydyn::testing::message_of;
using easydyn::testing::read_whole_file;
using easydyn::testing::TemporaryFolder;
using ::testing::HasSubstr;

TEST(Channels, AreCommaSeparatedWithNamesAndUnits) {
  const TemporaryFolder folder;
  ChannelTable table;
  table.time = Eigen::Vector2d(0, 0.1);
  table.add("force, \"left\"", "N", Eigen::Vector2d(-1.5, 1e6));
  table.add("ratio", "1", Eigen::Vector2d(1.0 / 3, 2));
  write_channels(folder / "a.csv", table);
  EXPECT_EQ(read_whole_file(folder / "a.csv"),
            "time [s],\"force, \"\"left\"\" [N]\",ratio [1]\n"
            "0,-1.5,0.3333333333333333\n"
            "0.1,1000000,2\n");
  EXPECT_EQ(folder.count(), 1);
}

TEST(Channels, LoseNoDigit) {
  const TemporaryFolder folder;
  ChannelTable table;
  table.time = Eigen::VectorXd::Zero(1);
  table.add("v", "m", Eigen::VectorXd::Constant(1, std::nextafter(1e-9, 1)));
  write_channels(folder / "a.csv", table);
  const std::string text = read_whole_file(folder / "a.csv");
  EXPECT_EQ(std::stod(text.substr(text.rfind(',') + 1)), std::nextafter(1e-9, 1));
}

TEST(Channels, RefuseWhatDoesNotFit) {
  const TemporaryFolder folder;
  const auto message = [&](const ChannelTable& table) {
    return message_of<ModelError>([&] { write_channels(folder / "a.csv", table); });
  };
  const Eigen::VectorXd time = Eigen::Vector2d(0, 0.1);
  EXPECT_EQ(message({time, {{"v", "m", Eigen::VectorXd::Zero(3)}}}),
            "channel \"v\": 3 values, must be 2 (one per time)");
  EXPECT_EQ(message({time, {{"v", "m", Eigen::Vector2d(0, NAN)}}}),
            "channel \"v\": value at t = 0.1 s is nan, must be finite");
  EXPECT_EQ(message({time, {{"v", "m", time}, {"v", "m", time}}}), "channel \"v\" appears twice");
  EXPECT_EQ(folder.count(), 0);
}

TEST(Channels, NameTheFileThatCannotBeWritten) {
  const TemporaryFolder folder;
  EXPECT_THAT(message_of<InputError>([&] { write_channels(folder / "none/a.csv", {}); }),
              HasSubstr("none/a.csv"));
}

}  // namespace
}  // namespace easydyn::results

#include "soil/vibrations.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "easydyn/error.hpp"
#include "tests/temporary_folder.hpp"

namespace easydyn::soil {
namespace {

using easydyn::testing::message_of;
using easydyn::testing::TemporaryFolder;
using ::testing::HasSubstr;

// Two receivers that vibrate at 16 Hz, three footprints that sink and rise.
Vibrations make_vibrations() {
  Vibrations v;
  v.time = Eigen::VectorXd::LinSpaced(1000, 0, 1.998);
  const Eigen::ArrayXd wave = (2 * std::numbers::pi * 16 * v.time.array()).sin();
  v.receivers = {{"8 m", {0, 8, 0}}, {"16 m", {1, 16, -2}}};
  v.vx = Eigen::MatrixXd::Zero(1000, 2);
  v.vy = (1e-4 * wave).matrix() * Eigen::RowVector2d(1, 2);
  v.vz = (1e-3 * wave).matrix() * Eigen::RowVector2d(1, 0.5);
  v.footprint_x = Eigen::Vector3d(-0.6, 0, 0.6);
  v.footprint_displacement =
      (1e-4 * (-(v.time.array() - 1).square() * 20).exp()).matrix() * Eigen::RowVector3d(1, 2, 3);
  v.footprint_taper = Eigen::Vector3d(0.5, 1, 1);
  v.highest_frequency = 50;
  v.parameters = {{"layer \"clay, grey\"", "cs", 150, "m/s", "borehole"}};
  v.site_text = "[[layer]]\nname = \"clay\"\n";
  update_indicators(v);
  return v;
}

TEST(Vibrations, ComeBackAsWritten) {
  const TemporaryFolder folder;
  const Vibrations v = make_vibrations();
  write_vibrations(folder / "vibrations.h5", v, {.program = "test"});
  const Vibrations read = read_vibrations(folder / "vibrations.h5");
  EXPECT_EQ(read.time, v.time);
  EXPECT_EQ(read.vy, v.vy);
  EXPECT_EQ(read.vz, v.vz);
  ASSERT_EQ(read.receivers.size(), 2u);
  EXPECT_EQ(read.receivers[1].name, "16 m");
  EXPECT_EQ(read.receivers[1].position, v.receivers[1].position);
  EXPECT_EQ(read.footprint_x, v.footprint_x);
  EXPECT_EQ(read.footprint_displacement, v.footprint_displacement);
  EXPECT_EQ(read.footprint_taper, v.footprint_taper);
  EXPECT_EQ(read.highest_frequency, 50);
  EXPECT_EQ(read.site_text, v.site_text);
  ASSERT_EQ(read.parameters.size(), 1u);
  EXPECT_EQ(read.parameters[0].group, "layer \"clay, grey\"");
  EXPECT_EQ(read.parameters[0].value, 150);
  ASSERT_EQ(read.indicators.size(), 2u);
  EXPECT_EQ(read.indicators[1].ppv, v.indicators[1].ppv);
  EXPECT_EQ(read.indicators[1].kb_f_max, v.indicators[1].kb_f_max);
  EXPECT_EQ(read.indicators[1].vdb, v.indicators[1].vdb);
  EXPECT_NEAR(read.indicators[0].third_octave_rms(12), 1e-3 / std::sqrt(2), 1e-9);
  EXPECT_TRUE(std::isnan(read.indicators[0].third_octave_rms(20)));
}

TEST(Vibrations, HoldAReceiverAtRest) {
  const TemporaryFolder folder;
  Vibrations v = make_vibrations();
  v.vx.setZero();
  v.vy.setZero();
  v.vz.setZero();
  update_indicators(v);
  write_vibrations(folder / "vibrations.h5", v, {});
  EXPECT_TRUE(std::isnan(read_vibrations(folder / "vibrations.h5").indicators[0].vdb));
}

TEST(Vibrations, AreRefusedWhenSizesDisagreeOrValuesAreNotFinite) {
  const TemporaryFolder folder;
  Vibrations v = make_vibrations();
  v.vy.conservativeResize(999, 2);
  EXPECT_EQ(message_of<ModelError>([&] { write_vibrations(folder / "a.h5", v, {}); }),
            "vibrations: velocity y is 999 x 2, must be 1000 x 2");
  v = make_vibrations();
  v.vz(3, 1) = NAN;
  EXPECT_THAT(message_of<ModelError>([&] { write_vibrations(folder / "a.h5", v, {}); }),
              HasSubstr("\"/velocity/z\": value (3, 1) is nan"));
  EXPECT_EQ(folder.count(), 0);
}

}  // namespace
}  // namespace easydyn::soil

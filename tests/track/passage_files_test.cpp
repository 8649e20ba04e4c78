#include "track/passage_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "easydyn/error.hpp"
#include "easydyn/results/result_file.hpp"
#include "easydyn/visu/table_json.hpp"
#include "tests/temporary_folder.hpp"

using namespace easydyn;
using namespace easydyn::track;
using easydyn::testing::message_of;
using easydyn::testing::TemporaryFolder;
using ::testing::HasSubstr;

namespace {

const results::Provenance provenance{.program = "test", .command = "test", .convention = "z up"};

/// Two times of one wheel and one body over one sleeper.
Passage small_passage() {
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(1), two = Eigen::Vector2d(0, 1);
  const Eigen::MatrixXd column = Eigen::MatrixXd::Ones(2, 1);
  Passage p;
  p.time = two;
  p.contact_names = {"wheel"};
  p.contact_force = p.contact_position = column;
  p.largest_contact_force = p.smallest_contact_force = one;
  p.contact_losses = Eigen::VectorXi::Ones(1);
  p.contact_loss_time = p.longest_contact_loss = one;
  p.foundation = "rigid";
  p.sleeper_x = one;
  p.rail_deflection = p.sleeper_displacement = p.ballast_reaction = column;
  p.coordinate_names = p.body_names = {"body"};
  p.coordinates = p.body_acceleration = column;
  p.kinetic_energy = p.potential_energy = p.dissipated_energy = p.supplied_energy = two;
  return p;
}

}  // namespace

TEST(PassageFile, HoldsWhatTheReportIsGiven) {
  const TemporaryFolder folder;
  const visu::Table masses{{"part", "mass [t]"}, {{"bodies", "26"}}, "Masses"};
  const ProfileSamples profile{Eigen::Vector2d(0, 1), Eigen::Vector2d(0, 1e-3), 0.46};
  write_passage(folder / "results.h5", small_passage(),
                {.description = "one wheel",
                 .drawing = "<svg/>",
                 .tables = {masses},
                 .static_loads = Eigen::VectorXd::Constant(1, 5e4),
                 .profile = profile},
                provenance);
  const results::ResultReader file(folder / "results.h5");
  EXPECT_EQ(file.read_text("/description"), "one wheel");
  EXPECT_EQ(file.read_text("/vehicle/drawing"), "<svg/>");
  const auto tables = visu::tables_from_json(file.read_text("/vehicle/tables"), "tables");
  ASSERT_EQ(tables.size(), 1u);
  EXPECT_EQ(tables[0].rows, masses.rows);
  EXPECT_EQ(file.read_vector("/contact/static")(0), 5e4);
  EXPECT_EQ(file.read_vector("/profile/x"), profile.x);
  EXPECT_EQ(file.read_vector("/profile/height"), profile.height);
  EXPECT_THAT(file.read_meaning("/profile/height").description, HasSubstr("radius 0.46 m"));
}

TEST(PassageFile, LeavesOutWhatTheReportIsNotGiven) {
  const TemporaryFolder folder;
  write_passage(folder / "results.h5", small_passage(), {.description = "one wheel"}, provenance);
  const results::ResultReader file(folder / "results.h5");
  for (const char* name : {"/scene", "/vehicle/drawing", "/vehicle/tables", "/contact/static", "/profile/x"})
    EXPECT_FALSE(file.has(name)) << name;
}

TEST(PassageFile, RefusesStaticLoadsThatAreNotOnePerContact) {
  const TemporaryFolder folder;
  EXPECT_THAT(message_of<ModelError>([&] {
                write_passage(folder / "results.h5", small_passage(),
                              {.description = "", .static_loads = Eigen::Vector2d(1, 1)}, provenance);
              }),
              HasSubstr("2 static loads for 1 contacts"));
}

TEST(ProfileSamples, AreThePathOfTheWheelCentre) {
  // Half way up the ramp of length a = sqrt(2 R h - h^2): r = h - R + sqrt(R^2 - (a / 2)^2), by hand.
  const double R = 0.4, h = 1e-3, a = std::sqrt(2 * R * h - h * h);
  const ProfileSamples samples = sample_profile(StepProfile(0, h), R, -a, a, a / 2);
  ASSERT_EQ(samples.x.size(), 5);
  EXPECT_EQ(samples.wheel_radius, R);
  EXPECT_NEAR(samples.height[0], 0, 1e-15);
  EXPECT_NEAR(samples.height[1], h - R + std::sqrt(R * R - a * a / 4), 1e-15);  // rounding of R
  EXPECT_NEAR(samples.height[4], h, 1e-15);
}

TEST(ProfileSamples, RefuseARangeOrASpacingThatIsNone) {
  const StepProfile step(0, 1e-3);
  EXPECT_THAT(message_of<ModelError>([&] { sample_profile(step, 0.4, 1, 1); }), HasSubstr("last x"));
  EXPECT_THAT(message_of<ModelError>([&] { sample_profile(step, 0.4, 0, 1, 0); }), HasSubstr("spacing"));
  EXPECT_THAT(message_of<ModelError>([&] { sample_profile(step, 1e-4, 0, 1); }), HasSubstr("radius"));
}

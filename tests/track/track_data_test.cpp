#include "track/track_data.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "easydyn/error.hpp"

namespace {

using namespace easydyn::track;
using easydyn::ModelError;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// The CLM of the tram track with one constant changed.
template <class Change>
auto validating_tram_with(Change change) {
  return [change] {
    TrackData data = t2000_like_track();
    change(data);
    validate(data);
  };
}

TEST(BundledTracks, AreValidAndStateASourceForEveryValue) {
  for (const TrackData& data : {t2000_like_track(), thalys_like_track(), zhai_2004_track(),
                                railfe_default_track(), lincent_like_track()}) {
    EXPECT_NO_THROW(validate(data));
    for (const easydyn::Parameter& p : parameters(data)) {
      EXPECT_FALSE(p.unit.empty()) << p.name;
      EXPECT_THAT(p.source, testing::Not(testing::AnyOf("", "default", "set by the user"))) << p.name;
    }
  }
}

void expect_foundation(const TrackData& data, const Clm& expected) {
  ASSERT_EQ(kind_of(data.foundation), "CLM");
  const Clm clm = as_clm(data.foundation);
  EXPECT_DOUBLE_EQ(clm.m_f, expected.m_f);
  EXPECT_DOUBLE_EQ(clm.k_f, expected.k_f);
  EXPECT_DOUBLE_EQ(clm.d_f, expected.d_f);
  EXPECT_DOUBLE_EQ(clm.k_c, expected.k_c);
  EXPECT_DOUBLE_EQ(clm.d_c, expected.d_c);
}

/// The choices that both bundled tracks leave at their defaults; the ends are tested in absorbing_ends_test.
void expect_default_discretisation(const TrackData& data) {
  EXPECT_EQ(data.elements_per_bay, 4);
  EXPECT_EQ(data.ends.bays, 20);
  EXPECT_EQ(data.ends.alpha, 4000);
  EXPECT_EQ(data.ends.beta, 2e-4);
}

// Whole track, both rails together; equal but for the rounding of the unit factors.
TEST(BundledTracks, HoldTheTramTrackOfBrussels) {
  const TrackData track = t2000_like_track();
  EXPECT_EQ(track.name, "t2000-like");
  EXPECT_EQ(track.rail.name, "50E2");
  EXPECT_EQ(track.rails, 2);
  // Brussels tram class (M-l), per rail: pad 90 MN/m, 30 kNs/m; sleeper 90 kg; ballast 25 MN/m, 40 kNs/m
  EXPECT_DOUBLE_EQ(track.sleeper_spacing, 0.72);
  EXPECT_DOUBLE_EQ(track.pad_stiffness, 180e6);
  EXPECT_DOUBLE_EQ(track.pad_damping, 60e3);
  EXPECT_DOUBLE_EQ(track.sleeper_mass, 180);
  EXPECT_DOUBLE_EQ(track.ballast_stiffness, 50e6);
  EXPECT_DOUBLE_EQ(track.ballast_damping, 80e3);
  // fit of the infinite chain on layered ground of the Brussels tram class, 2-50 Hz (C)
  expect_foundation(track, {605, 52.1e6, 428e3, 24.3e6, -93e3});
  // assumed: the main line's sleeper
  EXPECT_DOUBLE_EQ(track.footprint_length, 0.285);
  EXPECT_DOUBLE_EQ(track.footprint_width, 2.5);
  expect_default_discretisation(track);
}

TEST(BundledTracks, HoldTheHighSpeedTrackOfAth) {
  const TrackData track = thalys_like_track();
  EXPECT_EQ(track.name, "thalys-like");
  EXPECT_EQ(track.rail.name, "60E1");
  EXPECT_EQ(track.rails, 2);
  // Brussels-Paris line at Ath (M-h): monoblock sleepers 300 kg, 2.5 x 0.285 m, 0.6 m; pads 100 MN/m per rail
  EXPECT_DOUBLE_EQ(track.sleeper_spacing, 0.6);
  EXPECT_DOUBLE_EQ(track.sleeper_mass, 300);
  EXPECT_DOUBLE_EQ(track.footprint_length, 0.285);
  EXPECT_DOUBLE_EQ(track.footprint_width, 2.5);
  EXPECT_DOUBLE_EQ(track.pad_stiffness, 200e6);
  EXPECT_DOUBLE_EQ(track.pad_damping, 30e3);  // assumed: 15 kNs/m per rail
  // railFE's default (F): 40 MN/m, 47 kNs/m per rail
  EXPECT_DOUBLE_EQ(track.ballast_stiffness, 80e6);
  EXPECT_DOUBLE_EQ(track.ballast_damping, 94e3);
  // fit of the infinite chain on the layered ground of Ath, 2-50 Hz (C)
  expect_foundation(track, {346, 27.2e6, 281e3, 12.9e6, -53e3});
  expect_default_discretisation(track);
}

// Table of track sets: per rail (Zhai, railFE) or whole (Lincent).
TEST(BundledTracks, HoldTheSetsOfTheTable) {
  const TrackData zhai = zhai_2004_track();
  EXPECT_DOUBLE_EQ(zhai.pad_stiffness, 130e6);
  EXPECT_DOUBLE_EQ(zhai.pad_damping, 150e3);
  EXPECT_DOUBLE_EQ(zhai.sleeper_mass, 251);
  EXPECT_DOUBLE_EQ(zhai.ballast_stiffness, 275.5e6);
  EXPECT_DOUBLE_EQ(zhai.ballast_damping, 117.6e3);
  ASSERT_TRUE(zhai.ballast_mass);
  EXPECT_DOUBLE_EQ(zhai.ballast_mass->mass, 1062.8);
  const TrackData railfe = railfe_default_track();
  EXPECT_DOUBLE_EQ(railfe.pad_stiffness, 400e6);
  EXPECT_DOUBLE_EQ(railfe.pad_damping, 56e3);
  EXPECT_DOUBLE_EQ(railfe.sleeper_mass, 280);
  EXPECT_DOUBLE_EQ(railfe.ballast_stiffness, 80e6);
  EXPECT_DOUBLE_EQ(railfe.ballast_damping, 94e3);
  const TrackData lincent = lincent_like_track();
  EXPECT_DOUBLE_EQ(lincent.pad_stiffness, 153.4e6);
  EXPECT_DOUBLE_EQ(lincent.pad_damping, 13.5e3);
  EXPECT_DOUBLE_EQ(lincent.sleeper_mass, 300);
  EXPECT_DOUBLE_EQ(lincent.ballast_stiffness, 920e6);
  EXPECT_DOUBLE_EQ(lincent.ballast_damping, 16.5e3);
  for (const TrackData& data : {zhai, railfe, lincent}) EXPECT_DOUBLE_EQ(data.sleeper_spacing, 0.6);
}

TEST(RailSections, HoldTheTabulatedValues) {
  struct Row {
    const char* name;
    double area, inertia, mass_per_length, youngs_modulus;
  };
  const std::vector<Row> rows = {
      {"60E1", 7.67e-3, 3.038e-5, 60.21, 210e9},    // F: STEM
      {"UIC60", 7.67e-3, 3.038e-5, 60.21, 210e9},   // the same rail
      {"54E1", 6.977e-3, 2.3372e-5, 54.77, 210e9},  // F: STEM
      {"50E2", 6.365e-3, 1.9887e-5, 49.97, 210e9},  // M-m: EN 13674-1
      {"46E3", 5.944e-3, 1.606e-5, 46.66, 210e9},   // F: STEM
      {"CN60", 7.745e-3, 3.217e-5, 60.64, 205.9e9}  // F: TTB-2D
  };
  EXPECT_EQ(rail_sections().size(), rows.size());
  for (const Row& row : rows) {
    const RailSection& rail = rail_section(row.name);
    EXPECT_EQ(rail.name, row.name);
    EXPECT_DOUBLE_EQ(rail.area, row.area) << row.name;
    EXPECT_DOUBLE_EQ(rail.inertia, row.inertia) << row.name;
    EXPECT_DOUBLE_EQ(rail.mass_per_length, row.mass_per_length) << row.name;
    EXPECT_DOUBLE_EQ(rail.youngs_modulus, row.youngs_modulus) << row.name;
  }
}

TEST(SourcedValue, ForgetsItsSourceWhenTheUserChangesIt) {
  TrackData data = t2000_like_track();
  EXPECT_THAT(data.pad_stiffness.source, HasSubstr("M-l"));
  data.pad_stiffness = 200e6;
  EXPECT_EQ(data.pad_stiffness, 200e6);
  EXPECT_EQ(data.pad_stiffness.source, "set by the user");
}

TEST(TrackData, RefusesImpossibleValuesByObjectQuantityValueAndRange) {
  EXPECT_THAT(
      validating_tram_with([](TrackData& d) { d.ballast_stiffness = -25e6; }),
      ThrowsMessage<ModelError>("track \"t2000-like\": ballast stiffness = -2.5e+07 N/m, must be > 0"));
  EXPECT_THAT(validating_tram_with([](TrackData& d) { d.sleeper_spacing = 0; }),
              ThrowsMessage<ModelError>("track \"t2000-like\": sleeper spacing = 0 m, must be > 0"));
  EXPECT_THAT(validating_tram_with([](TrackData& d) { d.pad_damping = std::nan(""); }),
              ThrowsMessage<ModelError>("track \"t2000-like\": pad damping = nan N s/m, must be >= 0"));
  EXPECT_THAT(validating_tram_with([](TrackData& d) { d.sleeper_mass = INFINITY; }),
              ThrowsMessage<ModelError>("track \"t2000-like\": sleeper mass = inf kg, must be > 0"));
  EXPECT_THROW(validating_tram_with([](TrackData& d) { d.elements_per_bay = 0; })(), ModelError);
  EXPECT_THROW(validating_tram_with([](TrackData& d) { d.rail.inertia = -1; })(), ModelError);
  EXPECT_THROW(validating_tram_with([](TrackData& d) { d.ends.bays = -1; })(), ModelError);
  EXPECT_THROW(validating_tram_with([](TrackData& d) { d.footprint_width = 0; })(), ModelError);
}

TEST(Foundation, IsRefusedWithTheConditionOfPassivityThatItViolates) {
  const auto with_clm = [](Clm clm) {
    return validating_tram_with([clm](TrackData& d) { d.foundation = clm; });
  };
  EXPECT_THAT(
      with_clm({600, 50e6, 400e3, 20e6, -101e3}),
      ThrowsMessage<ModelError>(AllOf(HasSubstr("not passive: d_f + 4 d_c = 400000 + 4 x -101000 = -4000"),
                                      HasSubstr("must be >= 0"))));
  EXPECT_THAT(
      with_clm({600, 50e6, 400e3, -13e6, 0}),
      ThrowsMessage<ModelError>(HasSubstr("not passive: k_f + 4 k_c = 5e+07 + 4 x -1.3e+07 = -2e+06")));
  EXPECT_THAT(with_clm({-1, 50e6, 400e3, 20e6, 0}), ThrowsMessage<ModelError>(HasSubstr("m_f = -1 kg")));
  EXPECT_THAT(with_clm({600, -50e6, 400e3, 20e6, 0}),
              ThrowsMessage<ModelError>(HasSubstr("k_f = -5e+07 N/m")));
  EXPECT_THAT(with_clm({600, 50e6, -1, 20e6, 0}), ThrowsMessage<ModelError>(HasSubstr("d_f = -1 N s/m")));
  EXPECT_THAT(with_clm({600, 50e6, 1, std::nan(""), 0}), ThrowsMessage<ModelError>(HasSubstr("k_c = nan")));
  EXPECT_NO_THROW(with_clm({600, 50e6, 400e3, 20e6, -100e3})());  // on the bound
  EXPECT_NO_THROW(with_clm({0, 50e6, 400e3, -12e6, 0})());
  EXPECT_THROW(with_clm({600, 0, 400e3, 20e6, 0})(), ModelError);  // passive, but the track would sink
}

TEST(Foundation, KindsNestIntoTheCoupledLumpedMassModel) {
  EXPECT_EQ(kind_of(Foundation{}), "rigid");
  EXPECT_TRUE(is_rigid(Foundation{}));
  const Clm clm = as_clm(WinklerMass{300, 50e6, 4e5});
  EXPECT_EQ(clm.m_f, 300);
  EXPECT_EQ(clm.k_c, 0);
  EXPECT_EQ(as_clm(Winkler{50e6, 4e5}).m_f, 0);
}

}  // namespace

#include "track/track_data.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

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
  for (const TrackData& data : {t2000_like_track(), thalys_like_track()}) {
    EXPECT_NO_THROW(validate(data));
    for (const easydyn::Parameter& p : parameters(data)) {
      EXPECT_FALSE(p.unit.empty()) << p.name;
      EXPECT_THAT(p.source, testing::Not(testing::AnyOf("", "default", "set by the user"))) << p.name;
    }
  }
}

TEST(BundledTracks, HoldValuesOfTheWholeTrack) {
  EXPECT_EQ(t2000_like_track().pad_stiffness, 180e6);      // 2 x 90 MN/m per rail
  EXPECT_EQ(t2000_like_track().sleeper_mass, 180);         // 2 x 90 kg per rail
  EXPECT_EQ(thalys_like_track().ballast_stiffness, 80e6);  // 2 x 40 MN/m per rail
  EXPECT_EQ(thalys_like_track().sleeper_mass, 300);
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

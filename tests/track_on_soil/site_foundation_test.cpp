#include "track_on_soil/site_foundation.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "easydyn/error.hpp"
#include "soil/site_file.hpp"
#include "tests/temporary_folder.hpp"
#include "tests/track_on_soil/small_sites.hpp"

namespace easydyn::track_on_soil {
namespace {

namespace fs = std::filesystem;
using easydyn::testing::TemporaryFolder;
using easydyn::testing::two_layers;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const FootprintRow row{0.3, 2.4, 0.6};

/// A folder with a site file.
struct Place {
  TemporaryFolder folder;
  fs::path file = folder.path() / "site.toml";

  FoundationOnSite find(const std::string& text, const FootprintRow& footprints = row) const {
    std::ofstream(file) << text;
    return find_foundation(file, soil::read_site(file), footprints);
  }
};

TEST(SiteFoundation, IsFittedOnceAndThenTakenFromItsFile) {
  const Place place;
  const FoundationOnSite fitted = place.find(two_layers());
  EXPECT_EQ(fitted.origin, "fitted to site.toml, and written to site.clm.toml");
  const FoundationOnSite taken = place.find(two_layers());
  EXPECT_EQ(taken.origin, "taken from site.clm.toml");
  EXPECT_EQ(taken.clm.fit.clm.k_f.value, fitted.clm.fit.clm.k_f.value);
  EXPECT_EQ(taken.clm.fit.model_01, fitted.clm.fit.model_01);
}

TEST(SiteFoundation, IsFittedAnewForOtherLayersOrFootprintsOnly) {
  const Place place;
  const double k_f = place.find(two_layers()).clm.fit.clm.k_f;
  // other receivers, other settings of the solver
  EXPECT_EQ(place
                .find(two_layers(
                    120, "[[receiver]]\nname = \"16 m\"\ndistance = 16\n[solver]\nhighest_frequency = 90\n"))
                .origin,
            "taken from site.clm.toml");
  const FoundationOnSite stiffer = place.find(two_layers(150));
  EXPECT_EQ(stiffer.origin,
            "fitted to site.toml, since site.clm.toml belongs to other layers, and written to "
            "site.clm.toml");
  EXPECT_GT(stiffer.clm.fit.clm.k_f, 1.2 * k_f);
  EXPECT_THAT(place.find(two_layers(150), {0.3, 2.4, 0.72}).origin, HasSubstr("belongs to other footprints"));
  EXPECT_EQ(place.find(two_layers(150), {0.3, 2.4, 0.72}).origin, "taken from site.clm.toml");
}

TEST(SiteFoundation, IsFittedAnewForOtherBlocks) {
  const Place place;
  place.find(two_layers());
  const std::string trench = "[[block]]\nx = [-inf, inf]\ny = [5, 6]\nz = [-4, 0]\nopen = true\n";
  EXPECT_THAT(place.find(two_layers(120, trench)).origin, HasSubstr("site.clm.toml belongs to other blocks"));
  EXPECT_EQ(place.find(two_layers(120, trench)).origin, "taken from site.clm.toml");
}

TEST(SiteFoundation, IsRefusedToResponsesWithoutAConstantDampingRatio) {
  soil::StoredMobility stored;
  for (const soil::GroundDamping damping :
       {soil::GroundDamping::none, soil::GroundDamping::stiffness_proportional}) {
    stored.damping = damping;
    EXPECT_THAT([&] { calibrate_on_mobility(stored, "a.mobility.h5", 0.6); },
                ThrowsMessage<InputError>(HasSubstr("a.mobility.h5: damping = " + soil::name_of(damping) +
                                                    ", must be constant or constant-q")));
  }
}

TEST(SiteFoundation, KeepsABandThatSomebodyChose) {
  const Place place;
  std::ofstream(place.file) << two_layers();
  const SiteClm chosen = calibrate_on_site(soil::read_site(place.file), row, {.lowest = 3, .highest = 24});
  EXPECT_EQ(chosen.fit.frequency.size(), 22);
  write_clm(clm_file_of(place.file), chosen);
  const FoundationOnSite taken = place.find(two_layers());
  EXPECT_EQ(taken.origin, "taken from site.clm.toml");
  EXPECT_EQ(taken.clm.highest, 24);
  EXPECT_EQ(taken.clm.fit.clm.k_c.value, chosen.fit.clm.k_c.value);
}

TEST(SiteFoundation, IsThatOfTheInfiniteChain) {
  // A chain of two has constants of its own, which are wrong in a track of hundreds of sleepers.
  const Place place;
  std::ofstream(place.file) << two_layers();
  const SiteClm two = calibrate_on_site(soil::read_site(place.file), row, {.foundations = 2});
  EXPECT_EQ(two.fit.system, "chain of 2");
  write_clm(clm_file_of(place.file), two);
  const FoundationOnSite fitted = place.find(two_layers());
  EXPECT_EQ(
      fitted.origin,
      "fitted to site.toml, since site.clm.toml is fitted to a chain of 2, not to the infinite chain, and "
      "written to site.clm.toml");
  EXPECT_EQ(fitted.clm.foundations, 0);
  EXPECT_GT(std::abs(two.fit.clm.k_c / fitted.clm.fit.clm.k_c - 1), 0.05);
  EXPECT_EQ(place.find(two_layers()).origin, "taken from site.clm.toml");
}

TEST(SiteFoundation, SaysThatItsFileCannotBeWritten) {
  const Place place;
  fs::create_directory(place.folder.path() / "site.clm.toml.part");  // where the file would be written first
  const FoundationOnSite fitted = place.find(two_layers());
  EXPECT_THAT(fitted.origin, AllOf(HasSubstr("fitted to site.toml; "),
                                   HasSubstr("site.clm.toml cannot be written: every run will fit anew")));
  EXPECT_GT(fitted.clm.fit.clm.k_f, 0);
}

TEST(SiteFoundation, IsRefusedFromAFileThatIsNone) {
  const Place place;
  std::ofstream(clm_file_of(place.file)) << "format = 1\nsource = \"x\"\n";
  EXPECT_THAT([&] { place.find(two_layers()); }, ThrowsMessage<InputError>(HasSubstr("site.clm.toml")));
}

TEST(SiteFoundation, NeedsDampingInEveryLayer) {
  soil::Site site = easydyn::testing::half_space(150, 0.3, 0);
  EXPECT_THAT([&] { calibrate_on_site(site, row); },
              ThrowsMessage<ModelError>(HasSubstr("damping = 0, must be > 0")));
}

TEST(CalibrationFrequencies, HoldBothEndsOfTheBand) {
  const Eigen::VectorXd f = calibration_frequencies(2, 50);
  EXPECT_EQ(f.size(), 49);
  EXPECT_EQ(f[0], 2);
  EXPECT_EQ(f[48], 50);
  EXPECT_EQ(calibration_frequencies(10, 12.5).size(), 12);
  EXPECT_THROW(calibration_frequencies(0, 12), ModelError);
  EXPECT_THROW(calibration_frequencies(12, 12), ModelError);
}

}  // namespace
}  // namespace easydyn::track_on_soil

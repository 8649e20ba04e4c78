#include "track_on_soil/site_compliance.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "easydyn/error.hpp"
#include "soil/layered/layered_prediction.hpp"
#include "soil/mobility_identity.hpp"
#include "soil/site_file.hpp"
#include "tests/track_on_soil/small_sites.hpp"
#include "track/clm_chain.hpp"
#include "track_on_soil/site_foundation.hpp"

namespace easydyn::track_on_soil {
namespace {

using easydyn::testing::half_space;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(SiteClm, OfAHalfSpaceHasTheConstantsOfAnIndependentFit) {
  // Half-space cs 150 m/s, rho 1800 kg/m3, nu 0.35, footprint 0.285 m x 2.5 m every 0.6 m, 2-50 Hz, another code: 64.3 MN/m,
  // 493 kg, 499 kNs/m, 60.5 MN/m, -124.7 kNs/m, errors 4 % and 4 %, on the bound of passivity (tests/track/
  // clm_of_half_space_test.cpp). There the moduli are the same at all frequencies; here 3 % of loss disperse them (constant
  // Q): they rise by 6 % from 2 to 50 Hz, about 4 MN/m of k_f, which m_f takes up as 4e6 / (2 pi 40)^2 = 60 kg less.
  soil::Site site = half_space(150, 0.35, 0.015);
  site.damping_frequency = 10;
  track::ClmFitOptions options;  // its frequencies all alike
  options.weight = Eigen::VectorXd::Ones(calibration_frequencies(options.lowest, options.highest).size());
  const track::ClmFit fit = calibrate_on_site(site, {0.285, 2.5, 0.6}, options).fit;
  EXPECT_NEAR(fit.clm.k_f, 64.3e6, 0.05 * 64.3e6);
  EXPECT_NEAR(fit.clm.m_f, 493 - 60, 0.05 * 493);
  EXPECT_NEAR(fit.clm.d_f, 499e3, 0.03 * 499e3);
  EXPECT_NEAR(fit.clm.k_c, 60.5e6, 0.05 * 60.5e6);
  EXPECT_NEAR(fit.clm.d_c, -124.7e3, 0.03 * 124.7e3);
  EXPECT_LT(fit.rms_00, 0.05);
  EXPECT_LT(fit.rms_01, 0.05);
  EXPECT_LT(fit.damping_margin, 0.02);
}

soil::StoredMobility mobility_of(const soil::Site& site, int count) {
  std::vector<soil::Footprint> footprints;
  for (int i = 0; i < count; ++i)
    footprints.push_back({.x = 0.72 * i, .y = 0, .length = 0.285, .width = 2.5});
  return compute_mobility(site, footprints, soil::GroundDamping::constant_q);
}

TEST(MobilityCompliance, NamesWhatIsSemiAnalyticalAmongFiniteElements) {
  soil::StoredMobility stored;
  stored.method = soil::element_method;
  for (int n = 0; n < 6; ++n) stored.mobility.shifts.push_back({0.6 * n, 0});
  const auto find = [&](int layered, int count) {
    stored.shift_methods.assign(6, soil::element_method);
    for (int n = 0; n < layered; ++n) stored.shift_methods[std::size_t(n)] = soil::layered_method;
    return find_origin(stored, "m.h5", 0.6, count);
  };
  EXPECT_EQ(find(0, 2).method, soil::element_method);
  EXPECT_EQ(find(0, 2).description, "finite elements");
  EXPECT_EQ(find(1, 2).method, mixed_method);
  EXPECT_EQ(find(1, 2).description, "finite elements; H_00 layered half-space");
  EXPECT_EQ(find(2, 3).description, "finite elements; H_00, H_01 layered half-space");
  EXPECT_EQ(find(4, 6).description, "finite elements; 4 of 6 layered half-space");
  // Sleepers closer than an element: nothing of the foundation is by finite elements.
  EXPECT_EQ(find(2, 2).method, soil::layered_method);
  EXPECT_EQ(find(2, 2).description, "layered half-space");
  // A file of an earlier version does not say; with blocks all of it is by finite elements.
  stored.shift_methods.clear();
  EXPECT_EQ(find_origin(stored, "m.h5", 0.6, 2).method, mixed_method);
  EXPECT_THAT(find_origin(stored, "m.h5", 0.6, 2).description, HasSubstr("near footprints may be"));
  stored.site.blocks.emplace_back();
  EXPECT_EQ(find_origin(stored, "m.h5", 0.6, 2).method, soil::element_method);
}

TEST(MobilityCompliance, IsThatOfTheLayers) {
  const soil::Site site = soil::read_site(std::string(EASYDYN_SITES) + "/tram.toml");
  const soil::StoredMobility stored = mobility_of(site, 4);
  const FootprintRow row = footprints_of(stored, "m.h5");
  EXPECT_EQ(row, (FootprintRow{0.285, 2.5, 0.72}));
  const Eigen::VectorXd f = Eigen::VectorXd::LinSpaced(25, 2, 50);
  const track::GroundCompliance from_time = transform_mobility(stored, "m.h5", row.spacing, f, 4),
                                direct = compute_site_compliance(site, row, f, 4);
  // What moves after the window, a thousandth at most, and the slow dispersion of constant Q below 1 Hz.
  EXPECT_LT((from_time.H - direct.H).cwiseAbs().maxCoeff(), 5e-3 * direct.H.cwiseAbs().maxCoeff());
  EXPECT_THAT(from_time.source, HasSubstr("m.h5 (layered half-space)"));
  EXPECT_THAT(
      [&] { transform_mobility(stored, "m.h5", row.spacing, f, 5); },
      ThrowsMessage<InputError>(HasSubstr("m.h5: \"/neighbour/offset\" has no footprint 2.88 m away")));
  EXPECT_THAT([&] { transform_mobility(stored, "m.h5", row.spacing, 3 * f, 4); },
              ThrowsMessage<InputError>(HasSubstr("frequency = 150 Hz, must be <= 100")));
  EXPECT_THAT([&] { footprints_of(mobility_of(site, 1), "m.h5"); },
              ThrowsMessage<InputError>(HasSubstr("holds no neighbour along the track")));
}

}  // namespace
}  // namespace easydyn::track_on_soil

// The calibration of the CLM on the ground itself: both steps of a prediction meet.

#include <gtest/gtest.h>

#include <numbers>

#include "soil/layered/footprint_response.hpp"
#include "soil/layered/layered_ground.hpp"
#include "soil/site_file.hpp"
#include "track/clm_calibration.hpp"
#include "track/clm_chain.hpp"
#include "track/track_data.hpp"

namespace {

using namespace easydyn;
using track::ClmFit;
using track::GroundCompliance;

/// Sleepers of 2.5 m x 0.285 m every 0.6 m on a half-space of cs 150 m/s, rho 1800 kg/m3, nu 0.35, loss factor 0.03.
GroundCompliance half_space(double lowest, double highest) {
  soil::Site site;
  site.layers = {{.name = "half-space",
                  .thickness = INFINITY,
                  .density = 1800,
                  .cs = 150,
                  .cp = 150 * std::sqrt(2 * (1 - 0.35) / (1 - 2 * 0.35)),
                  .damping = 0.015,
                  .source = ""}};
  GroundCompliance compliance;
  compliance.frequency =
      Eigen::VectorXd::LinSpaced(static_cast<Eigen::Index>(highest - lowest) + 1, lowest, highest);
  compliance.spacing = 0.6;
  compliance.source = "half-space";
  compliance.H.resize(compliance.frequency.size(), 9);
  soil::FootprintRequest request;
  request.length = 0.285;
  request.width = 2.5;
  for (int n = 0; n < 9; ++n) request.means.push_back({0.6 * n, 0, 0.285, 2.5});
  for (Eigen::Index i = 0; i < compliance.frequency.size(); ++i) {
    // Hysteretic, as in the reference: the same complex modulus at all frequencies.
    site.damping_frequency = compliance.frequency[i];
    const Eigen::VectorXcd w = Eigen::VectorXcd::Constant(1, 2 * std::numbers::pi * compliance.frequency[i]);
    compliance.H.row(i) =
        compute_footprint_response(soil::LayeredGround(site, soil::GroundDamping::constant_q), request, w)
            .mean;
  }
  return compliance;
}

TEST(ClmOfAHalfSpace, HasTheConstantsOfAnIndependentFit) {
  // Two independent codes: |H_00| = 6.926e-9 m/N at 2 Hz, H_01 / H_00 = 0.400 at low frequency (agree within 0.2 %).
  const GroundCompliance ground = half_space(2, 100);
  EXPECT_NEAR(std::abs(ground.H(0, 0)), 6.926e-9, 0.005 * 6.926e-9);
  EXPECT_NEAR(std::abs(ground.H(0, 1) / ground.H(0, 0)), 0.400, 0.002);
  // Their fit over 2-50 Hz: 64.3 MN/m, 493 kg, 499 kNs/m, 60.5 MN/m, -124.7 kNs/m, 4 % and 4 %, on the bound of passivity.
  const ClmFit low = calibrate_clm(ground, {.lowest = 2, .highest = 50});
  EXPECT_NEAR(low.clm.k_f, 64.3e6, 0.03 * 64.3e6);
  EXPECT_NEAR(low.clm.m_f, 493, 0.1 * 493);
  EXPECT_NEAR(low.clm.d_f, 499e3, 0.03 * 499e3);
  EXPECT_NEAR(low.clm.k_c, 60.5e6, 0.03 * 60.5e6);
  EXPECT_NEAR(low.clm.d_c, -124.7e3, 0.03 * 124.7e3);
  EXPECT_NEAR(low.rms_00, 0.04, 0.01);
  EXPECT_NEAR(low.rms_01, 0.04, 0.01);
  EXPECT_LT(low.damping_margin, 0.02);
  // Over 2-100 Hz their frequencies are not known; their set (70.6 MN/m, 241 kg, 604 kNs/m, 46.4 MN/m, -131 kNs/m, 6 % and
  // 12 %) must not be better than ours.
  const ClmFit wide = calibrate_clm(ground, {.lowest = 2, .highest = 100});
  EXPECT_LT(wide.rms_00, 0.06);
  EXPECT_LT(wide.rms_01, 0.12);
  double ours = 0, theirs = 0;
  for (Eigen::Index i = 0; i < ground.frequency.size(); ++i) {
    const double w = 2 * std::numbers::pi * ground.frequency[i];
    const auto add = [&](const track::Clm& clm, double& sum) {
      const track::ChainCompliance chain = compute_infinite_chain(chain_stiffness(clm, w));
      sum += std::norm(chain.H_0n(0) - ground.H(i, 0)) + std::norm(chain.H_0n(1) - ground.H(i, 1));
    };
    add(wide.clm, ours);
    add({241.0, 70.6e6, 604e3, 46.4e6, -131e3}, theirs);
  }
  EXPECT_LT(ours, theirs);
}

TEST(ClmOfAHalfSpace, LeavesOutTheCouplingBeyondNeighbours) {
  const ClmFit fit = calibrate_clm(half_space(2, 50), {.lowest = 2, .highest = 50, .foundations = 9});
  EXPECT_GT(fit.left_out, 0.02);  // a half-space couples every sleeper with every other
  EXPECT_LT(fit.left_out, 0.5);
  EXPECT_GT(fit.clm.k_f, 0);
  EXPECT_GT(fit.rms_00, 0.05);  // ... so that nine foundations follow it less well than infinitely many
  EXPECT_LT(fit.rms_00, 0.15);
}

/// The compliance of a site's ground, hysteretic as in the fits of the bundled tracks.
GroundCompliance of_site(const std::string& name, const track::TrackData& data) {
  soil::Site site = soil::read_site(std::string(EASYDYN_SITES) + "/" + name);
  GroundCompliance compliance;
  compliance.frequency = Eigen::VectorXd::LinSpaced(49, 2, 50);
  compliance.spacing = data.sleeper_spacing;
  compliance.source = site.name;
  compliance.H.resize(49, 2);
  soil::FootprintRequest request;
  request.length = data.footprint_length;
  request.width = data.footprint_width;
  for (int n = 0; n < 2; ++n)
    request.means.push_back({n * data.sleeper_spacing, 0, data.footprint_length, data.footprint_width});
  for (Eigen::Index i = 0; i < 49; ++i) {
    site.damping_frequency = compliance.frequency[i];
    const Eigen::VectorXcd w = Eigen::VectorXcd::Constant(1, 2 * std::numbers::pi * compliance.frequency[i]);
    compliance.H.row(i) =
        compute_footprint_response(soil::LayeredGround(site, soil::GroundDamping::constant_q), request, w)
            .mean;
  }
  return compliance;
}

/// Root mean square of both errors over the band, relative to |H_00| at its lowest frequency.
double residual(const GroundCompliance& ground, const track::Clm& clm) {
  double sum = 0;
  for (Eigen::Index i = 0; i < ground.frequency.size(); ++i) {
    const track::ChainCompliance chain =
        compute_infinite_chain(chain_stiffness(clm, 2 * std::numbers::pi * ground.frequency[i]));
    sum += std::norm(chain.H_0n(0) - ground.H(i, 0)) + std::norm(chain.H_0n(1) - ground.H(i, 1));
  }
  return std::sqrt(sum / static_cast<double>(ground.frequency.size())) / std::abs(ground.H(0, 0));
}

TEST(BundledClm, FollowsTheGroundOfItsSiteAsWellAsTheBestFit) {
  // The bundled sets are an independent fit with frequencies of its own: 13 % and 14 % (tram), 20 % and 20 % (HST). The
  // valley is flat: constants 5-13 % apart leave residuals within 2 % of each other.
  const auto expect_fit = [](const std::string& name, const track::TrackData& data, double rms_00,
                             double rms_01) {
    const GroundCompliance ground = of_site(name, data);
    const ClmFit fit = calibrate_clm(ground, {.lowest = 2, .highest = 50});
    EXPECT_NEAR(fit.rms_00, rms_00, 0.01) << name;
    EXPECT_NEAR(fit.rms_01, rms_01, 0.01) << name;
    const double ours = residual(ground, fit.clm), bundled = residual(ground, track::as_clm(data.foundation));
    EXPECT_LE(ours, bundled) << name;
    EXPECT_LT(bundled, 1.03 * ours) << name;
  };
  expect_fit("tram.toml", track::t2000_like_track(), 0.13, 0.14);
  expect_fit("hst.toml", track::thalys_like_track(), 0.20, 0.20);
}

}  // namespace

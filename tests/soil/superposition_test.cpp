// A train as the sum of shifted responses to one footprint.

#include "soil/layered/superposition.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "easydyn/error.hpp"
#include "soil/layered/footprint_response.hpp"
#include "soil/layered/layered_mobility.hpp"
#include "soil/layered/layered_prediction.hpp"

namespace easydyn::soil {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
constexpr double pi = std::numbers::pi;

Layer make_layer(double thickness, double cs, double nu, double density, double damping) {
  Layer layer;
  layer.thickness = thickness;
  layer.cs = cs;
  layer.cp = cs * std::sqrt((2 - 2 * nu) / (1 - 2 * nu));
  layer.density = density;
  layer.damping = damping;
  return layer;
}

Site make_site() {
  Site site;
  site.layers = {make_layer(2, 150, 0.33, 1800, 0.04), make_layer(0, 300, 0.3, 1900, 0.03)};
  site.receivers = {{"left", {0.4, 3, 0}}, {"right", {-2, -6, 0}}, {"below", {1, 4, -1.5}}};
  site.highest_frequency = 40;
  site.damping_frequency = 20;
  site.taper_length = 0;
  site.decay_time = 0.4;
  return site;
}

// A pulse that passes over seven footprints at 60 m/s; nothing above 40 Hz (exp(-(pi f s)^2) = 1e-8), at rest at both ends.
constexpr double passage = 60, start = 0.25, width = 0.034;
double force(double t, double x) {
  const double s = (t - start - x / passage) / width;
  return 1e4 * std::exp(-s * s);
}
SurfaceLoads make_loads() {
  SurfaceLoads loads;
  for (int j = 0; j < 7; ++j) loads.footprints.push_back({0.6 * j - 1.8, 0, 0.3, 2.5});
  loads.time = Eigen::VectorXd::LinSpaced(501, 0, 0.5);
  loads.force.resize(501, 7);
  for (Index i = 0; i < 501; ++i) {
    for (Index j = 0; j < 7; ++j) loads.force(i, j) = force(loads.time(i), loads.footprints[j].x);
  }
  return loads;
}

Mobility compute_mobility(const Site& site, const SurfaceLoads& loads, double window = 0) {
  Mobility mobility = list_distances(loads.footprints, site.receivers);
  update_mobility(LayeredGround(site, GroundDamping::maxwell_body), site.highest_frequency, mobility, window);
  return mobility;
}

TEST(Superposition, IsTheSumOverAllFootprints) {
  // The same by an inverse Fourier integral at real frequencies, footprint by footprint, with the transform of the
  // pulses in closed form: no window, no sampled loads, no impulse response. Its period of 4 s is free of echoes.
  const Site site = make_site();
  const SurfaceLoads loads = make_loads();
  const GroundMotion motion = superpose(compute_mobility(site, loads), site, loads);

  const double df = 0.25;
  const Index lines = 180;
  Eigen::VectorXcd w(lines);
  for (Index i = 0; i < lines; ++i) w(i) = 2 * pi * df * double(i);
  const LayeredGround ground(site, GroundDamping::maxwell_body);
  const auto nt = motion.time.size();
  Eigen::MatrixXd v[3], u = Eigen::MatrixXd::Zero(nt, 7);
  for (Eigen::MatrixXd& component : v) component = Eigen::MatrixXd::Zero(nt, 3);
  for (Index j = 0; j < 7; ++j) {
    const Footprint& f = loads.footprints[static_cast<std::size_t>(j)];
    FootprintRequest request;
    request.length = f.length;
    request.width = f.width;
    for (const Receiver& r : site.receivers)
      request.points.push_back({r.position[0] - f.x, r.position[1] - f.y, r.position[2]});
    for (const Footprint& g : loads.footprints)
      request.means.push_back({g.x - f.x, g.y - f.y, g.length, g.width});
    const FootprintResponse H = compute_footprint_response(ground, request, w);
    for (Index n = 0; n < nt; ++n) {
      for (Index i = 0; i < lines; ++i) {
        const double a = w(i).real() * width / 2, arrival = start + f.x / passage;
        const Complex F = 1e4 * width * std::sqrt(pi) * std::exp(-a * a) *
                          std::exp(Complex(0, w(i).real() * (motion.time(n) - arrival))) *
                          (i == 0 ? df : 2 * df);
        for (Index r = 0; r < 3; ++r) {
          const Complex rate = Complex(0, 1) * w(i) * F;
          v[0](n, r) += (rate * H.ux(i, r)).real();
          v[1](n, r) += (rate * H.uy(i, r)).real();
          v[2](n, r) += (rate * H.uz(i, r)).real();
        }
        for (Index g = 0; g < 7; ++g) u(n, g) += (F * H.mean(i, g)).real();
      }
    }
  }
  for (Index r = 0; r < 3; ++r) {
    const Eigen::MatrixXd* const computed[3] = {&motion.vx, &motion.vy, &motion.vz};
    for (int c = 0; c < 3; ++c) {
      EXPECT_LT((computed[c]->col(r) - v[c].col(r)).norm(), 1e-4 * v[2].col(r).norm()) << r << " " << c;
      std::printf("receiver %ld component %d: %.1e\n", long(r), c,
                  (computed[c]->col(r) - v[c].col(r)).norm() / v[2].col(r).norm());
    }
  }
  EXPECT_LT((motion.footprint_displacement - u).norm(), 1e-4 * u.norm());
  std::printf("footprints: %.1e\n", (motion.footprint_displacement - u).norm() / u.norm());
}

TEST(Superposition, DoesNotDependOnTheWindow) {
  const Site site = make_site();
  const SurfaceLoads loads = make_loads();
  const GroundMotion a = superpose(compute_mobility(site, loads, 1.2), site, loads);
  const GroundMotion b = superpose(compute_mobility(site, loads, 3), site, loads);
  EXPECT_LT((a.vz - b.vz).norm(), 1e-4 * b.vz.norm());
  EXPECT_LT((a.footprint_displacement - b.footprint_displacement).norm(),
            1e-4 * b.footprint_displacement.norm());
}

TEST(Superposition, IsCausal) {
  // The impulse response before the first compression wave: only what the limited band spreads, which
  // ten periods of the highest frequency ahead is 3e-6.
  Site site = make_site();
  site.receivers = {{"far", {0, 60, 0}}};
  const Mobility mobility = compute_mobility(site, make_loads());
  const double arrival = 58 / (1.03 * 564);  // from the edge of the footprint; cp with its dispersion
  double early = 0;
  for (Index i = 0; i < mobility.hz.rows(); ++i) {
    const double t = mobility.step * double(i - mobility.before);
    if (t < arrival - 10 / site.highest_frequency)
      early = std::max(early, mobility.hz.row(i).cwiseAbs().maxCoeff());
  }
  EXPECT_LT(early, 1e-5 * mobility.hz.cwiseAbs().maxCoeff());
}

TEST(Superposition, HoldsAStandingLoadAtItsStaticDeflection) {
  // Loads that start and end away from zero: brought in before the record, held after it.
  Site site = make_site();
  site.decay_time = 6;
  SurfaceLoads loads = make_loads();
  loads.force.setConstant(1e4);
  const Mobility mobility = compute_mobility(site, loads);
  const GroundMotion motion = superpose(mobility, site, loads);
  const Eigen::VectorXd still = mobility.step * mobility.mean.colwise().sum().transpose();  // m/N
  double expected = 0;
  for (int j = 0; j < 7; ++j) {
    for (std::size_t s = 0; s < mobility.shifts.size(); ++s) {
      if (std::abs(mobility.shifts[s][0] - 0.6 * std::abs(j - 3)) < 1e-9) expected += 1e4 * still(Index(s));
    }
  }
  const Eigen::VectorXd middle = motion.footprint_displacement.col(3);
  EXPECT_NEAR(middle(middle.size() - 1) / expected, 1, 1e-4);
  EXPECT_NEAR(middle(middle.size() / 2) / expected, 1, 1e-4);
  EXPECT_LT(motion.vz.bottomRows(200).cwiseAbs().maxCoeff(), 1e-6);  // [m/s], of some 1e-3 m of deflection
}

TEST(Superposition, MirrorsTheMotionAcrossTheTrackAndAlongIt) {
  Site site = make_site();
  site.receivers = {{"a", {0, 5, 0}}, {"b", {0, -5, 0}}, {"ahead", {7, 5, 0}}, {"behind", {-7, 5, 0}}};
  SurfaceLoads loads = make_loads();
  for (Index j = 0; j < 7; ++j) loads.force.col(j) = loads.force.col(3).eval();  // all at once
  const GroundMotion motion = superpose(compute_mobility(site, loads), site, loads);
  const double size = motion.vz.norm();
  EXPECT_LT((motion.vz.col(0) - motion.vz.col(1)).norm(), 1e-12 * size);
  EXPECT_LT((motion.vy.col(0) + motion.vy.col(1)).norm(), 1e-12 * size);
  EXPECT_LT(motion.vx.col(0).norm(), 1e-12 * size);
  EXPECT_LT((motion.vx.col(2) + motion.vx.col(3)).norm(), 1e-12 * size);
  EXPECT_GT(motion.vx.col(2).norm(), 0.05 * size / 2);
}

TEST(Superposition, RefusesWhatDoesNotFit) {
  Site site = make_site();
  SurfaceLoads loads = make_loads();
  const Mobility mobility = compute_mobility(site, loads, 1.2);
  site.receivers.push_back({"elsewhere", {0, 9, 0}});
  try {
    superpose(mobility, site, loads);
    FAIL();
  } catch (const ModelError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("receiver \"elsewhere\" and footprint 1"));
  }
  site = make_site();
  site.highest_frequency = 50;
  EXPECT_THROW(superpose(mobility, site, loads), ModelError);
  loads.footprints[2].width = 2;
  EXPECT_THROW(list_distances(loads.footprints, site.receivers), ModelError);

  site = make_site();
  loads = make_loads();
  loads.footprints[1].direction = LoadDirection::y;
  const std::string horizontal = "footprint 2 is loaded horizontally, must be vertically";
  EXPECT_THAT([&] { list_distances(loads.footprints, site.receivers); },
              ::testing::ThrowsMessage<ModelError>(::testing::HasSubstr(horizontal)));
  EXPECT_THAT([&] { superpose(mobility, site, loads); },
              ::testing::ThrowsMessage<ModelError>(::testing::HasSubstr(horizontal)));
  site.blocks.push_back({.name = "trench", .open = true, .material = {}});
  EXPECT_THAT(
      [&] { compute_mobility(site, make_loads().footprints, GroundDamping::maxwell_body, 1.0, 1); },
      ::testing::ThrowsMessage<ModelError>(::testing::HasSubstr("the block \"trench\", must have none")));
}

}  // namespace
}  // namespace easydyn::soil

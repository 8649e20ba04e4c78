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

TEST(Superposition, IsTheSameForAnEvenRowOfFootprintsAndForAnyOthers) {
  // An even row, in any order, goes by a convolution over the footprints; one more that is off it and not loaded makes
  // them go pair by pair. Both sum the same terms.
  Site site = make_site();
  site.receivers.clear();
  SurfaceLoads loads = make_loads();
  std::swap(loads.footprints[1], loads.footprints[5]);
  loads.force.col(1).swap(loads.force.col(5));
  SurfaceLoads with_another = loads;
  with_another.footprints.push_back({2.7, 0.1, 0.3, 2.5});
  with_another.force.conservativeResize(Eigen::NoChange, 8);
  with_another.force.col(7).setZero();
  const Mobility mobility = compute_mobility(site, with_another, 1.2);
  const GroundMotion even = superpose(mobility, site, loads), any = superpose(mobility, site, with_another);
  EXPECT_LT((even.footprint_displacement - any.footprint_displacement.leftCols(7)).norm(),
            1e-12 * even.footprint_displacement.norm());
  EXPECT_GT(any.footprint_displacement.col(7).norm(), 0.1 * any.footprint_displacement.col(0).norm());
}

TEST(Superposition, TakesLoadsOfAllDirections) {
  // Against the frequency responses at the true offsets of every pair, which know no symmetry and no reciprocity: a standing
  // harmonic motion is reached well within the record. 30 Hz, three directions, offsets of all signs.
  Site site = make_site();
  site.decay_time = 0;
  SurfaceLoads loads;
  loads.footprints = {{0, 0, 0.3, 1.1, LoadDirection::x},
                      {0.9, -2, 0.3, 1.1, LoadDirection::y},
                      {-1.5, 0.7, 0.3, 1.1, LoadDirection::down}};
  const double w = 2 * pi * 30;
  loads.time = Eigen::VectorXd::LinSpaced(3001, 0, 3);
  loads.force.resize(3001, 3);
  for (Index i = 0; i < 3001; ++i) {
    const double t = loads.time(i), rise = std::erf(6 * t - 2.5) / 2 + 0.5;
    for (Index j = 0; j < 3; ++j) loads.force(i, j) = 1e4 * rise * std::sin(w * t + double(j));
  }
  const GroundMotion motion = superpose(compute_mobility(site, loads), site, loads);

  const LayeredGround ground(site, GroundDamping::maxwell_body);
  const Eigen::VectorXcd frequency = Eigen::VectorXcd::Constant(1, w);
  Eigen::MatrixXcd v = Eigen::MatrixXcd::Zero(3, 3), u = Eigen::MatrixXcd::Zero(1, 3);
  for (Index j = 0; j < 3; ++j) {
    const Footprint& f = loads.footprints[static_cast<std::size_t>(j)];
    FootprintRequest request;
    request.length = f.length;
    request.width = f.width;
    request.direction = f.direction;
    for (const Receiver& r : site.receivers)
      request.points.push_back({r.position[0] - f.x, r.position[1] - f.y, r.position[2]});
    // Means by 3 x 5 points of Gauss's rule: disjoint footprints.
    const double along[3] = {-std::sqrt(0.6), 0, std::sqrt(0.6)},
                 along_weight[3] = {5. / 18, 8. / 18, 5. / 18};
    const double across[5] = {-0.906179845938664, -0.538469310105683, 0, 0.538469310105683,
                              0.906179845938664};
    const double across_weight[5] = {0.118463442528095, 0.239314335249683, 0.284444444444444,
                                     0.239314335249683, 0.118463442528095};
    for (const Footprint& g : loads.footprints)
      for (const double a : along)
        for (const double b : across)
          request.points.push_back({g.x + a * g.length / 2 - f.x, g.y + b * g.width / 2 - f.y, 0.0});
    request.means.push_back({0, 0, f.length, f.width});
    const FootprintResponse H = compute_footprint_response(ground, request, frequency);
    const Complex F = 1e4 * std::exp(Complex(0, double(j)));
    for (Index r = 0; r < 3; ++r) {
      v(0, r) += Complex(0, w) * F * H.ux(0, r);
      v(1, r) += Complex(0, w) * F * H.uy(0, r);
      v(2, r) += Complex(0, w) * F * H.uz(0, r);
    }
    for (Index g = 0; g < 3; ++g) {
      if (g == j) {
        u(g) += F * (j == 0 ? H.mean_x : j == 1 ? H.mean_y : H.mean)(0, 0);
        continue;
      }
      for (Index a = 0; a < 3; ++a)
        for (Index b = 0; b < 5; ++b) {
          const Index p = 3 + 15 * g + 5 * a + b;
          u(g) += F * along_weight[a] * across_weight[b] *
                  (g == 0   ? H.ux(0, p)
                   : g == 1 ? H.uy(0, p)
                            : -H.uz(0, p));
        }
    }
  }
  const Eigen::MatrixXd* const computed[3] = {&motion.vx, &motion.vy, &motion.vz};
  double error = 0,
         error_u = 0;  // once all load is there, and before the end of the record spreads by the limited band
  Index samples = 0;
  for (Index n = 0; n < motion.time.size(); ++n) {
    if (motion.time(n) < 1.2 || motion.time(n) > 1.8) continue;
    ++samples;
    const Complex phase = std::exp(Complex(0, w * motion.time(n)));
    for (Index r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c)
        error = std::max(error, std::abs((*computed[c])(n, r) - (phase * v(c, r)).imag()));
      error_u = std::max(error_u, std::abs(motion.footprint_displacement(n, r) - (phase * u(r)).imag()));
    }
  }
  // What folds back into the window is 1e-3 of what is left then.
  std::printf("velocities %.1e, displacements %.1e\n", error / v.cwiseAbs().maxCoeff(),
              error_u / u.cwiseAbs().maxCoeff());
  EXPECT_GT(samples, 50);
  EXPECT_LT(error, 1e-3 * v.cwiseAbs().maxCoeff());
  EXPECT_LT(error_u, 1e-3 * u.cwiseAbs().maxCoeff());
  EXPECT_GT(v.cwiseAbs().minCoeff(), 0.01 * v.cwiseAbs().maxCoeff());
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

TEST(LayeredMobility, TellsOfALayerThatRingsOn) {
  // 5 m of 100 m/s on rock ring at cs / (4 h) = 5 Hz; with 0.5 % of damping e^(-2 pi 5 0.005 t) = 0.8 after 1.4 s.
  Site site = make_site();
  site.layers = {make_layer(5, 100, 0.33, 1800, 0.005), make_layer(0, 1500, 0.3, 2400, 0.005)};
  site.receivers = {{"near", {0, 4, 0}}, {"far", {0, 20, 0}}};
  const auto compute = [&](double window) {
    return soil::compute_mobility(site, {{0, 0, 0.3, 2.5}}, GroundDamping::maxwell_body, window, 1);
  };
  const StoredMobility cut_off = compute(0);
  std::printf("rest %.4f at %s\n", cut_off.rest.share, cut_off.rest.where.c_str());
  EXPECT_GT(cut_off.rest.share, 0.1);
  EXPECT_EQ(cut_off.rest.where, "a receiver at (0, 20, 0) m from the footprint");
  EXPECT_EQ(cut_off.parameters.back().value, cut_off.rest.share);
  const StoredMobility whole = compute(20);
  std::printf("rest %.5f at %s\n", whole.rest.share, whole.rest.where.c_str());
  EXPECT_LT(whole.rest.share, ResponseRest::accepted);
}

TEST(LayeredMobility, RefusesWhatDoesNotFitInMemory) {
  // 1e6 places, 1e4 s at 40 Hz: 1.6e6 samples of 3e6 displacements, 8 byte for each and 7 for its spectrum: 72 TB.
  Mobility mobility;
  mobility.length = mobility.width = 1;
  mobility.places.assign(1000000, {0, 4, 0});
  EXPECT_THAT(
      [&] { update_mobility(LayeredGround(make_site(), GroundDamping::maxwell_body), 40, mobility, 1e4); },
      ::testing::ThrowsMessage<ModelError>(
          ::testing::HasSubstr("0 of footprints need 7.2e+04 GB of memory")));
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
  // Of several files the one that differs is named, with its own count.
  for (std::size_t j = 1; j < 7; ++j) loads.footprints[j].source = 1;
  EXPECT_THAT([&] { list_distances(loads.footprints, site.receivers); },
              ::testing::ThrowsMessage<ModelError>(::testing::HasSubstr(
                  "footprint 2 of load file 2 is 0.3 m x 2 m, must be 0.3 m x 2.5 m like footprint 1 of load "
                  "file 1 (soil run takes any sizes)")));

  site = make_site();
  loads = make_loads();
  loads.footprints[1].direction = LoadDirection::y;
  EXPECT_THAT([&] { superpose(mobility, site, loads); },
              ::testing::ThrowsMessage<ModelError>(
                  ::testing::HasSubstr("no responses to a load along y, which footprint 2 needs")));
  site.blocks.push_back({.name = "trench", .open = true, .material = {}});
  EXPECT_THAT(
      [&] { compute_mobility(site, make_loads().footprints, GroundDamping::maxwell_body, 1.0, 1); },
      ::testing::ThrowsMessage<ModelError>(::testing::HasSubstr("the block \"trench\", must have none")));
}

}  // namespace
}  // namespace easydyn::soil

#include "soil/lattice.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "easydyn/error.hpp"
#include "soil/surface_interpolation.hpp"

namespace easydyn::soil {
namespace {

Site layered_site() {
  Site site;
  for (const auto& [thickness, cs] : {std::pair{1.2, 109.0}, {1.8, 128.0}, {1.0, 236.0}, {0.0, 270.0}}) {
    Layer layer;
    layer.thickness = thickness;
    layer.density = 1900;
    layer.cs = cs;
    layer.cp = 2.08 * cs;
    site.layers.push_back(layer);
  }
  site.receivers = {{"a", {0, 16, 0}}, {"b", {2, 4, -1.5}}};
  return site;
}

TEST(Lattice, HasItsLinesOnTheLayerInterfaces) {
  const Site site = layered_site();
  const Lattice lattice = make_lattice(site, {{-18, 0, 0.285, 2.5}, {18, 0, 0.285, 2.5}});
  for (const double interface : {0.0, -1.2, -3.0, -4.0}) {
    const auto near = [&](double z) { return std::abs(z - interface) < 1e-12; };
    EXPECT_TRUE(std::any_of(lattice.z.begin(), lattice.z.end(), near)) << interface;
  }
  for (int e = 0; e < lattice.nz(); ++e) {
    const double middle = -(lattice.z[e] + lattice.z[e + 1]) / 2;
    EXPECT_EQ(lattice.layer[e], middle < 1.2 ? 0 : middle < 3 ? 1 : middle < 4 ? 2 : 3);
  }
}

TEST(Lattice, HasThePointsPerWavelengthAskedForInTheUndampedGround) {
  const Site site = layered_site();
  const Lattice lattice = make_lattice(site, {{-18, 0, 0.285, 2.5}, {18, 0, 0.285, 2.5}});
  const double slack = 1 + 1e-9, N = lattice.degree;
  for (int e = lattice.sponge_x[0]; e < lattice.nx() - lattice.sponge_x[1]; ++e)
    EXPECT_LE((lattice.x[e + 1] - lattice.x[e]) / N, 109.0 / 50 / 5.5 * slack);
  for (int e = 0; e < lattice.ny() - lattice.sponge_y[1]; ++e)
    EXPECT_LE((lattice.y[e + 1] - lattice.y[e]) / N, 109.0 / 50 / 5.5 * slack);
  for (int e = lattice.sponge_z[0]; e < lattice.nz(); ++e)
    EXPECT_LE((lattice.z[e + 1] - lattice.z[e]) / N, site.layers[lattice.layer[e]].cs / 50 / 5.5 * slack);
}

TEST(Lattice, HoldsLoadsReceiversAndMarginInItsUndampedGround) {
  const Site site = layered_site();
  const Lattice lattice = make_lattice(site, {{-18, 0, 0.285, 2.5}, {18, 0, 0.285, 2.5}});
  EXPECT_LE(lattice.interior_x()[0], -18 - 0.285 / 2 - 3);
  EXPECT_GE(lattice.interior_x()[1], 18 + 0.285 / 2 + 3);
  EXPECT_EQ(lattice.interior_y()[0], 0);
  EXPECT_GE(lattice.interior_y()[1], 19);
  EXPECT_LE(lattice.interior_z()[0], -4 - 3 * 0.5);
  EXPECT_TRUE(std::is_sorted(lattice.x.begin(), lattice.x.end()));
  EXPECT_TRUE(std::is_sorted(lattice.z.begin(), lattice.z.end()));
  EXPECT_EQ((lattice.nx() + 2) % 16, 0);
}

TEST(Lattice, CoarsensAwayFromTheLoadsForAFarFrequency) {
  const Site site = layered_site();  // slowest 109 m/s
  LatticeOptions options;
  options.far_frequency = 12.5;
  const Lattice lattice = make_lattice(site, {{-3, 0, 0.285, 2.5}, {3, 0, 0.285, 2.5}}, options);
  const double fine = 4 * 109 / (50 * 5.5), coarse = fine * 50 / 12.5, slack = 1 + 1e-9;
  for (int e = 0; e < lattice.nx(); ++e) {
    const double low = lattice.x[e], high = lattice.x[e + 1], size = high - low;
    if (low < 3.2 && high > -3.2) {
      EXPECT_LE(size, fine * slack) << "at " << low;
    }
    if (e >= lattice.sponge_x[0] && e < lattice.nx() - lattice.sponge_x[1]) {
      EXPECT_LE(size, coarse * slack) << "at " << low;
    }
    if (e > 0) {  // no jump by more than half
      EXPECT_NEAR(std::log(size / (low - lattice.x[e - 1])), 0, std::log(1.5) * slack) << "at " << low;
    }
  }
  for (int e = 0; e < lattice.ny() - lattice.sponge_y[1]; ++e)
    EXPECT_LE(lattice.y[e + 1] - lattice.y[e], (e < 1 ? fine : coarse) * slack);
  // The sponge starts where the elements are as coarse as they may be, so that it is as long as they allow.
  const int end = lattice.nx() - lattice.sponge_x[1];
  EXPECT_NEAR(lattice.x[end] - lattice.x[end - 1], coarse, 1e-3 * coarse);
  EXPECT_LE(lattice.interior_x()[0], -3 - 0.285 / 2 - 3);
  EXPECT_GE(lattice.interior_y()[1], 19);
  EXPECT_LE(lattice.z.back() - lattice.z[lattice.nz() - 1], fine * slack);
  for (const double interface : {-1.2, -3.0, -4.0}) {
    const auto near = [&](double z) { return std::abs(z - interface) < 1e-12; };
    EXPECT_TRUE(std::any_of(lattice.z.begin(), lattice.z.end(), near)) << interface;
  }
  EXPECT_GT(lattice.x.back() - lattice.interior_x()[1], 3 * 8 * fine);  // a sponge four times as long
  options.far_frequency = 60;
  EXPECT_THROW(make_lattice(site, {{0, 0, 0.285, 2.5}}, options), ModelError);
}

TEST(Lattice, RefusesFootprintsOffTheSymmetryPlaneInTheHalfModel) {
  EXPECT_THROW(make_lattice(layered_site(), {{0, 1, 1, 1}}), ModelError);
}

TEST(FootprintWeights, AddUpToTheForceThatTheModelCarries) {
  const Site site = layered_site();
  for (const bool half : {true, false}) {
    LatticeOptions options;
    options.half_model = half;
    const Lattice lattice = make_lattice(site, {{0.37, 0, 0.285, 2.5}}, options);
    const FootprintWeights weights = compute_footprint_weights(lattice, {0.37, 0, 0.285, 2.5}, 1);
    double force = 0, mean = 0;
    for (const NodeWeight& n : weights.force) force += n.weight;
    for (const NodeWeight& n : weights.mean) mean += n.weight;
    EXPECT_NEAR(force, half ? 0.5 : 1.0, 1e-13);
    EXPECT_NEAR(mean, 1.0, 1e-13);
  }
}

TEST(ReceiverWeights, NameTheReceiverOutsideTheUndampedGround) {
  const Lattice lattice = make_lattice(layered_site(), {{0, 0, 1, 1}});
  try {
    compute_receiver_weights(lattice, {"far", {0, 300, 0}});
    FAIL();
  } catch (const ModelError& error) {
    EXPECT_NE(std::string(error.what()).find("\"far\": y = 300"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace easydyn::soil

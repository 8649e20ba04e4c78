// What the comparison of boundaries relies on: its elements against solutions that share nothing with them.

#include "bench/axisymmetric_ground.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "soil/layered/footprint_response.hpp"

namespace easydyn::soil {
namespace {

constexpr double pi = std::numbers::pi;
using Complex = std::complex<double>;

Layer layer(double thickness, double cs, double nu) {
  Layer result;
  result.thickness = thickness;
  result.density = 1800;
  result.cs = cs;
  result.cp = cs * std::sqrt((2 - 2 * nu) / (1 - 2 * nu));
  return result;
}

Lattice make_model(const std::vector<Layer>& layers, double margin, double highest_frequency) {
  Site site;
  site.layers = layers;
  site.receivers.push_back({"last", {16, 0, 0}});
  site.margin = margin;
  site.highest_frequency = highest_frequency;
  LatticeOptions options;
  options.quarter_model = true;
  options.lanes = 1;
  return make_lattice(site, {{0, 0, 1, 1}}, options);
}

double ricker(double t) {
  const double a = std::pow(pi * 12 * (t - 0.15), 2);
  return 1e4 * (1 - 2 * a) * std::exp(-a);
}

TEST(AxisymmetricGround, MovesAsTheLayeredHalfSpace) {
  // Both at complex frequencies: exp(-4 t) damps what comes back from the edge and what comes after the record. The disc
  // has the second moments of the square, so that both differ by (k a)^4 only, about 1e-4. Measured: at most 0.2 %.
  const std::vector<Layer> layers{layer(5, 150, 1.0 / 3), layer(0, 300, 1.0 / 3)};
  Site site;
  site.layers = layers;
  AxisymmetricBoundary boundary;
  boundary.speed = 300;
  AxisymmetricGround ground(make_model(layers, 60, 50), layers, boundary, 1 / std::sqrt(3.0));
  const double dt = 0.5 * ground.compute_stable_step();
  ground.set_time_step(dt);
  const std::array<double, 4> frequencies{5, 8, 12, 20};
  const double r = 8, decay = 4;
  std::array<std::array<Complex, 2>, 4> motion{};
  std::array<Complex, 4> force{};
  for (int step = 0; step * dt < 1.6; ++step) {
    const double t = step * dt, F = ricker(t);
    ground.advance(F);
    for (std::size_t f = 0; f < frequencies.size(); ++f) {
      const Complex i_w(decay, 2 * pi * frequencies[f]);
      force[f] += F * std::exp(-i_w * t);
      for (int c = 0; c < 2; ++c) motion[f][c] += ground.displacement(r)[c] * std::exp(-i_w * (t + dt));
    }
  }
  FootprintRequest request;
  request.length = request.width = 1;
  request.points = {{r, 0, 0}};
  Eigen::VectorXcd w(4);
  for (int f = 0; f < 4; ++f) w(f) = Complex(2 * pi * frequencies[f], -decay);
  const FootprintResponse exact =
      compute_footprint_response(LayeredGround(site, GroundDamping::none), request, w);
  for (int f = 0; f < 4; ++f) {
    const Complex radial = motion[f][0] / force[f], vertical = motion[f][1] / force[f];
    const double size = std::hypot(std::abs(exact.ux(f, 0)), std::abs(exact.uz(f, 0)));
    std::printf("%g Hz: %.2e, %.2e\n", frequencies[f], std::abs(radial - exact.ux(f, 0)) / size,
                std::abs(vertical - exact.uz(f, 0)) / size);
    EXPECT_LT(std::abs(radial - exact.ux(f, 0)), 0.01 * size) << frequencies[f] << " Hz";
    EXPECT_LT(std::abs(vertical - exact.uz(f, 0)), 0.01 * size) << frequencies[f] << " Hz";
  }
}

}  // namespace
}  // namespace easydyn::soil

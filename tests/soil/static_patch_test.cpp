// Static deflection under a small patch: the mesh alone, by conjugate gradients on the operator of the engine.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "soil/gll.hpp"
#include "soil/layered/static_half_space.hpp"
#include "soil/surface_interpolation.hpp"
#include "soil/wave_engine.hpp"
#include "tests/soil/verification_record.hpp"

namespace easydyn::soil {
namespace {

/// Quarter of a ground: elements of size h up to 1.5 m from the origin, growing by 1.5 to 7 m away or more.
Lattice make_quarter(double h) {
  Lattice lattice;
  lattice.degree = 4;
  lattice.half_model = lattice.quarter_model = true;
  double size = h;
  lattice.x = {0};
  while (lattice.x.back() < 7) {
    lattice.x.push_back(lattice.x.back() + size);
    if (lattice.x.back() > 1.4) size *= 1.5;
  }
  lattice.y = lattice.x;
  for (auto x = lattice.x.rbegin(); x != lattice.x.rend(); ++x) lattice.z.push_back(-*x);
  lattice.layer.assign(lattice.z.size() - 1, 0);
  return lattice;
}

/// Mean deflection of a footprint under a unit load, times the shear modulus [1/m]. The outer faces move as a half-space
/// under a point load (Boussinesq), so that the mesh alone errs; the patch is no point, but at 7 m that is below 1e-3 of
/// a motion that is itself a twentieth of the deflection.
double compute_deflection(double h, double nu, const Footprint& footprint) {
  const Lattice lattice = make_quarter(h);
  const double density = 1800, mu = 4e7, lambda = 2 * mu * nu / (1 - 2 * nu);
  EngineBoundary boundary;
  boundary.dashpots = false;  // nor springs
  WaveEngine<double> engine(lattice, {{lambda, mu, density, 0, {}}}, {}, boundary, 2);
  const FootprintWeights weights = compute_footprint_weights(lattice, footprint, 1);
  const int nx = engine.nodes_x(), ny = engine.nodes_y(), nz = engine.nodes_z();
  const Eigen::Index n = Eigen::Index{3} * nx * ny * nz;
  const auto index = [&](int c, int X, int Y, int Z) {
    return ((Eigen::Index{c} * nz + Z) * ny + Y) * nx + X;
  };
  // Planes of symmetry: free along them, held across; outer faces: given.
  const auto for_each = [&](const auto& use) {
    for (int c = 0; c < 3; ++c)
      for (int Z = 0; Z < nz; ++Z)
        for (int Y = 0; Y < ny; ++Y)
          for (int X = 0; X < nx; ++X)
            use(c, X, Y, Z, (c == 0 && X == 0) || (c == 1 && Y == 0) || X == nx - 1 || Y == ny - 1 || Z == 0,
                index(c, X, Y, Z));
  };
  const GllRule rule(lattice.degree);
  const auto position = [&](const std::vector<double>& lines, int node) {
    const auto e = std::min(static_cast<std::size_t>(node / lattice.degree), lines.size() - 2);
    const auto local = node - static_cast<int>(e) * lattice.degree;
    return lines[e] + (lines[e + 1] - lines[e]) * (rule.points(local) + 1) / 2;
  };
  Eigen::VectorXd load = Eigen::VectorXd::Zero(n), scale(n);
  for (const NodeWeight& w : weights.force) load(index(2, w.X, w.Y, nz - 1)) -= w.weight;  // down
  // Precondition by the mass over the square of the nodes' distance: sizes differ by 100.
  const auto width = [](const std::vector<double>& lines, int node) {
    const std::size_t e = std::min(static_cast<std::size_t>(node / 4), lines.size() - 2);
    return lines[e + 1] - lines[e];
  };
  for_each([&](int, int X, int Y, int Z, bool held, Eigen::Index i) {
    const double smallest = std::min({width(lattice.x, X), width(lattice.y, Y), width(lattice.z, Z)});
    scale(i) = held ? 0 : smallest * smallest / engine.mass(X, Y, Z);
  });
  const auto apply = [&](const Eigen::VectorXd& u) {
    for_each(
        [&](int c, int X, int Y, int Z, bool, Eigen::Index i) { engine.set_displacement(c, X, Y, Z, u(i)); });
    const std::vector<double> f = engine.compute_internal_force();
    return Eigen::Map<const Eigen::VectorXd>(f.data(), n).eval();
  };
  Eigen::VectorXd u = Eigen::VectorXd::Zero(n);
  for_each([&](int c, int X, int Y, int Z, bool, Eigen::Index i) {
    if (X < nx - 1 && Y < ny - 1 && Z > 0) return;
    const double x = position(lattice.x, X), y = position(lattice.y, Y), r = std::hypot(x, y);
    const StaticPointResponse g =
        compute_static_point_response(nu, std::max(r, 1e-6), -position(lattice.z, Z));
    u(i) = (c == 2 ? -g.zz : r > 0 ? g.xz * (c == 0 ? x : y) / r : 0) / mu;
  });
  Eigen::VectorXd r = load - apply(u), s = scale.cwiseProduct(r), p = s;
  double rs = r.dot(s);
  const double first = rs;
  int iterations = 0;
  for (; rs > 1e-10 * first && iterations < 2000; ++iterations) {
    const Eigen::VectorXd Kp = apply(p);
    const double step = rs / p.dot(Kp);
    u += step * p;
    r -= step * Kp;
    s = scale.cwiseProduct(r);
    const double next = r.dot(s);
    p = s + next / rs * p;
    rs = next;
  }
  EXPECT_LT(iterations, 2000);
  double mean = 0;
  for (const NodeWeight& w : weights.mean) mean -= w.weight * u(index(2, w.X, w.Y, nz - 1));
  std::printf("h %.2f m: %ld dof, %d iterations\n", h, static_cast<long>(n), iterations);
  return mean * mu;
}

TEST(StaticPatch, IsAsStiffAsTheHalfSpaceOnElementsOfThirtyCentimetres) {
  // Exact: the mean over the rectangle in closed form (static_half_space.hpp).
  const double nu = 0.33;
  double worst = 0;
  for (const Footprint& footprint : {Footprint{0, 0, 0.6, 0.6}, {0, 0, 0.285, 2.5}}) {
    const double exact = compute_static_rectangle_mean(nu, footprint.length, footprint.width,
                                                       footprint.length, footprint.width, 0, 0);
    const double error = compute_deflection(0.3, nu, footprint) / exact - 1;
    std::printf("%.3f m x %.3f m: %+.4f\n", footprint.length, footprint.width, error);
    EXPECT_NEAR(error, 0, 0.01);
    worst = std::max(worst, std::abs(error));
  }
  test::record_verification("static-patch", 100 * worst);
}

}  // namespace
}  // namespace easydyn::soil

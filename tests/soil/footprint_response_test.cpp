// Responses in space to point loads and footprints on a layered half-space.

#include "soil/layered/footprint_response.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "easydyn/error.hpp"
#include "soil/layered/gauss_rule.hpp"
#include "soil/layered/static_half_space.hpp"
#include "soil/layered/wavenumber_response.hpp"
#include "tests/reference/lamb.hpp"
#include "tests/soil/verification_record.hpp"

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

Site make_half_space(double cs, double nu, double density, double damping) {
  Site site;
  site.layers = {make_layer(0, cs, nu, density, damping)};
  return site;
}

Site make_layered_site() {
  Site site;
  site.layers = {make_layer(2, 150, 0.33, 1800, 0.03), make_layer(1.5, 100, 0.45, 1700, 0.05),
                 make_layer(6, 220, 0.3, 1900, 0.02), make_layer(0, 400, 0.25, 2000, 0.01)};
  return site;
}

Eigen::VectorXcd frequencies(std::initializer_list<double> f) {
  Eigen::VectorXcd w(static_cast<Index>(f.size()));
  Index i = 0;
  for (const double value : f) w(i++) = 2 * pi * value;
  return w;
}

// ---- static closed forms ---------------------------------------------------------------------------------------

TEST(StaticHalfSpace, HasTheTransformOfItsPointResponse) {
  // int k G(k) Jn(k r) dk / (2 pi) by Gauss's rule, at a depth where e^(-kz) ends it.
  const double nu = 0.3, r = 1.3, z = 0.8;
  const GaussRule rule(200);
  double zz = 0, xz = 0, sum = 0, difference = 0, zx = 0;
  const double end = 45 / z;
  for (Index i = 0; i < 200; ++i) {
    const double k = end / 2 * (1 + rule.points(i)), weight = end / 2 * rule.weights(i) * k / (2 * pi);
    const StaticCompliance G = compute_static_compliance(nu, k, z);
    const double J0 = ::j0(k * r), J1 = ::j1(k * r), J2 = ::jn(2, k * r);
    zz += weight * G.zz * J0;
    xz += weight * G.xz * J1;
    sum += weight * (G.xx + G.yy) / 2 * J0;
    difference += weight * (G.xx - G.yy) / 2 * J2;
    zx += weight * G.zx * J1;
  }
  const StaticPointResponse u = compute_static_point_response(nu, r, z);
  EXPECT_NEAR(u.zz, zz, 1e-13);
  EXPECT_NEAR(u.xz, xz, 1e-13);
  EXPECT_NEAR(u.sum, sum, 1e-13);
  EXPECT_NEAR(u.difference, difference, 1e-13);
  EXPECT_NEAR(u.zx, zx, 1e-13);
  // On the surface: J. Boussinesq and V. Cerruti.
  const StaticPointResponse s = compute_static_point_response(nu, r, 0);
  EXPECT_NEAR(s.zz, (1 - nu) / (2 * pi * r), 1e-15);
  EXPECT_NEAR(s.xz, -(1 - 2 * nu) / (4 * pi * r), 1e-15);
  EXPECT_NEAR(s.sum - s.difference, 1 / (2 * pi * r), 1e-15);         // along the load
  EXPECT_NEAR(s.sum + s.difference, (1 - nu) / (2 * pi * r), 1e-15);  // across
}

TEST(StaticHalfSpace, IntegratesThePointResponseOverARectangle) {
  const double nu = 0.3, L = 0.3, B = 2.5, x = 0.9, y = 1.6;
  const GaussRule rule(40);
  double u[6] = {}, mean = 0;
  for (Index i = 0; i < 40; ++i) {
    for (Index j = 0; j < 40; ++j) {
      const double weight = rule.weights(i) * rule.weights(j) / 4;
      const double dx = x - L / 2 * rule.points(i), dy = y - B / 2 * rule.points(j), r = std::hypot(dx, dy);
      const double c = dx / r, s = dy / r;
      const StaticPointResponse g = compute_static_point_response(nu, r, 0);
      const double parts[6] = {
          g.zz,     c * g.xz, s * g.xz, g.sum - g.difference * (c * c - s * s), -2 * c * s * g.difference,
          -c * g.zx};
      for (int n = 0; n < 6; ++n) u[n] += weight * parts[n];
      // mean over a rectangle of another size at (x, y), of the closed form of the point inside it
      mean +=
          weight *
          compute_static_rectangle_response(nu, L, B, x + 0.2 * rule.points(i), y + 0.5 * rule.points(j)).zz;
    }
  }
  const StaticRectangleResponse s = compute_static_rectangle_response(nu, L, B, x, y);
  const double computed[6] = {s.zz, s.xz, s.yz, s.xx, s.yx, s.zx};
  for (int n = 0; n < 6; ++n) EXPECT_NEAR(computed[n], u[n], 1e-13) << n;
  EXPECT_NEAR(compute_static_rectangle_mean(nu, L, B, 0.4, 1.0, x, y), mean, 1e-12);
  // A rectangle on itself, the kinks at its edges in many cells.
  double self = 0;
  for (int cell = 0; cell < 64; ++cell) {
    for (Index i = 0; i < 40; ++i) {
      const double px = L / 2 * ((cell % 8) + 0.5 + rule.points(i) / 2) / 8;  // one quarter
      for (Index j = 0; j < 40; ++j) {
        const double py = B / 2 * ((cell / 8) + 0.5 + rule.points(j) / 2) / 8;
        self +=
            rule.weights(i) * rule.weights(j) / 256 * compute_static_rectangle_response(nu, L, B, px, py).zz;
      }
    }
  }
  EXPECT_NEAR(compute_static_rectangle_mean(nu, L, B, L, B, 0, 0), self, 1e-6 * self);
  // The centre of a rectangle, A. E. H. Love: (1 - nu) / (pi L B) (L asinh(B / L) + B asinh(L / B)).
  EXPECT_NEAR(compute_static_rectangle_response(nu, L, B, 0, 0).zz,
              (1 - nu) / (pi * L * B) * (L * std::asinh(B / L) + B * std::asinh(L / B)), 1e-13);
  // Far away closed form and expansion meet.
  EXPECT_NEAR(compute_static_rectangle_mean(nu, L, B, L, B, 150.01, 3) * 150.01 /
                  (compute_static_rectangle_mean(nu, L, B, L, B, 149.9, 3) * 149.9),
              1, 1e-6);
}

// ---- the dynamic ground ----------------------------------------------------------------------------------------

TEST(FootprintResponse, TendsToBoussinesqAtLowFrequency) {
  // Two layers of the same ground: below the interface nothing is taken in closed form. At 1e-4 Hz inertia is (w r / c)^2 ~
  // 1e-10; radiation is imaginary.
  Site site = make_half_space(150, 0.3, 1800, 0);
  site.layers.insert(site.layers.begin(), site.layers[0]);
  site.layers[0].thickness = 0.6;
  const LayeredGround ground(site, GroundDamping::none);
  Eigen::VectorXcd w(1);
  w(0) = 2 * pi * 1e-4 * Complex(1, -1e-3);
  const double mu = site.layers[0].shear_modulus();
  double worst = 0;
  FootprintRequest request;
  request.points = {{3, 4, 0}, {3, 4, -0.5}, {3, 4, -2}, {0.6, 0.8, -0.7}, {0, 0, -1}};
  for (const LoadDirection direction : {LoadDirection::down, LoadDirection::x, LoadDirection::y}) {
    request.direction = direction;
    const FootprintResponse u = compute_footprint_response(ground, request, w);
    for (std::size_t p = 0; p < request.points.size(); ++p) {
      const auto& [x, y, z] = request.points[p];
      const double r = std::hypot(x, y), c = r > 0 ? x / r : 1, s = r > 0 ? y / r : 0;
      const StaticPointResponse g = compute_static_point_response(0.3, r, -z);
      Eigen::Vector3d exact(g.xz * c, g.xz * s, -g.zz);
      if (direction == LoadDirection::x)
        exact << g.sum - g.difference * (c * c - s * s), -g.difference * 2 * c * s, g.zx * c;
      if (direction == LoadDirection::y)
        exact << -g.difference * 2 * c * s, g.sum + g.difference * (c * c - s * s), g.zx * s;
      const Index i = static_cast<Index>(p);
      const Eigen::Vector3d computed(u.ux(0, i).real(), u.uy(0, i).real(), u.uz(0, i).real());
      EXPECT_LT((computed * mu - exact).norm(), 1e-6 * exact.norm()) << "point " << p;
      worst = std::max(worst, (computed * mu - exact).norm() / exact.norm());
    }
  }
  test::record_verification("static-limit", worst);
}

TEST(FootprintResponse, IsReciprocalBetweenTheSurfaceAndPointsBelow) {
  const LayeredGround ground(make_layered_site(), GroundDamping::constant_q);
  const Eigen::VectorXcd w = frequencies({3, 15, 40});
  const std::array<double, 3> there{4, 3, 0};
  double worst = 0;
  for (const double depth : {1.0, 2.7, 8.0}) {
    // Load at the origin, down or along x, at the depth or on the surface; motion at (4, 3).
    const auto respond = [&](double source, double receiver, LoadDirection direction, double sign) {
      FootprintRequest request;
      request.source_depth = source;
      request.direction = direction;
      request.points = {{sign * there[0], sign * there[1], -receiver}};
      return compute_footprint_response(ground, request, w);
    };
    // A to B and B to A: the way back points the other way.
    const FootprintResponse down_below = respond(0, depth, LoadDirection::down, 1);
    const FootprintResponse below_down = respond(depth, 0, LoadDirection::down, -1);
    const FootprintResponse along_below = respond(0, depth, LoadDirection::x, 1);
    const FootprintResponse below_along = respond(depth, 0, LoadDirection::x, -1);
    for (Index i = 0; i < w.size(); ++i) {
      const double size = std::abs(down_below.uz(i, 0));
      for (const Complex difference :
           {down_below.uz(i, 0) - below_down.uz(i, 0), along_below.ux(i, 0) - below_along.ux(i, 0),
            along_below.uy(i, 0) - below_along.uy(i, 0),
            along_below.uz(i, 0) + below_down.ux(i, 0),  // down is -z
            down_below.ux(i, 0) + below_along.uz(i, 0)}) {
        EXPECT_LT(std::abs(difference), 1e-8 * size);
        worst = std::max(worst, std::abs(difference) / size);
      }
    }
  }
  test::record_verification("reciprocity", worst);
}

TEST(FootprintResponse, IsAlikeInCartesianWavenumbers) {
  // u = 1 / (4 pi^2) int int G P e^(i (kx x + ky y)) dkx dky by the trapezoidal rule, P the transform of the footprint: no
  // Bessel function, no quadrature over the footprint. What comes back from its period of 200 m is damped by Im w to
  // 1e-8. Receivers below the surface end the integral by e^(-kz).
  const LayeredGround ground(make_layered_site(), GroundDamping::constant_q);
  const double L = 0.285, B = 2.5, dk = 2 * pi / 200, end = 28;
  Eigen::VectorXcd w(1);
  w(0) = {2 * pi * 30, -60};
  FootprintRequest request;
  request.length = L;
  request.width = B;
  request.points = {{4, 3, -1}, {0.05, 2.2, -1}, {-2, 7, -1}};
  const FootprintResponse down = compute_footprint_response(ground, request, w);
  request.direction = LoadDirection::x;
  const FootprintResponse along = compute_footprint_response(ground, request, w);

  WavenumberResponse response(ground.compute_layers(w(0)), 0, {1});
  Eigen::Matrix<Complex, 6, 3> u = Eigen::Matrix<Complex, 6, 3>::Zero();  // x, y, z of both loads, by point
  const auto sinc = [](double x) { return std::sin(x) / x; };
  const int n = static_cast<int>(end / dk);
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      const double kx = (i + 0.5) * dk, ky = (j + 0.5) * dk, k = std::hypot(kx, ky);
      if (k > end) continue;
      WavenumberCompliance G;
      response.update(k, &G);
      // Four quadrants: even or odd in kx and ky.
      const double scale = 4 * dk * dk / (4 * pi * pi) * sinc(kx * L / 2) * sinc(ky * B / 2);
      const double c = kx / k, s = ky / k;
      for (int p = 0; p < 3; ++p) {
        const auto& place = request.points[static_cast<std::size_t>(p)];
        const double cx = std::cos(kx * place[0]), sx = std::sin(kx * place[0]);
        const double cy = std::cos(ky * place[1]), sy = std::sin(ky * place[1]);
        u(0, p) += scale * c * sx * cy * G.xz;
        u(1, p) += scale * s * cx * sy * G.xz;
        u(2, p) -= scale * cx * cy * G.zz;
        u(3, p) += scale * cx * cy * (G.xx * c * c + G.yy * s * s);
        u(4, p) -= scale * c * s * sx * sy * (G.xx - G.yy);
        u(5, p) += scale * c * sx * cy * G.zx;
      }
    }
  }
  for (int p = 0; p < 3; ++p) {
    const Eigen::Vector3cd by_hankel(down.ux(0, p), down.uy(0, p), down.uz(0, p));
    EXPECT_LT((by_hankel - u.block<3, 1>(0, p)).norm(), 1e-6 * by_hankel.norm()) << "point " << p;
    const Eigen::Vector3cd by_hankel_along(along.ux(0, p), along.uy(0, p), along.uz(0, p));
    EXPECT_LT((by_hankel_along - u.block<3, 1>(3, p)).norm(), 1e-6 * by_hankel_along.norm()) << "point " << p;
  }
}

TEST(FootprintResponse, AveragesOverAFootprint) {
  // Gauss's rule over the receiving rectangle, which does not touch the source.
  const LayeredGround ground(make_layered_site(), GroundDamping::constant_q);
  FootprintRequest request;
  request.length = 0.3;
  request.width = 2.5;
  request.means = {{0.7, 0.4, 0.5, 2}, {-0.7, -0.4, 0.5, 2}};
  const GaussRule rule(24);
  for (Index i = 0; i < 24; ++i) {
    for (Index j = 0; j < 24; ++j)
      request.points.push_back({0.7 + 0.25 * rule.points(i), 0.4 + rule.points(j), 0});
  }
  const FootprintResponse u = compute_footprint_response(ground, request, frequencies({5, 50}));
  for (Index f = 0; f < 2; ++f) {
    Complex mean = 0;
    for (Index i = 0; i < 24; ++i) {
      for (Index j = 0; j < 24; ++j) mean -= rule.weights(i) * rule.weights(j) / 4 * u.uz(f, 24 * i + j);
    }
    EXPECT_LT(std::abs(u.mean(f, 0) - mean), 1e-6 * std::abs(mean));
    EXPECT_LT(std::abs(u.mean(f, 1) - mean), 1e-6 * std::abs(mean));
  }
}

TEST(FootprintResponse, AveragesOverAFootprintUnderHorizontalLoads) {
  // As above, by both directions of the load, and over the loaded rectangle itself, where the slope is infinite at the edges:
  // 24 points are good to 1e-3 there (1 / n^2).
  const LayeredGround ground(make_layered_site(), GroundDamping::constant_q);
  const GaussRule rule(24);
  for (const LoadDirection direction : {LoadDirection::x, LoadDirection::y}) {
    FootprintRequest request;
    request.length = 0.3;
    request.width = 1.2;
    request.direction = direction;
    request.means = {{0.7, -0.4, 0.5, 2}, {0, 0, 0.3, 1.2}};
    for (const Footprint& mean : request.means) {
      for (Index i = 0; i < 24; ++i) {
        for (Index j = 0; j < 24; ++j) {
          request.points.push_back(
              {mean.x + mean.length / 2 * rule.points(i), mean.y + mean.width / 2 * rule.points(j), 0});
        }
      }
    }
    const FootprintResponse u = compute_footprint_response(ground, request, frequencies({5, 50}));
    for (Index f = 0; f < 2; ++f) {
      for (Index m = 0; m < 2; ++m) {
        Complex x = 0, y = 0, z = 0;
        for (Index i = 0; i < 24; ++i) {
          for (Index j = 0; j < 24; ++j) {
            const double weight = rule.weights(i) * rule.weights(j) / 4;
            const Index p = 24 * (24 * m + i) + j;
            x += weight * u.ux(f, p);
            y += weight * u.uy(f, p);
            z -= weight * u.uz(f, p);
          }
        }
        const double tolerance = (m == 0 ? 1e-6 : 1e-3) * std::max(std::abs(x), std::abs(y));
        EXPECT_LT(std::abs(u.mean_x(f, m) - x), tolerance);
        EXPECT_LT(std::abs(u.mean_y(f, m) - y), tolerance);
        EXPECT_LT(std::abs(u.mean(f, m) - z), tolerance);
      }
    }
  }
}

TEST(FootprintResponse, GivesTheReferenceCompliances) {
  // Independent computation, homogeneous half-space nu 0.35, loss factor 0.03, footprint 2.5 m x 0.285 m, spacing
  // 0.6 m, uniform pressure, mean displacement; two codes agree on it within 0.2 % (clm fit of the project).
  const double reference[3][3] = {{100, 1600, 1.750e-8}, {150, 1800, 6.926e-9}, {250, 1900, 2.364e-9}};
  for (const auto& [cs, density, H00] : reference) {
    Site site = make_half_space(cs, 0.35, density, 0.015);
    site.damping_frequency = 2;
    const LayeredGround ground(site, GroundDamping::constant_q);
    FootprintRequest request;
    request.length = 0.285;
    request.width = 2.5;
    request.means = {{0, 0, 0.285, 2.5}, {0.6, 0, 0.285, 2.5}};
    const FootprintResponse u = compute_footprint_response(ground, request, frequencies({0.5, 2}));
    EXPECT_NEAR(std::abs(u.mean(1, 0)) / H00, 1, 0.003);               // 0.2 % and rounding
    EXPECT_NEAR(std::abs(u.mean(0, 1) / u.mean(0, 0)), 0.400, 0.002);  // each within 0.2 %, rounded
  }
}

// ---- Lamb's problem --------------------------------------------------------------------------------------------

// Velocity under a force, from the frequency responses at w - i eta, and the exact one.
void compare_with_lamb(double nu, double tolerance) {
  const double cs = 150, density = 1800, f0 = 32, delay = 1.3 / f0, window = 0.6, step = 1.0 / 1024;
  const Site site = make_half_space(cs, nu, density, 0);
  const LayeredGround ground(site, GroundDamping::none);
  const Index n = 640, lines = 160;  // up to 256 Hz
  const double T = step * double(n), eta = std::log(1e4) / T;
  Eigen::VectorXcd w(lines);
  for (Index i = 0; i < lines; ++i) w(i) = {2 * pi * double(i) / T, -eta};
  FootprintRequest request;
  const double distances[] = {5, 10, 20, 30};
  for (const double r : distances) request.points.push_back({0.6 * r, -0.8 * r, 0});
  const FootprintResponse u = compute_footprint_response(ground, request, w);

  const auto ricker = [&](double t) {
    const double a = std::pow(pi * f0 * (t - delay), 2);
    return (1 - 2 * a) * std::exp(-a);
  };
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  Eigen::VectorXd force(n), signal(n);
  for (Index i = 0; i < n; ++i) force(i) = std::exp(-eta * step * double(i)) * ricker(step * double(i));
  Eigen::VectorXcd F(n / 2 + 1), V = Eigen::VectorXcd::Zero(n / 2 + 1);
  fft.fwd(F.data(), force.data(), int(n));

  const reference::Lamb lamb(nu);
  const double mu = density * cs * cs, h = 1e-4;
  const auto second = [&](double t) { return (ricker(t + h) - 2 * ricker(t) + ricker(t - h)) / (h * h); };
  for (int p = 0; p < 4; ++p) {
    const double r = distances[p];
    for (const bool vertical : {true, false}) {
      for (Index i = 0; i < lines; ++i) {
        const Complex H = vertical ? u.uz(i, p) : 0.6 * u.ux(i, p) - 0.8 * u.uy(i, p);
        V(i) = Complex(0, 1) * w(i) * H * F(i);
      }
      V(0) = V(0).real();
      fft.inv(signal.data(), V.data(), int(n));
      double difference = 0, norm = 0, early = 0, peak = 0;
      for (Index i = 0; step * double(i) < window * 0.9; i += 3) {
        const double t = step * double(i), computed = std::exp(eta * t) * signal(i);
        // Lamb's displacements: positive along the (downward) load, and outward.
        const double exact =
            (vertical ? -1 : 1) * lamb.convolve(vertical, second, 0, 2 * delay, t, r, cs) / (mu * r);
        difference += std::pow(computed - exact, 2);
        norm += exact * exact;
        peak = std::max(peak, std::abs(computed));
        if (t < r / site.layers[0].cp) early = std::max(early, std::abs(computed));
      }
      test::record_verification("semi-analytical-lamb", 100 * std::sqrt(difference / norm));
      EXPECT_LT(std::sqrt(difference / norm), tolerance)
          << "nu " << nu << ", " << r << " m, vertical " << vertical;
      EXPECT_LT(early, 1e-3 * peak) << "before the first wave, " << r << " m";  // the pulse starts with 1e-6
      std::printf("nu %.2f %2.0f m %s: L2 error %.5f %%, before the first wave %.1e\n", nu, r,
                  vertical ? "vertical" : "radial", 100 * std::sqrt(difference / norm), early / peak);
    }
  }
}

TEST(LambsProblemSemiAnalytical, IsSolvedForThreePoissonRatios) {
  for (const double nu : {0.25, 0.35, 0.45}) compare_with_lamb(nu, 0.002);  // to hold: 0.2 %
}

TEST(FootprintResponse, RefusesWhatCannotBe) {
  const LayeredGround ground(make_layered_site(), GroundDamping::constant_q);
  const Eigen::VectorXcd w = frequencies({10});
  FootprintRequest request;
  request.points = {{0, 0, 0}};
  EXPECT_THROW(compute_footprint_response(ground, request, w), ModelError);  // under a point load
  request.points = {{1, 0, 1}};
  EXPECT_THROW(compute_footprint_response(ground, request, w), ModelError);  // above the ground
  request.points = {{1, 0, 0}};
  request.length = 1;
  EXPECT_THROW(compute_footprint_response(ground, request, w), ModelError);  // no width
  request.width = 1;
  const LayeredGround elastic(make_layered_site(), GroundDamping::none);
  EXPECT_THROW(compute_footprint_response(elastic, request, w), ModelError);  // poles on the axis
}

}  // namespace
}  // namespace easydyn::soil

// Layered half-space in the frequency-wavenumber domain.

#include "soil/layered/layered_ground.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/MatrixFunctions>

#include "easydyn/error.hpp"
#include "soil/layered/static_half_space.hpp"
#include "soil/layered/wavenumber_response.hpp"
#include "tests/soil/verification_record.hpp"

namespace easydyn::soil {
namespace {

using Complex = std::complex<double>;
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

// Soft over stiff, with a slow layer in between.
Site make_site() {
  Site site;
  site.layers = {make_layer(2, 150, 0.33, 1800, 0.03), make_layer(1.5, 100, 0.45, 1700, 0.05),
                 make_layer(6, 220, 0.3, 1900, 0.02), make_layer(0, 400, 0.25, 2000, 0.01)};
  return site;
}

Site make_half_space(double damping) {
  Site site;
  site.layers = {make_layer(0, 150, 0.3, 1800, damping)};
  return site;
}

double compute_difference(const WavenumberCompliance& a, const WavenumberCompliance& b) {
  const Complex va[] = {a.xx, a.xz, a.zx, a.zz, a.yy}, vb[] = {b.xx, b.xz, b.zx, b.zz, b.yy};
  double difference = 0, size = 0;
  for (int i = 0; i < 5; ++i) {
    difference = std::max(difference, std::abs(va[i] - vb[i]));
    size = std::max(size, std::abs(vb[i]));
  }
  return difference / size;
}

WavenumberCompliance respond(const std::vector<LayerAtFrequency>& layers, double k, double source,
                             double receiver) {
  WavenumberCompliance out;
  WavenumberResponse(layers, source, {receiver}).update(k, &out);
  return out;
}

constexpr double wavenumbers[] = {1e-4, 0.02, 0.3, 0.9, 2.2, 7, 40, 900};

TEST(LayeredGround, AgreesWithLambsTransformOnAHalfSpace) {
  const LayeredGround ground(make_half_space(0.03), GroundDamping::constant_q);
  for (const double f : {0.5, 20.0, 90.0}) {
    const auto layers = ground.compute_layers(2 * pi * f);
    for (const double k : wavenumbers) {
      // H. Lamb, Phil. Trans. A 203, 1904: u_z = ks^2 a / (G F), u_x = -k (2 k^2 - ks^2 - 2 a b) / (G F).
      const LayerAtFrequency& m = layers[0];
      const Complex a = std::sqrt(k * k - m.ks2 * m.speed_ratio2), b = std::sqrt(k * k - m.ks2);
      const Complex s = 2 * k * k - m.ks2, F = s * s - 4 * k * k * a * b;
      const WavenumberCompliance G = respond(layers, k, 0, 0);
      // F and the numerator of u_x cancel as (ks / k)^2 does.
      const double rounding = 1e-14 * std::max(1.0, 10 * k * k / std::abs(m.ks2));
      EXPECT_LT(std::abs(G.zz / (-m.ks2 * a / (m.mu * F)) - 1.0), rounding) << f << " " << k;
      EXPECT_LT(std::abs(G.xx / (-m.ks2 * b / (m.mu * F)) - 1.0), rounding) << f << " " << k;
      EXPECT_LT(std::abs(G.xz - k * (s - 2.0 * a * b) / (m.mu * F)), rounding * std::abs(G.zz))
          << f << " " << k;
      EXPECT_LT(std::abs(G.yy * m.mu * b - 1.0), 1e-14);
    }
  }
}

// Independent of any decomposition into waves: the state (u_x, u_z, tau, sigma) obeys y' = M y in each layer, carried
// (stresses over a modulus) up by the exponential of the matrix; in the half-space the eigenvectors that decay.
constexpr double modulus = 4e7;

Eigen::Matrix4cd make_system(const LayerAtFrequency& m, double k) {
  const Complex mu = m.mu / modulus, M = mu / m.speed_ratio2, lambda = M - 2.0 * mu, inertia = m.ks2 * mu;
  Eigen::Matrix4cd system = Eigen::Matrix4cd::Zero();
  system(0, 1) = k;  // u_x' = k u_z + tau / G
  system(0, 2) = 1.0 / mu;
  system(1, 0) = -lambda * k / M;  // u_z' = (sigma - lambda k u_x) / M
  system(1, 3) = 1.0 / M;
  system(2, 0) = k * k * (M - lambda * lambda / M) - inertia;  // tau' = k sigma_xx - rho w^2 u_x
  system(2, 3) = k * lambda / M;
  system(3, 1) = -inertia;  // sigma' = -k tau - rho w^2 u_z
  system(3, 2) = -k;
  return system;
}

Eigen::Matrix2cd compute_compliance_by_exponentials(const std::vector<LayerAtFrequency>& layers, double k) {
  const Eigen::ComplexEigenSolver<Eigen::Matrix4cd> solver(make_system(layers.back(), k));
  Eigen::Matrix<Complex, 4, 2> state;
  int found = 0;
  for (int i = 0; i < 4; ++i) {
    if (solver.eigenvalues()(i).real() < 0 && found < 2) state.col(found++) = solver.eigenvectors().col(i);
  }
  for (std::size_t i = layers.size() - 1; i-- > 0;)
    state = (make_system(layers[i], k) * -layers[i].thickness).exp() * state;
  // Tractions on the surface are -(tau, sigma).
  return -state.topRows<2>() * state.bottomRows<2>().inverse() / modulus;
}

TEST(LayeredGround, AgreesWithMatrixExponentials) {
  const LayeredGround ground(make_site(), GroundDamping::constant_q);
  for (const double f : {1.0, 12.0, 45.0}) {
    const auto layers = ground.compute_layers({2 * pi * f, -0.7});
    for (const double k : {0.05, 0.3, 0.9, 2.2}) {  // exponentials of 9.5 m lose digits beyond
      const WavenumberCompliance G = respond(layers, k, 0, 0);
      const Eigen::Matrix2cd reference = compute_compliance_by_exponentials(layers, k);
      Eigen::Matrix2cd computed;
      computed << G.xx, G.xz, G.zx, G.zz;
      EXPECT_LT((computed - reference).norm(), 1e-10 * reference.norm()) << f << " Hz, k = " << k;
    }
  }
}

TEST(LayeredGround, CarriesShearWavesAcrossAsTheClosedFormOfOneLayer) {
  Site site = make_site();
  site.layers.erase(site.layers.begin() + 1, site.layers.begin() + 3);
  const LayeredGround ground(site, GroundDamping::constant_q);
  for (const double k : {0.01, 0.4, 3.0}) {
    const auto l = ground.compute_layers(2 * pi * 25);
    const Complex b1 = std::sqrt(k * k - l[0].ks2), Z1 = l[0].mu * b1;
    const Complex Z2 = l[1].mu * std::sqrt(k * k - l[1].ks2), t = std::tanh(b1 * l[0].thickness);
    EXPECT_LT(std::abs(respond(l, k, 0, 0).yy * Z1 * (Z2 + Z1 * t) / (Z1 + Z2 * t) - 1.0), 1e-13);
  }
}

TEST(LayeredGround, IsNotChangedByArtificialInterfaces) {
  const Site site = make_site();
  Site split = site;
  split.layers.clear();
  for (const Layer& layer : site.layers) {
    if (&layer == &site.layers.back()) {
      for (const double thickness : {0.4, 3.0}) {
        split.layers.push_back(layer);
        split.layers.back().thickness = thickness;
      }
    } else {
      for (const double share : {0.01, 0.29, 0.7}) {
        split.layers.push_back(layer);
        split.layers.back().thickness *= share;
      }
    }
    if (&layer == &site.layers.back()) split.layers.push_back(layer);
  }
  const LayeredGround whole(site, GroundDamping::maxwell_body), cut(split, GroundDamping::maxwell_body);
  double worst = 0;
  for (const Complex w : {Complex(0, 0), Complex(1, 0), Complex(100, -1), Complex(600, 0)}) {
    const auto a = whole.compute_layers(w), b = cut.compute_layers(w);
    for (const double k : wavenumbers) {
      for (const double depth : {0.0, 0.7, 3.1, 12.0}) {
        if (k * depth > 30) continue;  // nothing arrives
        const double difference = compute_difference(respond(b, k, 0, depth), respond(a, k, 0, depth));
        EXPECT_LT(difference, 1e-10) << w << ", k = " << k << ", depth " << depth;
        worst = std::max(worst, difference);
      }
    }
  }
  test::record_verification("artificial-interfaces", worst);
}

TEST(LayeredGround, IsReciprocal) {
  const LayeredGround ground(make_site(), GroundDamping::constant_q);
  for (const double f : {2.0, 30.0}) {
    const auto layers = ground.compute_layers(2 * pi * f);
    for (const double k : {0.02, 0.3, 0.9, 2.2, 7.0}) {
      for (const double a : {0.0, 1.0, 2.0}) {
        for (const double b : {0.0, 0.4, 2.9, 5.0}) {
          const WavenumberCompliance there = respond(layers, k, a, b);
          WavenumberCompliance back = respond(layers, k, b, a);
          std::swap(back.xz, back.zx);
          EXPECT_LT(compute_difference(there, back), 1e-12)
              << "k = " << k << ", " << a << " and " << b << " m";
        }
      }
    }
  }
}

TEST(LayeredGround, BecomesStaticAtFrequencyZero) {
  const LayeredGround ground(make_half_space(0.03), GroundDamping::maxwell_body);
  for (const double depth : {0.0, 1.3}) {
    for (const double k : {0.01, 1.0, 20.0}) {
      const auto at_rest = ground.compute_layers(0);
      const StaticCompliance s = compute_static_compliance(0.3, k, depth);
      const Complex mu = at_rest[0].mu;
      const WavenumberCompliance exact{s.xx / mu, s.xz / mu, s.zx / mu, s.zz / mu, s.yy / mu};
      EXPECT_LT(compute_difference(respond(at_rest, k, 0, depth), exact), 1e-13);
      // Continuous: relative change of order (w / (k c))^2.
      const double w = 1e-5 * k * 150;
      const auto slow = ground.compute_layers(w);
      const WavenumberCompliance near = respond(slow, k, 0, depth);
      const Complex change = slow[0].mu / mu;
      EXPECT_LT(std::abs(near.zz * change / exact.zz - 1.0), 1e-8);
    }
  }
}

TEST(LayeredGround, RadiatesPlaneWavesDownwardAtWavenumberZero) {
  const LayeredGround ground(make_half_space(0), GroundDamping::none);
  const double w = 100;
  const WavenumberCompliance G = respond(ground.compute_layers(w), 1e-9, 0, 0);
  const Layer& l = ground.layers()[0];
  EXPECT_LT(std::abs(G.zz * Complex(0, w * l.density * l.cp) - 1.0), 1e-12);  // impedance rho c
  EXPECT_LT(std::abs(G.xx * Complex(0, w * l.density * l.cs) - 1.0), 1e-12);
  EXPECT_LT(std::abs(G.yy * Complex(0, w * l.density * l.cs) - 1.0), 1e-12);
}

TEST(LayeredGround, IsFiniteForThickLayersAndShortWaves) {
  Site site = make_site();
  for (Layer& layer : site.layers) layer.thickness *= 1000;
  const LayeredGround thick(site, GroundDamping::constant_q);
  Site first = site;
  first.layers = {site.layers.front()};
  const LayeredGround half_space(first, GroundDamping::constant_q);
  for (const double k : {2.0, 50.0, 1e4}) {
    const double w = 200;
    EXPECT_LT(compute_difference(respond(thick.compute_layers(w), k, 0, 0),
                                 respond(half_space.compute_layers(w), k, 0, 0)),
              1e-13);
  }
}

TEST(LayeredGround, HoldsModuliAndDampingAtTheDampingFrequency) {
  Site site = make_site();
  site.damping_frequency = 17;
  site.highest_frequency = 80;
  for (const GroundDamping damping :
       {GroundDamping::stiffness_proportional, GroundDamping::maxwell_body, GroundDamping::constant_q}) {
    const LayeredGround ground(site, damping);
    const auto layers = ground.compute_layers(2 * pi * 17);
    for (std::size_t i = 0; i < layers.size(); ++i) {
      EXPECT_NEAR(layers[i].mu.real() / site.layers[i].shear_modulus(), 1, 1e-12);
      // ten passes of fit_relaxation() leave 4e-9 of a ratio of 5 %
      EXPECT_NEAR(layers[i].mu.imag() / (2 * layers[i].mu.real()), site.layers[i].damping, 1e-9);
    }
  }
  // Constant Q at any other frequency; the Maxwell body within 8 % of the ratio over its band.
  for (const double f : {8.0, 30.0, 80.0}) {
    const auto q = LayeredGround(site, GroundDamping::constant_q).compute_layers(2 * pi * f);
    const auto body = LayeredGround(site, GroundDamping::maxwell_body).compute_layers(2 * pi * f);
    EXPECT_NEAR(q[0].mu.imag() / (2 * q[0].mu.real()), 0.03, 1e-12);
    EXPECT_NEAR(body[0].mu.imag() / (2 * body[0].mu.real()), 0.03, 0.08 * 0.03);
    // Both are causal: Re m changes by 4 xi / pi ln(80 / 8) = 9 % over this range, alike within a tenth of it.
    EXPECT_NEAR(body[0].mu.real() / q[0].mu.real(), 1, 0.009);
  }
}

TEST(LayeredGround, RefusesWhatCannotBe) {
  Site site = make_site();
  site.layers[1].cs = -100;
  EXPECT_THROW(LayeredGround(site, GroundDamping::none), ModelError);
  EXPECT_THROW(LayeredGround(Site{}, GroundDamping::none), ModelError);
  EXPECT_THROW(LayeredGround(make_site(), GroundDamping::constant_q).compute_layers(0), ModelError);
}

}  // namespace
}  // namespace easydyn::soil

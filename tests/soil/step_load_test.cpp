// A load that is put on and stays: once all waves have passed, the elastic half-space rests in its static deflection.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "soil/layered/footprint_response.hpp"
#include "soil/layered/static_half_space.hpp"
#include "tests/soil/verification_record.hpp"

namespace easydyn::soil {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
constexpr double pi = std::numbers::pi;

/// Elastic half-space, cs 150 m/s, 1800 kg/m3.
LayeredGround make_ground(double nu) {
  Site site;
  Layer layer;
  layer.density = 1800;
  layer.cs = 150;
  layer.cp = 150 * std::sqrt((2 - 2 * nu) / (1 - 2 * nu));
  site.layers = {layer};
  return {site, GroundDamping::none};
}
constexpr double mu = 1800 * 150.0 * 150.0;

/// A unit load that rises as an error function, 4 `rise` long around t = `start`, and stays.
struct Step {
  double period, start, rise;  // [s]
};

/// Displacements of the points, three rows each, at the given times after all waves, from the responses at complex
/// frequencies w_i = 2 pi i / T - i eta, with F(w) = e^(-i w start - (w rise / 2)^2) / (i w):
///
///   u(t) = e^(eta t) 2/T Re sum_i' H(w_i) F(w_i) e^(2 pi i t / T) - sum_n e^(-n eta T) u(t + n T),  n > 0
///
/// The ground then rests, u(t + n T) = u(t), and the sum is u / (1 - e^(-eta T)).
Eigen::MatrixXd compute_late_displacement(const LayeredGround& ground, const FootprintRequest& request,
                                          const Step& step, const Eigen::VectorXd& time) {
  const double T = step.period, eta = std::log(1e3) / T;
  const auto lines = static_cast<Index>(T * 10 / step.rise / (2 * pi));  // e^(-(w rise / 2)^2) = 1e-11
  Eigen::VectorXcd w(lines);
  for (Index i = 0; i < lines; ++i) w(i) = {2 * pi * static_cast<double>(i) / T, -eta};
  const FootprintResponse H = compute_footprint_response(ground, request, w);
  const auto points = static_cast<Index>(request.points.size());
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(3 * points, time.size());
  for (Index n = 0; n < time.size(); ++n)
    for (Index i = 0; i < lines; ++i) {
      const Complex iw = Complex(0, 1) * w(i);
      const Complex F = std::exp(iw * (time(n) - step.start) + iw * iw * (step.rise * step.rise / 4)) / iw *
                        ((i == 0 ? 1 : 2) / T * (1 - std::exp(-eta * T)));
      for (Index p = 0; p < points; ++p) {
        u(3 * p, n) += (F * H.ux(i, p)).real();
        u(3 * p + 1, n) += (F * H.uy(i, p)).real();
        u(3 * p + 2, n) += (F * H.uz(i, p)).real();
      }
    }
  return u;
}

TEST(StepLoad, LeavesTheDeflectionOfBoussinesqOnceTheRayleighWaveHasPassed) {
  // Lamb's problem: on the surface u_z rests from then on, 0.072 s for 10 m, here with the rise 0.1 s.
  double worst = 0;
  for (const double nu : {0.25, 0.3, 0.45}) {
    FootprintRequest request;
    request.points = {{3, 4, 0}, {0.6, -0.8, 0}, {-6, 8, 0}};
    const Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(5, 0.15, 0.35);
    const Eigen::MatrixXd u = compute_late_displacement(make_ground(nu), request, {0.8, 0.03, 6e-3}, time);
    for (std::size_t p = 0; p < 3; ++p) {
      const double exact = -(1 - nu) / (2 * pi * mu * std::hypot(request.points[p][0], request.points[p][1]));
      const double error = (u.row(3 * static_cast<Index>(p) + 2).array() / exact - 1).abs().maxCoeff();
      EXPECT_LT(error, 1e-6) << "nu " << nu << ", point " << p;
      std::printf("nu %.2f, point %zu: %.1e\n", nu, p, error);
      worst = std::max(worst, error);
    }
  }
  test::record_verification("boussinesq", worst);
}

TEST(StepLoad, LeavesTheDeflectionOfBoussinesqAndCerrutiAtLast) {
  // The other components and points below the surface come to rest as (r / (c t))^2: 1e-7 and less after 40 s.
  double worst = 0;
  for (const double nu : {0.25, 0.3, 0.45}) {
    FootprintRequest request;
    request.points = {{3, 4, 0}, {0.6, -0.8, 0}, {1.5, 2, -1}, {0, 0, -3}};
    const Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(3, 40, 60);
    for (const LoadDirection direction : {LoadDirection::down, LoadDirection::x, LoadDirection::y}) {
      request.direction = direction;
      const Eigen::MatrixXd u = compute_late_displacement(make_ground(nu), request, {160, 3, 0.8}, time);
      for (std::size_t p = 0; p < request.points.size(); ++p) {
        const auto& [x, y, z] = request.points[p];
        const double r = std::hypot(x, y), c = r > 0 ? x / r : 1, s = r > 0 ? y / r : 0;
        const StaticPointResponse g = compute_static_point_response(nu, r, -z);
        Eigen::Vector3d exact(g.xz * c, g.xz * s, -g.zz);
        if (direction == LoadDirection::x)
          exact << g.sum - g.difference * (c * c - s * s), -g.difference * 2 * c * s, g.zx * c;
        if (direction == LoadDirection::y)
          exact << -g.difference * 2 * c * s, g.sum + g.difference * (c * c - s * s), g.zx * s;
        double error = 0;
        for (Index n = 0; n < time.size(); ++n)
          error = std::max(error, (mu * u.col(n).segment<3>(3 * static_cast<Index>(p)) - exact).norm());
        error /= exact.norm();
        EXPECT_LT(error, 1e-6) << "nu " << nu << ", direction " << static_cast<int>(direction) << ", point "
                               << p;
        worst = std::max(worst, error);
      }
    }
  }
  test::record_verification("boussinesq-cerruti", worst);
}

}  // namespace
}  // namespace easydyn::soil

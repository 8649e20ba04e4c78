#include <gtest/gtest.h>

#include <cmath>

#include "soil/gll.hpp"
#include "soil/wave_engine.hpp"
#include "tests/soil/verification_record.hpp"

namespace easydyn::soil {
namespace {

/// Error of omega^2, relative, of a Lame mode of a free box with n x 2 x n elements of the given degree: Rayleigh
/// quotient u' K u / u' M u of its exact shape
///
///   u_x = cos(k x) sin(k z),  u_z = -sin(k x) cos(k z),  omega = sqrt(2) k c_s,  k = 2 pi / L
///
/// which strains without changing the volume and leaves all faces free of stress (Lame 1852; sigma_xz = 0
/// everywhere, sigma_xx and sigma_zz vanish where sin(k x) or sin(k z) do). The quotient errs as the square of the
/// shape's interpolation, by h^(2 N).
double frequency_error(int degree, int n) {
  const double L = 2, k = 2 * M_PI / L, density = 1800, mu = 4.05e7, lambda = 7.1e7;
  Lattice lattice;
  lattice.degree = degree;
  lattice.half_model = false;
  for (int i = 0; i <= n; ++i) {
    lattice.x.push_back(L * i / n);
    lattice.z.push_back(L * i / n - L);
  }
  lattice.y = {0, 0.4, 1.1};
  lattice.layer.assign(n, 0);
  EngineBoundary boundary;
  boundary.dashpots = false;
  WaveEngine<double> engine(lattice, {{lambda, mu, density, 0, {}}}, {}, boundary, 1);
  const GllRule rule(degree);
  const auto position = [&](const std::vector<double>& lines, int node) {
    const int e = std::min(node / degree, static_cast<int>(lines.size()) - 2);
    return lines[e] + (lines[e + 1] - lines[e]) * (rule.points(node - e * degree) + 1) / 2;
  };
  std::vector<double> u;
  double umu = 0;
  for (int c = 0; c < 3; ++c)
    for (int Z = 0; Z < engine.nodes_z(); ++Z)
      for (int Y = 0; Y < engine.nodes_y(); ++Y)
        for (int X = 0; X < engine.nodes_x(); ++X) {
          const double x = position(lattice.x, X), z = position(lattice.z, Z);
          const double value = c == 0   ? std::cos(k * x) * std::sin(k * z)
                               : c == 2 ? -std::sin(k * x) * std::cos(k * z)
                                        : 0;
          engine.set_displacement(c, X, Y, Z, value);
          u.push_back(value);
          umu += engine.mass(X, Y, Z) * value * value;
        }
  const std::vector<double> f = engine.compute_internal_force();
  double uku = 0;
  for (std::size_t p = 0; p < f.size(); ++p) uku += u[p] * f[p];
  return std::abs(uku / umu / (2 * k * k * mu / density) - 1);
}

TEST(SpectralElements, ConvergeWithTwiceTheirDegree) {
  for (const int degree : {3, 4, 5, 6}) {
    const int n = degree <= 4 ? 4 : 3;  // before rounding shows
    const double coarse = frequency_error(degree, n), fine = frequency_error(degree, 2 * n);
    std::printf("degree %d: error of omega^2 %.3e and %.3e, order %.2f\n", degree, coarse, fine,
                std::log2(coarse / fine));
    EXPECT_GT(fine, 1e-13);  // not rounding
    EXPECT_NEAR(std::log2(coarse / fine), 2 * degree, 0.3);
    test::record_verification("order-in-h", std::abs(std::log2(coarse / fine) - 2 * degree));
  }
}

TEST(SpectralElements, ConvergeExponentiallyWithTheirDegree) {
  // One wavelength over three elements: each degree more takes off at least another factor of 30, increasingly.
  double before = frequency_error(3, 3), gain = 30;
  for (const int degree : {4, 5, 6}) {
    const double error = frequency_error(degree, 3);
    std::printf("degree %d: error of omega^2 %.3e, gain %.1f\n", degree, error, before / error);
    EXPECT_GT(before / error, gain) << "degree " << degree;
    test::record_verification("order-in-degree", error / before);
    gain = before / error;
    before = error;
  }
}

}  // namespace
}  // namespace easydyn::soil

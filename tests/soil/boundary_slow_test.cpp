// What the boundary sends back, frequency by frequency: a small model against the exact motion of the layered ground. The
// table of docs/soil_boundary.md is what this prints.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>

#include "soil/layered/footprint_response.hpp"
#include "soil/wave_solver.hpp"
#include "tests/soil/verification_record.hpp"

namespace easydyn::soil {
namespace {

constexpr double pi = std::numbers::pi;
using Complex = std::complex<double>;

constexpr std::array<double, 10> frequencies{3, 5, 8, 10, 12, 14, 16, 18, 20, 30};
// Goals [dB], with a crossover of 15 Hz on both soils at all receivers.
constexpr std::array<double, 10> stated{-20, -25, -25, -35, -35, -35, -35, -35, -35, -30};
constexpr std::array<double, 3> receivers{4, 8, 16};  // [m]
// Both motions are compared times exp(-decay t): undamped layers need it, and what comes late hardly loses.
constexpr double decay = 0.5;  // [1/s]

Layer layer(double thickness, double cs) {
  Layer result;
  result.thickness = thickness;
  result.density = 1800;
  result.cs = cs;
  result.cp = 2 * cs;  // nu = 1/3
  return result;
}

Site make_site(const std::vector<Layer>& layers) {
  Site site;
  site.layers = layers;
  for (const double x : receivers) site.receivers.push_back({std::to_string(x), {x, 0, 0}});
  site.margin = 3;
  site.duration = 1.6;
  return site;
}

/// Ricker pulse of 12 Hz.
SurfaceLoads make_loads() {
  SurfaceLoads loads;
  loads.footprints = {{0, 0, 1, 1}};
  loads.time = Eigen::VectorXd::LinSpaced(501, 0, 0.5);
  loads.force.resize(501, 1);
  for (int i = 0; i < 501; ++i) {
    const double a = std::pow(pi * 12 * (loads.time(i) - 0.15), 2);
    loads.force(i, 0) = 1e4 * (1 - 2 * a) * std::exp(-a);
  }
  return loads;
}

GroundMotion compute_motion(const Site& site, const SurfaceLoads& loads, double crossover) {
  SolverOptions options;
  options.quarter_model = true;
  options.output_step = 2e-3;
  options.crossover_frequency = crossover;
  WaveSolver solver(site, loads, options);
  std::printf("  crossover %2.0f Hz: %.2f million dof, low %.2f, %ld steps\n", crossover,
              1e-6 * static_cast<double>(solver.lattice().dofs()),
              solver.low_lattice() ? 1e-6 * static_cast<double>(solver.low_lattice()->dofs()) : 0.0,
              solver.steps());
  return solver.run();
}

Complex integrate(const Eigen::VectorXd& time, const Eigen::Ref<const Eigen::VectorXd>& values, Complex i_w) {
  Complex sum = 0;
  for (Eigen::Index i = 0; i < time.size(); ++i) sum += values(i) * std::exp(-i_w * time(i));
  return sum * (time(1) - time(0));
}

class Boundary : public testing::TestWithParam<int> {};

TEST_P(Boundary, SendsBackLessThanStated) {
  const std::vector<Layer> layers =
      GetParam() == 0 ? std::vector<Layer>{layer(0, 150)} : std::vector<Layer>{layer(5, 150), layer(0, 300)};
  std::printf("%s\n", GetParam() == 0 ? "cs 150 m/s" : "5 m of cs 150 m/s on 300 m/s");
  const Site site = make_site(layers);
  const SurfaceLoads loads = make_loads();

  FootprintRequest request;
  request.length = request.width = 1;
  for (const double x : receivers) request.points.push_back({x, 0, 0});
  Eigen::VectorXcd w(frequencies.size());
  for (std::size_t f = 0; f < frequencies.size(); ++f) w(f) = Complex(2 * pi * frequencies[f], -decay);
  const FootprintResponse exact =
      compute_footprint_response(LayeredGround(site, GroundDamping::none), request, w);

  for (const double crossover : {0.0, 15.0}) {
    const GroundMotion motion = compute_motion(site, loads, crossover);
    for (Eigen::Index r = 0; r < 3; ++r) {
      std::printf("  %2.0f m:", receivers[r]);
      for (std::size_t f = 0; f < frequencies.size(); ++f) {
        const auto row = static_cast<Eigen::Index>(f);
        const Complex i_w = Complex(0, 1) * w(row), force = integrate(loads.time, loads.force.col(0), i_w),
                      x = i_w * force * exact.ux(row, r), z = i_w * force * exact.uz(row, r);
        const double back = 10 * std::log10((std::norm(integrate(motion.time, motion.vx.col(r), i_w) - x) +
                                             std::norm(integrate(motion.time, motion.vz.col(r), i_w) - z)) /
                                            (std::norm(x) + std::norm(z)));
        std::printf(" %6.1f", back);
        if (crossover > 0)
          test::record_verification((GetParam() == 0 ? "boundary-half-space-" : "boundary-layered-") +
                                        std::to_string(static_cast<int>(frequencies[f])),
                                    back);
        if (crossover > 0) {
          EXPECT_LT(back, stated[f]) << frequencies[f] << " Hz, receiver " << r;
        }
      }
      std::printf(" dB\n");
    }
  }
}

INSTANTIATE_TEST_SUITE_P(OnTwoSoils, Boundary, testing::Values(0, 1));

}  // namespace
}  // namespace easydyn::soil

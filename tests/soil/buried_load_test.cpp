// A load below the surface by reciprocity: finite elements push the surface and watch a point below, the layered
// half-space pushes that point and watches the surface.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "soil/layered/footprint_response.hpp"
#include "soil/wave_solver.hpp"
#include "tests/soil/layered_comparison.hpp"
#include "tests/soil/verification_record.hpp"
#include "tests/soil/warped_response.hpp"

namespace easydyn::soil {
namespace {

using Complex = std::complex<double>;

TEST(BuriedLoad, MovesTheSurfaceAsTheSurfaceLoadMovesItsPlace) {
  constexpr std::array<double, 2> there{4.8, 3.6};
  constexpr std::array<double, 2> depths{2, 6.5};               // in each layer
  constexpr std::array<double, 4> frequencies{12, 20, 30, 40};  // below, the boundary adds 1 to 3 %
  Site site;
  site.layers = {test::damped_layer(4, 150), test::damped_layer(0, 300)};
  for (const double depth : depths) site.receivers.push_back({"below", {there[0], there[1], -depth}});
  site.highest_frequency = 50;
  site.margin = 6;
  site.duration = 0.8;
  SurfaceLoads loads;
  loads.footprints = {{0, 0, 0.1, 0.1}};
  const test::Ricker pulse{20, 1.3 / 20};
  loads.time = Eigen::VectorXd::LinSpaced(301, 0, 0.3);
  loads.force = 1e4 * loads.time.unaryExpr(pulse);
  SolverOptions options;
  options.quarter_model = true;
  options.output_step = 2e-3;

  /// Finite elements, [direction of the load: down, x][receiver][frequency], components x, z.
  std::array<std::array<std::array<std::array<Complex, 2>, 4>, 2>, 2> computed;
  for (const int direction : {0, 1}) {
    loads.footprints[0].direction = direction == 0 ? LoadDirection::down : LoadDirection::x;
    WaveSolver solver(site, loads, options);
    std::printf("%.2f million dof, %ld steps\n", 1e-6 * static_cast<double>(solver.lattice().dofs()),
                solver.steps());
    const GroundMotion motion = solver.run();
    for (int r = 0; r < 2; ++r)
      for (std::size_t f = 0; f < frequencies.size(); ++f)
        for (const int c : {0, 1})
          computed[direction][r][f][c] = test::compute_warped_response(
              motion.time, (c == 0 ? motion.vx : motion.vz).col(r),
              [&](double w) { return 1e4 * pulse.transform(w); }, solver.time_step(),
              2 * std::numbers::pi * frequencies[f]);
  }

  const LayeredGround ground(site, GroundDamping::maxwell_body);
  Eigen::VectorXcd w(4);
  for (Eigen::Index f = 0; f < 4; ++f) w(f) = 2 * std::numbers::pi * frequencies[static_cast<std::size_t>(f)];
  double worst = 0;
  for (int r = 0; r < 2; ++r) {
    FootprintRequest request;
    request.source_depth = depths[r];
    request.points = {{-there[0], -there[1], 0}};
    request.direction = LoadDirection::down;
    const FootprintResponse down = compute_footprint_response(ground, request, w);
    request.direction = LoadDirection::x;
    const FootprintResponse along = compute_footprint_response(ground, request, w);
    for (int f = 0; f < 4; ++f) {
      // Motion at B along b by a force at A along a = motion at A along a by a force at B along b; down is -z.
      const Complex expected[2][2] = {{-along.uz(f, 0), down.uz(f, 0)}, {along.ux(f, 0), -down.ux(f, 0)}};
      const double size = std::max({std::abs(expected[0][0]), std::abs(expected[0][1]),
                                    std::abs(expected[1][0]), std::abs(expected[1][1])});
      for (const int direction : {0, 1})
        for (const int c : {0, 1}) {
          const double error = std::abs(computed[direction][r][f][c] - expected[direction][c]) / size;
          std::printf("depth %.1f m, %2.0f Hz, load %s, motion along %s: %.4f\n", depths[r], frequencies[f],
                      direction == 0 ? "down" : "along x", c == 0 ? "x" : "z", error);
          EXPECT_LT(error, 0.01);
          worst = std::max(worst, error);
        }
    }
  }
  test::record_verification("buried-load", 100 * worst);
}

}  // namespace
}  // namespace easydyn::soil

// Lamb's problem for three Poisson ratios, the leapfrog's time error taken off by evaluating at warped frequencies.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "soil/wave_solver.hpp"
#include "tests/reference/lamb.hpp"
#include "tests/soil/verification_record.hpp"
#include "tests/soil/warped_response.hpp"

namespace easydyn::soil {
namespace {

using Complex = std::complex<double>;
constexpr double pi = std::numbers::pi;

/// Velocity at the times of the record, without the time error of the leapfrog.
Eigen::VectorXd remove_time_error(const Eigen::VectorXd& time, const Eigen::VectorXd& velocity,
                                  const test::Ricker& pulse, double dt) {
  const double df = 1.0, highest = 3.5 * pulse.f0;  // period 1 s; the pulse has 1e-4 of its peak at 3.5 f0
  Eigen::VectorXd result = Eigen::VectorXd::Zero(time.size());
  for (double f = df; f < highest; f += df) {
    const double W = 2 * pi * f;
    const Complex line = test::compute_warped_response(
                             time, velocity, [&](double w) { return pulse.transform(w); }, dt, W) *
                         Complex(0, W) * pulse.transform(W) * 2.0 * df;
    for (Eigen::Index i = 0; i < time.size(); ++i) result(i) += (line * std::polar(1.0, W * time(i))).real();
  }
  return result;
}

TEST(LambsProblem, IsSolvedWithinOnePercentAtWarpedFrequenciesForThreePoissonRatios) {
  // Degree 4, 7.5 points per wavelength, the default time step; 5, 10, 20 m, vertical and radial, whole record, L2.
  for (const double nu : {0.25, 0.35, 0.45}) {
    const double cs = 150, density = 1800;
    const test::Ricker pulse{20, 1.3 / 20};
    Site site;
    Layer ground;
    ground.density = density;
    ground.cs = cs;
    ground.cp = cs * std::sqrt((2 - 2 * nu) / (1 - 2 * nu));
    site.layers = {ground};
    const double distance[3] = {5, 10, 20};
    for (const double r : distance) site.receivers.push_back({"r", {0.8 * r, 0.6 * r, 0}});
    site.highest_frequency = 2.5 * pulse.f0;
    site.points_per_wavelength = 7.5;
    site.margin = 6;  // the boundary's share: docs/soil_boundary.md
    site.duration = 0.32;
    SurfaceLoads loads;
    loads.footprints = {{0, 0, 0.02, 0.02}};
    loads.time = Eigen::VectorXd::LinSpaced(321, 0, 0.32);
    loads.force = 1e4 * loads.time.unaryExpr(pulse);
    SolverOptions options;
    options.output_step = 1e-3;
    options.quarter_model = true;
    WaveSolver solver(site, loads, options);
    const GroundMotion motion = solver.run();

    const reference::Lamb lamb(nu);
    const double h = 1e-4;
    const auto second = [&](double t) { return (pulse(t + h) - 2 * pulse(t) + pulse(t - h)) / (h * h); };
    double worst = 0;
    for (int k = 0; k < 3; ++k) {
      const double r = distance[k], scale = 1e4 / (density * cs * cs * r);
      for (const bool is_vertical : {true, false}) {
        const Eigen::VectorXd computed =
            is_vertical ? motion.vz.col(k).eval() : (0.8 * motion.vx.col(k) + 0.6 * motion.vy.col(k)).eval();
        Eigen::VectorXd exact(computed.size());
        for (Eigen::Index i = 0; i < exact.size(); ++i)
          exact(i) = (is_vertical ? -scale : scale) *
                     lamb.convolve(is_vertical, second, 0, 2 * pulse.delay, motion.time(i), r, cs);
        const double plain = (computed - exact).norm() / exact.norm();
        const double error =
            (remove_time_error(motion.time, computed, pulse, solver.time_step()) - exact).norm() /
            exact.norm();
        std::printf("nu %.2f, %2.0f m, %s: %.4f, with the time error %.4f\n", nu, r,
                    is_vertical ? "vertical" : "radial", error, plain);
        EXPECT_LT(error, 0.01) << "nu " << nu << ", " << r << " m, vertical " << is_vertical;
        worst = std::max(worst, error);
      }
    }
    test::record_verification("lamb-degree-4", 100 * worst);
    std::printf("%ld dof, %ld steps of %.3g s\n", solver.lattice().dofs(), solver.steps(),
                solver.time_step());
  }
}

}  // namespace
}  // namespace easydyn::soil

#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "soil/layered/layered_prediction.hpp"
#include "soil/prediction.hpp"
#include "tests/soil/warped_response.hpp"

namespace easydyn::soil::test {

/// nu 0.33, 1800 kg/m3, damping 3 %.
inline Layer damped_layer(double thickness, double cs) {
  Layer layer;
  layer.thickness = thickness;
  layer.density = 1800;
  layer.cs = cs;
  layer.cp = cs * std::sqrt((2 - 2 * 0.33) / (1 - 2 * 0.33));
  layer.damping = 0.03;
  return layer;
}

/// Finite elements (defaults, quarter model, crossover) against the layered half-space at distances off both axes, under a Ricker
/// pulse of 0.4 x highest_frequency on 1 m x 1 m: the largest of the L2 errors of the three components over the
/// whole record, one per distance.
inline std::vector<double> compare_with_layered_half_space(Site site, const std::vector<double>& distances,
                                                           double crossover) {
  const Ricker pulse{0.4 * site.highest_frequency, 3.25 / site.highest_frequency};
  site.damping_frequency = pulse.f0;
  site.taper_length = 0;
  for (const double r : distances) site.receivers.push_back({"r", {0.8 * r, 0.6 * r, 0}});
  SurfaceLoads loads;
  loads.footprints = {{0, 0, 1, 1}};
  const auto samples = static_cast<Eigen::Index>(1e3 * site.duration) + 1;
  loads.time = Eigen::VectorXd::LinSpaced(samples, 0, 1e-3 * static_cast<double>(samples - 1));
  loads.force = 1e4 * loads.time.unaryExpr(pulse);
  SolverOptions options;
  options.quarter_model = true;
  options.crossover_frequency = crossover;
  WaveSolver solver = make_solver(site, loads, options);
  Vibrations vibrations = predict_vibrations(site, loads, solver, nullptr);
  vibrations.semi_analytical = compute_semi_analytical_motion(site, loads, GroundDamping::maxwell_body);
  std::vector<double> worst;
  std::printf("%.2f million dof, %ld steps\n", 1e-6 * static_cast<double>(solver.lattice().dofs()),
              solver.steps());
  for (const MotionDifference& d : compare_with_semi_analytical(vibrations)) {
    std::printf("L2 of v_x, v_y, v_z: %.4f %.4f %.4f\n", d.l2[0], d.l2[1], d.l2[2]);
    worst.push_back(std::max({d.l2[0], d.l2[1], d.l2[2]}));
  }
  return worst;
}

}  // namespace easydyn::soil::test

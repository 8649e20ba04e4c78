#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "soil/wave_solver.hpp"
#include "tests/reference/lamb.hpp"

namespace easydyn::soil::test {

struct Errors {
  double vertical[3], radial[3];
};

inline double worst_of(const Errors& errors) {
  return std::max(*std::max_element(errors.vertical, errors.vertical + 3),
                  *std::max_element(errors.radial, errors.radial + 3));
}

/// Ricker force on a small footprint of a homogeneous half-space; relative L2 error of the velocity over the
/// whole record at 5, 10 and 20 m.
inline Errors compare_with_lamb(double nu, double f0, double points, double safety, int degree = 4,
                                double crossover = 0) {
  Site site;
  Layer ground;
  ground.density = 1800;
  ground.cs = 150;
  ground.cp = 150 * std::sqrt((2 - 2 * nu) / (1 - 2 * nu));
  site.layers = {ground};
  const double distance[3] = {5, 10, 20};
  // Along the diagonal, where the receivers coincide with no node and both horizontal components matter.
  for (const double r : distance) site.receivers.push_back({"r", {0.8 * r, 0.6 * r, 0}});
  site.highest_frequency = 2.5 * f0;
  site.points_per_wavelength = points;
  site.duration = 0.3;
  const double delay = 1.3 / f0;
  const auto ricker = [&](double t) {
    const double a = std::pow(M_PI * f0 * (t - delay), 2);
    return (1 - 2 * a) * std::exp(-a);
  };
  SurfaceLoads loads;
  loads.footprints = {{0, 0, 0.02, 0.02}};
  const int nt = 301;
  loads.time = Eigen::VectorXd::LinSpaced(nt, 0, 0.3);
  loads.force.resize(nt, 1);
  for (int i = 0; i < nt; ++i) loads.force(i, 0) = 1e4 * ricker(loads.time(i));
  SolverOptions options;
  options.output_step = 1e-3;
  options.step_safety = safety;
  options.degree = degree;
  options.crossover_frequency = crossover;
  WaveSolver solver(site, loads, options);
  const GroundMotion motion = solver.run();

  const reference::Lamb lamb(nu);
  const double mu = 1800 * 150.0 * 150, h = 1e-4;
  const auto second = [&](double t) { return (ricker(t + h) - 2 * ricker(t) + ricker(t - h)) / (h * h); };
  Errors errors{};
  for (int k = 0; k < 3; ++k) {
    double difference[2] = {0, 0}, norm[2] = {0, 0};
    for (Eigen::Index i = 0; i < motion.time.size(); ++i) {
      const double t = motion.time(i), scale = 1e4 / (mu * distance[k]);
      const double vertical = -scale * lamb.convolve(true, second, 0, 2 * delay, t, distance[k], 150);
      const double radial = scale * lamb.convolve(false, second, 0, 2 * delay, t, distance[k], 150);
      const double computed[2] = {motion.vz(i, k), 0.8 * motion.vx(i, k) + 0.6 * motion.vy(i, k)};
      difference[0] += std::pow(computed[0] - vertical, 2);
      difference[1] += std::pow(computed[1] - radial, 2);
      norm[0] += vertical * vertical;
      norm[1] += radial * radial;
    }
    errors.vertical[k] = std::sqrt(difference[0] / norm[0]);
    errors.radial[k] = std::sqrt(difference[1] / norm[1]);
  }
  std::printf(
      "nu %.2f, degree %d, crossover %.0f Hz: dt %.3g s, %ld dof, %ld steps: vertical %.4f %.4f %.4f radial "
      "%.4f %.4f %.4f\n",
      nu, degree, crossover, solver.time_step(), solver.lattice().dofs(), solver.steps(), errors.vertical[0],
      errors.vertical[1], errors.vertical[2], errors.radial[0], errors.radial[1], errors.radial[2]);
  return errors;
}

}  // namespace easydyn::soil::test

#pragma once

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "soil/wave_solver.hpp"

namespace easydyn::soil::test {

/// Small coarse layered site: 1 m of 100 m/s on 200 m/s, 20 Hz, damped, one receiver on the surface and one below.
inline Site small_site() {
  Site site;
  Layer top;
  top.name = "top";
  top.thickness = 1;
  top.density = 1800;
  top.cs = 100;
  top.cp = 200;
  top.damping = 0.03;
  Layer bottom = top;
  bottom.name = "bottom";
  bottom.cs = 200;
  bottom.cp = 400;
  site.layers = {top, bottom};
  site.receivers = {{"near", {1.3, 2.1, 0}}, {"deep", {-0.7, 3.2, -0.8}}};
  site.highest_frequency = 20;
  site.points_per_wavelength = 4;
  site.margin = 1;
  site.taper_length = 0;
  site.duration = 0.15;
  return site;
}

/// sin^2 pulse of 0.1 s on one footprint on the axis.
inline SurfaceLoads small_loads() {
  SurfaceLoads loads;
  loads.footprints = {{0.2, 0, 0.6, 2.4}};
  loads.time = Eigen::VectorXd::LinSpaced(101, 0, 0.1);
  loads.force = 1e4 * (std::numbers::pi * loads.time.array() / 0.1).sin().square().matrix();
  return loads;
}

inline SolverOptions small_options() {
  SolverOptions options;
  options.degree = 3;
  options.sponge_elements = 3;
  options.output_step = 2e-3;
  options.threads = 2;
  return options;
}

}  // namespace easydyn::soil::test

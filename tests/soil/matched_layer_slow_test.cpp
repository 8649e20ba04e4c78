// Whether anything grows in a matched layer: a load that is held for 20 s.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "soil/rheology.hpp"
#include "soil/wave_engine.hpp"
#include "soil/wave_solver.hpp"

namespace easydyn::soil {
namespace {

struct Ground {
  std::string name;
  std::vector<Layer> layers;
};

Layer layer(double thickness, double cs, double nu) {
  Layer result;
  result.thickness = thickness;
  result.density = 1800;
  result.cs = cs;
  result.cp = cs * std::sqrt((2 - 2 * nu) / (1 - 2 * nu));
  return result;
}

std::vector<Ground> make_grounds() {
  return {{"cs 150 m/s, nu 1/3", {layer(0, 150, 1.0 / 3)}},
          {"5 m of 150 m/s on 300 m/s", {layer(5, 150, 1.0 / 3), layer(0, 300, 1.0 / 3)}},
          {"cs 150 m/s, nu 0.45", {layer(0, 150, 0.45)}}};
}

template <class T>
double largest_velocity(const WaveEngine<T>& engine) {
  double largest = 0;
  for (int c = 0; c < 3; ++c)
    for (int Z = 0; Z < engine.nodes_z(); ++Z)
      for (int Y = 0; Y < engine.nodes_y(); ++Y)
        for (int X = 0; X < engine.nodes_x(); ++X) {
          const double v = std::abs(engine.velocity(c, X, Y, Z));
          if (!(v <= largest)) largest = v;  // what is not a number stays
        }
  return largest;
}

class HeldLoad : public testing::TestWithParam<int> {};

/// 10 kN, brought in within 0.2 s and held, on a node of a quarter model.
template <class T>
void expect_decay(const Ground& ground) {
  Site site;
  site.layers = ground.layers;
  site.receivers = {{"near", {2, 2, 0}}};
  site.highest_frequency = 25;
  site.margin = 1;
  LatticeOptions options;
  options.quarter_model = true;
  options.sponge_elements = 4;
  options.lanes = 1;
  const Lattice lattice = make_lattice(site, {{0, 0, 1, 1}}, options);
  EngineBoundary boundary;
  boundary.absorber = AbsorbingBoundary::matched_layer;
  boundary.layer_speed = ground.layers.back().cp;
  WaveEngine<T> engine(lattice, make_rheology(site, DampingModel::none).materials, {}, boundary, 1);
  const double dt = 0.95 * engine.compute_stable_step();
  engine.set_time_step(dt);
  double top = 0;
  std::array<double, 4> largest{};  // of any node in the last second before 5, 10, 15, 20 s
  long step = 0;
  for (double t = 0; t < 20; t = static_cast<double>(++step) * dt) {
    const double ramp = std::min(1.0, t / 0.2);
    engine.advance({{0, 0, -2500 * std::pow(std::sin(M_PI / 2 * ramp), 2), 2}}, false);  // a quarter of it
    const auto part = static_cast<std::size_t>(t / 5);
    if (step % 10 != 0 || (t > 0.5 && t < 5 * static_cast<double>(part) + 4)) continue;
    double& value = t < 0.5 ? top : largest[part];
    value = std::max(value, largest_velocity(engine));
  }
  std::printf(
      "%s, %s precision: %d x %d x %d elements, %ld steps; top %.1e, before 5, 10, 15, 20 s: %.1e %.1e %.1e "
      "%.1e m/s\n",
      ground.name.c_str(), sizeof(T) == 8 ? "double" : "single", lattice.nx(), lattice.ny(), lattice.nz(),
      step, top, largest[0], largest[1], largest[2], largest[3]);
  std::fflush(stdout);
  // Strong layers grow thirtyfold in 5 s and more (docs/soil_boundary.md); what rings on in undamped ground does not.
  EXPECT_LT(largest[0], 1e-2 * top);
  EXPECT_LE(largest[3], largest[0]);
}

TEST_P(HeldLoad, DoesNotGrowInAMatchedLayer) {
  const Ground ground = make_grounds()[static_cast<std::size_t>(GetParam())];
  expect_decay<float>(ground);
  expect_decay<double>(ground);
}

INSTANTIATE_TEST_SUITE_P(OnThreeGrounds, HeldLoad, testing::Range(0, 3));

}  // namespace
}  // namespace easydyn::soil

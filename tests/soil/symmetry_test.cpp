// Quarter, half and full model; loads along x, y and down; symmetric and antisymmetric planes.

#include <gmock/gmock.h>

#include <cmath>

#include "easydyn/error.hpp"
#include "soil/wave_engine.hpp"
#include "soil/wave_solver.hpp"

namespace easydyn::soil {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(QuarterOfTheLattice, MovesAsTheWholeUnderALoadAtTheOriginInAnyDirection) {
  // Sponge, dashpots, springs, memory variables and a block, all symmetric; displacements and energy.
  Lattice whole;
  whole.degree = 4;
  whole.half_model = false;
  whole.x = {-3.4, -2.0, -0.9, 0.0, 0.9, 2.0, 3.4};
  whole.y = {-2.9, -1.5, -0.7, 0.0, 0.7, 1.5, 2.9};
  whole.z = {-3.0, -1.7, -0.9, 0.0};
  whole.layer = {1, 1, 0};
  whole.sponge_x = {1, 1};
  whole.sponge_y = {1, 1};
  whole.sponge_z = {1, 0};
  whole.blocks = {{{1, 5}, {2, 4}, {1, 2}, 2}};
  Lattice quarter = whole;
  quarter.half_model = quarter.quarter_model = true;
  quarter.x.erase(quarter.x.begin(), quarter.x.begin() + 3);
  quarter.y.erase(quarter.y.begin(), quarter.y.begin() + 3);
  quarter.sponge_x = quarter.sponge_y = {0, 1};
  quarter.blocks = {{{0, 2}, {0, 1}, {1, 2}, 2}};
  const std::vector<EngineMaterial> materials{{2.3e7, 1.1e7, 1800, 0, {0.02, 0.03}},
                                              {9.1e7, 2.7e7, 2000, 0, {0.01, 0.02}},
                                              {3e7, 5e7, 2300, 0, {0.03, 0}}};
  const std::vector<double> rates{60, 400};
  for (int component = 0; component < 3; ++component) {
    EngineBoundary boundary;
    boundary.sponge_speed = 100;
    WaveEngine<double> all(whole, materials, rates, boundary, 2);
    boundary.odd_x = component == 0;
    boundary.odd_y = component == 1;
    WaveEngine<double> one(quarter, materials, rates, boundary, 2);
    all.set_time_step(1e-4);
    one.set_time_step(1e-4);
    for (int step = 0; step < 200; ++step) {
      const double force = step < 60 ? 1e3 * std::sin(M_PI * step / 60) : 0.0;
      // A node on both planes, one on each, one off them; those off a plane with their mirror images.
      std::vector<SurfaceNodeForce> forces{{0, 0, force / 4, component},
                                           {2, 0, force / 2, component},
                                           {0, 3, force / 2, component},
                                           {2, 3, force, component}};
      one.advance(forces, step == 199);
      forces.clear();
      for (const int X : {-2, 0, 2})
        for (const int Y : {-3, 0, 3}) forces.push_back({12 + X, 12 + Y, force, component});
      all.advance(forces, step == 199);
    }
    double difference = 0, largest = 0;
    for (int c = 0; c < 3; ++c)
      for (int X = 0; X < one.nodes_x(); ++X)
        for (int Y = 0; Y < one.nodes_y(); ++Y)
          for (int Z = 0; Z < one.nodes_z(); ++Z) {
            const double expected = all.displacement(c, X + 12, Y + 12, Z);
            difference = std::max(difference, std::abs(one.displacement(c, X, Y, Z) - expected));
            largest = std::max(largest, std::abs(expected));
          }
    EXPECT_LT(difference, 1e-12 * largest) << "force along " << component;
    EXPECT_NEAR(4 * one.energy(), all.energy(), 1e-11 * all.energy()) << "force along " << component;
    EXPECT_GT(one.compute_stable_step(), 0.98 * all.compute_stable_step());
  }
}

Site small_site() {
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
  for (const double sx : {1.0, -1.0})
    for (const double sy : {1.0, -1.0}) {
      site.receivers.push_back({"near", {sx * 2.4, sy * 2.1, 0}});
      site.receivers.push_back({"deep", {sx * 0.7, sy * 3.2, -0.8}});
    }
  site.highest_frequency = 20;
  site.points_per_wavelength = 4;
  site.margin = 0.5;
  site.taper_length = 0;
  site.duration = 0.12;
  return site;
}

SurfaceLoads pulse(std::vector<Footprint> footprints) {
  SurfaceLoads loads;
  loads.footprints = std::move(footprints);
  loads.time = Eigen::VectorXd::LinSpaced(101, 0, 0.1);
  loads.force.resize(101, static_cast<Eigen::Index>(loads.footprints.size()));
  for (int i = 0; i < 101; ++i) loads.force.row(i).setConstant(1e4 * std::pow(std::sin(M_PI * i / 100.0), 2));
  return loads;
}

SolverOptions small_options() {
  SolverOptions options;
  options.degree = 3;
  options.sponge_elements =
      0;  // the sponge along x is adapted to the vector length: not the same in all models
  options.double_precision = true;
  options.output_step = 2e-3;
  return options;
}

double relative_difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

TEST(QuarterModel, GivesTheMotionOfTheFullOneAtAllReceivers) {
  const Site site = small_site();
  for (const LoadDirection direction : {LoadDirection::down, LoadDirection::x, LoadDirection::y}) {
    const SurfaceLoads loads = pulse({{0, 0, 0.6, 2.4, direction}});
    SolverOptions options = small_options();
    options.half_model = false;
    WaveSolver full_solver(site, loads, options);
    ASSERT_EQ(full_solver.lattice().nx() % 2, 0);  // else the lattices do not match
    ASSERT_EQ(full_solver.lattice().ny() % 2, 0);
    const GroundMotion full = full_solver.run();
    options.half_model = true;
    const GroundMotion half = WaveSolver(site, loads, options).run();
    options.quarter_model = true;
    const GroundMotion quarter = WaveSolver(site, loads, options).run();
    for (const auto& [share, motion] : {std::pair{2, &half}, {4, &quarter}}) {
      EXPECT_LT(relative_difference(motion->vx, full.vx), 1e-10);
      EXPECT_LT(relative_difference(motion->vy, full.vy), 1e-10);
      EXPECT_LT(relative_difference(motion->vz, full.vz), 1e-10);
      EXPECT_LT(relative_difference(motion->footprint_displacement, full.footprint_displacement), 1e-10);
      EXPECT_LT(relative_difference(share * motion->energy, full.energy), 1e-10);
    }
    EXPECT_GT(full.footprint_displacement.mean(), 0);  // along the load
  }
}

TEST(QuarterModel, ShowsFootprintsWithoutALoad) {
  // As footprints under no force in the full model: the loaded one, two that cross the plane x = 0, some behind it. Their
  // middle is the origin, from which the far-field springs count.
  const Site site = small_site();
  SurfaceLoads loads = pulse({{0, 0, 0.6, 2.4},
                              {0.9, 0, 0.6, 2.4},
                              {-0.9, 0, 0.6, 2.4},
                              {0.1, 0, 0.6, 2.4},
                              {-0.1, 0, 0.6, 2.4},
                              {-0.9, 1.5, 0.6, 1.2},
                              {0.9, -1.5, 0.6, 1.2}});
  loads.force.rightCols(6).setZero();
  SolverOptions options = small_options();
  options.half_model = false;
  const GroundMotion full = WaveSolver(site, loads, options).run();
  options.quarter_model = true;
  options.observed = loads.footprints;
  const GroundMotion quarter = WaveSolver(site, pulse({{0, 0, 0.6, 2.4}}), options).run();
  ASSERT_EQ(quarter.footprint_displacement.cols(), 8);
  EXPECT_LT(relative_difference(quarter.footprint_displacement.rightCols(7), full.footprint_displacement),
            1e-10);
  EXPECT_LT(relative_difference(quarter.footprint_displacement.col(1), quarter.footprint_displacement.col(0)),
            1e-14);
  EXPECT_GT(full.footprint_displacement.col(5).norm(), 0.01 * full.footprint_displacement.col(0).norm());

  options.observed = {{30, 0, 0.6, 2.4}};  // the lattice reaches as far
  EXPECT_GE(WaveSolver(site, pulse({{0, 0, 0.6, 2.4}}), options).lattice().interior_x()[1], 30.3);
  EXPECT_THAT(
      [&] {
        WaveSolver(site, pulse({{0, 0, 0.6, 2.4, LoadDirection::x}}), options);
      },
      ThrowsMessage<ModelError>(HasSubstr("observed under a horizontal load")));
}

TEST(HalfModel, RefusesLoadsOfBothKinds) {
  const Site site = small_site();
  const SurfaceLoads loads = pulse({{-1, 0, 0.6, 2.4}, {1, 0, 0.6, 2.4, LoadDirection::y}});
  EXPECT_THAT([&] { WaveSolver(site, loads, small_options()); },
              ThrowsMessage<ModelError>(AllOf(HasSubstr("footprint 2"), HasSubstr("along y"),
                                              HasSubstr("half model"), HasSubstr("--full-model"))));
  SolverOptions full = small_options();
  full.half_model = false;
  EXPECT_NO_THROW(WaveSolver(site, loads, full));
  // Along x and down are both symmetric about y = 0.
  EXPECT_NO_THROW(
      WaveSolver(site, pulse({{-1, 0, 0.6, 2.4}, {1, 0, 0.6, 2.4, LoadDirection::x}}), small_options()));
}

TEST(QuarterModel, RefusesALoadOffTheOriginAndABlockOnOneSide) {
  Site site = small_site();
  SolverOptions options = small_options();
  options.quarter_model = true;
  EXPECT_THAT(
      [&] {
        WaveSolver(site, pulse({{0.4, 0, 0.6, 2.4}}), options);
      },
      ThrowsMessage<ModelError>(
          AllOf(HasSubstr("footprint 1"), HasSubstr("x = 0.4 m"), HasSubstr("quarter model"))));
  Block block;
  block.name = "slab";
  block.x = {-1, 2};
  block.z = {-1, -0.5};
  block.open = true;
  site.blocks = {block};
  EXPECT_THAT(
      [&] {
        WaveSolver(site, pulse({{0, 0, 0.6, 2.4}}), options);
      },
      ThrowsMessage<ModelError>(
          AllOf(HasSubstr("slab"), HasSubstr("x = -1..2 m"), HasSubstr("quarter model"))));
}

TEST(HorizontalLoad, MovesTheGroundItsOwnWay) {
  // By symmetry: a load along x moves the ground at (x, y) and (-x, y) alike along x, oppositely along z; loads
  // along x and y on a square patch are each other's image under a quarter turn.
  Site site = small_site();
  site.receivers = {{"ahead", {2, 0, 0}}, {"behind", {-2, 0, 0}}, {"left", {0, 2, 0}}, {"right", {0, -2, 0}}};
  SolverOptions options = small_options();
  options.half_model = false;
  const GroundMotion x = WaveSolver(site, pulse({{0, 0, 1, 1, LoadDirection::x}}), options).run();
  const GroundMotion y = WaveSolver(site, pulse({{0, 0, 1, 1, LoadDirection::y}}), options).run();
  EXPECT_LT(relative_difference(x.vx.col(1), x.vx.col(0)), 1e-10);
  EXPECT_LT(relative_difference(-x.vz.col(1), x.vz.col(0)), 1e-10);
  EXPECT_LT(x.vy.col(0).cwiseAbs().maxCoeff(), 1e-10 * x.vx.col(0).cwiseAbs().maxCoeff());
  // The model is 2.5 m wide to the right and the left, as it is to the front and the back.
  EXPECT_LT(relative_difference(y.vy.col(2), x.vx.col(0)), 1e-10);
  EXPECT_LT(relative_difference(y.vz.col(2), x.vz.col(0)), 1e-10);
}

}  // namespace
}  // namespace easydyn::soil

// Blocks of other material and of air: operator, masses, motion, and what the solver makes of them.

#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "easydyn/error.hpp"
#include "soil/wave_solver.hpp"
#include "tests/soil/reference_operator.hpp"

namespace easydyn::soil {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// Uneven lattice of 5 x 3 x 4 elements on two layers.
Lattice small_lattice(int degree) {
  Lattice lattice;
  lattice.degree = degree;
  lattice.half_model = false;
  lattice.x = {-2.0, -0.8, 0.1, 1.5, 2.2, 3.4};
  lattice.y = {-1.1, 0.3, 1.0, 2.4};
  lattice.z = {-3.0, -1.7, -0.9, -0.4, 0.0};
  lattice.layer = {1, 1, 0, 0};
  return lattice;
}

/// Two layers, then a soft and a stiff block with damping of their own.
std::vector<EngineMaterial> materials() {
  return {{2.3e7, 1.1e7, 1800, 1e-4, {0.02, 0.03}},
          {9.1e7, 2.7e7, 2000, 2e-4, {0.01, 0.02}},
          {1.2e7, 0.4e7, 1500, 4e-4, {0.05, 0.01}},
          {3.2e8, 1.9e8, 2400, 5e-5, {0.004, 0.005}}};
}

const std::vector<double> rates{60, 400};

EngineBoundary free_boundary() {
  EngineBoundary boundary;
  boundary.sponge_speed = 0;
  boundary.dashpots = false;
  return boundary;
}

template <class T>
double error_against_reference(const Lattice& lattice, int threads) {
  std::vector<EngineMaterial> elastic = materials();
  for (EngineMaterial& m : elastic) m.beta = 0;
  WaveEngine<T> engine(lattice, elastic, {}, free_boundary(), threads);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<double> u;
  for (int c = 0; c < 3; ++c)
    for (int Z = 0; Z < engine.nodes_z(); ++Z)
      for (int Y = 0; Y < engine.nodes_y(); ++Y)
        for (int X = 0; X < engine.nodes_x(); ++X) {
          engine.set_displacement(c, X, Y, Z, uniform(random));
          u.push_back(engine.displacement(c, X, Y, Z));
        }
  const auto f = engine.compute_internal_force();
  const auto expected = test::compute_reference_force(lattice, elastic, u);
  double difference = 0, largest = 0;
  for (std::size_t p = 0; p < f.size(); ++p) {
    difference = std::max(difference, std::abs(f[p] - expected[p]));
    largest = std::max(largest, std::abs(expected[p]));
  }
  return difference / largest;
}

template <class T>
void expect_memory_as_estimated(const Lattice& lattice, int threads) {
  const WaveEngine<T> engine(lattice, materials(), rates, free_boundary(), threads);
  const Partition alone(lattice.ny(), lattice.nz(), lattice.degree, 1);
  EXPECT_EQ(engine.table_memory(), WaveEngine<T>::compute_table_memory(lattice, alone, 0, threads))
      << threads;
}

TEST(MemoryOfTheTables, IsEstimatedToTheByte) {
  Lattice lattice = small_lattice(4);
  const auto estimate = [&](int threads) {
    return WaveEngine<float>::compute_table_memory(lattice, Partition(3, 4, 4, 1), 0, threads);
  };
  for (const bool has_blocks : {false, true}) {
    const double before = estimate(2);
    // The second one is of the layer's own material: no rows of it, but lines.
    if (has_blocks) lattice.blocks = {{{1, 3}, {1, 3}, {2, 4}, 2}, {{4, 5}, {0, 1}, {0, 1}, 1}};
    for (const int threads : {1, 2, 3, 5}) {  // the last: no more than rows
      expect_memory_as_estimated<float>(lattice, threads);
      expect_memory_as_estimated<double>(lattice, threads);
    }
    if (!has_blocks) continue;
    // Four rows of ten tables, 9 x 9 and 5 x 5 lines of 2 x 4 tables, three tables along x; then the numbers of 12 rows
    // and 13 x 17 lines.
    const double stride = 16;  // of five elements and two more, in packs of at most sixteen
    const double fewest = 8, tables = 3 + 4 * 10 + 8 * (81 + 25), numbers = 12 + 13 * 17;
    EXPECT_GE(estimate(2) - before, 4 * (fewest * tables + numbers));
    EXPECT_LE(estimate(2) - before, 4 * (stride * tables + numbers));
  }
  // A second thread adds seams: 2 parts of each of 17 lines of 3 x 4 x stride values.
  EXPECT_GE(estimate(2) - estimate(1), 4 * 2 * 17 * 3 * 4 * 8.0);
}

TEST(Block, HasTheOperatorOfTheTextbook) {
  for (const int degree : {3, 4, 5, 6}) {
    Lattice lattice = small_lattice(degree);
    lattice.blocks = {{{0, 2}, {1, 3}, {1, 3}, 2}, {{1, 4}, {1, 2}, {2, 4}, 3}, {{3, 4}, {0, 2}, {3, 4}, -1}};
    for (const int threads : {1, 2, 3})
      EXPECT_LT(error_against_reference<double>(lattice, threads), 1e-13) << "degree " << degree;
    EXPECT_LT(error_against_reference<float>(lattice, 1), 1e-5) << "degree " << degree;
  }
  // Several packs of elements along x, blocks at both ends and across the border of packs.
  for (const int nx : {16, 17, 31, 33}) {
    Lattice lattice = small_lattice(3);
    while (lattice.nx() < nx) lattice.x.push_back(lattice.x.back() + 0.7 + 0.1 * std::sin(lattice.nx()));
    lattice.blocks = {
        {{0, 1}, {0, 1}, {3, 4}, 3}, {{5, 17}, {1, 2}, {2, 4}, 2}, {{nx - 2, nx}, {1, 3}, {0, 2}, 3}};
    EXPECT_LT(error_against_reference<double>(lattice, 1), 1e-13) << nx << " elements";
    EXPECT_LT(error_against_reference<float>(lattice, 1), 1e-5) << nx << " elements";
  }
}

TEST(Block, HasItsMass) {
  Lattice lattice = small_lattice(4);
  lattice.blocks = {{{1, 3}, {1, 2}, {1, 3}, 3}, {{3, 5}, {0, 3}, {3, 4}, -1}};
  WaveEngine<double> engine(lattice, materials(), {}, free_boundary(), 1);
  double mass = 0;
  for (int Z = 0; Z < engine.nodes_z(); ++Z)
    for (int Y = 0; Y < engine.nodes_y(); ++Y)
      for (int X = 0; X < engine.nodes_x(); ++X) mass += engine.mass(X, Y, Z);
  // Layers, block instead of layers, and the opening, by hand.
  const double layers = 5.4 * 3.5 * (0.9 * 1800 + 2.1 * 2000);
  const double block = 2.3 * 0.7 * (0.8 * (2400 - 2000) + 0.5 * (2400 - 1800)),
               opening = 1.9 * 3.5 * 0.4 * 1800;
  EXPECT_NEAR(mass, layers + block - opening, 1e-12 * mass);
}

/// What w the force comes from.
enum class Damping { none, viscous, memory };

/// Displacements of some nodes, the energy and the stable step after 150 steps of a pulse on the top of `lattice`.
template <class T>
std::vector<double> run(const Lattice& lattice, Damping damping, int threads = 1,
                        std::vector<EngineMaterial> given = materials()) {
  for (EngineMaterial& m : given) m.beta = damping == Damping::viscous ? m.beta : 0;
  EngineBoundary boundary;
  boundary.sponge_speed = 100;
  WaveEngine<T> engine(lattice, given, damping == Damping::memory ? rates : std::vector<double>{}, boundary,
                       threads);
  engine.set_time_step(0.8 * 1e-4);
  for (int step = 0; step < 150; ++step)
    engine.advance({{7, 6, step < 50 ? -1e3 * std::sin(M_PI * step / 50) : 0.0},
                    {9, 5, step < 40 ? 5e2 * std::sin(M_PI * step / 40) : 0.0, 0}},
                   step == 149);
  std::vector<double> result;
  for (int c = 0; c < 3; ++c)
    for (const int Z : {0, 5, 9})
      for (const int Y : {0, 4, 8})
        for (const int X : {0, 4, 9, 14}) result.push_back(1e8 * engine.displacement(c, X, Y, Z));
  result.push_back(engine.energy());
  return result;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double difference = 0, size = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference = std::max(difference, std::abs(a[i] - b[i]));
    size = std::max(size, std::abs(b[i]));
  }
  return difference / size;
}

TEST(Block, OfTheLayersMaterialChangesNothing) {
  const Lattice plain = small_lattice(4);
  Lattice blocks = plain;
  blocks.blocks = {{{1, 4}, {0, 2}, {1, 3}, 4}, {{0, 5}, {1, 3}, {2, 4}, 5}};
  std::vector<EngineMaterial> given = materials();
  given.push_back(given[1]);
  given.push_back(given[0]);
  blocks.blocks[0].z = {1, 2};  // of layer 1 only
  for (const Damping damping : {Damping::none, Damping::viscous, Damping::memory}) {
    EXPECT_LT(largest_difference(run<double>(blocks, damping, 1, given), run<double>(plain, damping)), 1e-12);
    EXPECT_LT(largest_difference(run<double>(blocks, damping, 2, given), run<double>(plain, damping)), 1e-12);
    EXPECT_LT(largest_difference(run<float>(blocks, damping, 1, given), run<float>(plain, damping)), 1e-4);
  }
}

TEST(Block, AsLargeAsALayerIsThatLayer) {
  // Sponge and outer faces are the layer's: the slab of the block lies between others, its face conditions differ,
  // so the model is closed without dashpots and sponge.
  Lattice layered = small_lattice(3);
  layered.layer = {1, 1, 3, 0};
  Lattice blocks = small_lattice(3);
  blocks.blocks = {{{0, 5}, {0, 3}, {2, 3}, 3}};
  for (const Damping damping : {Damping::none, Damping::viscous, Damping::memory}) {
    const auto displacements = [&](const Lattice& lattice) {
      std::vector<EngineMaterial> given = materials();
      for (EngineMaterial& m : given) m.beta = damping == Damping::viscous ? m.beta : 0;
      WaveEngine<double> engine(lattice, given, damping == Damping::memory ? rates : std::vector<double>{},
                                free_boundary(), 2);
      const double stable = engine.compute_stable_step();
      engine.set_time_step(0.8 * 1e-4);
      for (int step = 0; step < 200; ++step) engine.advance({{7, 6, step < 50 ? -1e3 : 0.0}}, step == 199);
      return std::vector<double>{stable * 1e4, 1e6 * engine.displacement(2, 3, 4, 5),
                                 1e6 * engine.displacement(0, 12, 9, 12), engine.energy()};
    };
    const auto expected = displacements(layered), computed = displacements(blocks);
    // The stable step comes from the same random start: the same iterates.
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(computed[i], expected[i], 1e-10 * std::abs(expected[i])) << i;
  }
}

TEST(OpenBlock, IsAsIfItsElementsWereNotThere) {
  Lattice lower = small_lattice(4);  // without the uppermost slab
  lower.z.pop_back();
  lower.layer.pop_back();
  Lattice open = small_lattice(4);
  open.blocks = {{{0, 5}, {0, 3}, {3, 4}, -1}};
  const auto motion = [](const Lattice& lattice, Damping damping) {
    std::vector<EngineMaterial> given = materials();
    for (EngineMaterial& m : given) m.beta = damping == Damping::viscous ? m.beta : 0;
    WaveEngine<double> engine(lattice, given, damping == Damping::memory ? rates : std::vector<double>{},
                              free_boundary(), 1);
    engine.set_time_step(0.8 * 1e-4);
    for (int Y = 0; Y < engine.nodes_y(); ++Y)
      for (int X = 0; X < engine.nodes_x(); ++X)
        for (int Z = 0; Z <= 12; ++Z) engine.set_displacement(2, X, Y, Z, std::sin(0.3 * X + 0.2 * Y * Z));
    for (int step = 0; step < 100; ++step) engine.advance({}, false);
    std::vector<double> u;
    for (int c = 0; c < 3; ++c)
      for (int Z = 0; Z <= 12; ++Z)
        for (int X = 0; X < engine.nodes_x(); ++X) u.push_back(engine.displacement(c, X, 5, Z));
    return u;
  };
  for (const Damping damping : {Damping::none, Damping::viscous, Damping::memory})
    EXPECT_LT(largest_difference(motion(open, damping), motion(lower, damping)), 1e-11);
}

TEST(OpenBlock, KeepsTheEnergyAndTheStepOfTheGround) {
  Lattice lattice = small_lattice(4);
  const auto stable_step = [&](const Lattice& l) {
    std::vector<EngineMaterial> elastic = materials();
    for (EngineMaterial& m : elastic) m.beta = 0;
    return WaveEngine<double>(l, elastic, {}, free_boundary(), 1).compute_stable_step();
  };
  const double plain = stable_step(lattice);
  lattice.blocks = {{{1, 3}, {1, 2}, {2, 4}, -1}, {{4, 5}, {0, 2}, {1, 3}, 3}};
  // Taking elements away from a node scales mass and stiffness alike: no node becomes stiffer than the stiffest
  // element alone, whose limit bounds the model's (Irons and Treharne).
  EXPECT_GT(stable_step(lattice), 0.35 * plain);  // the block is 2.7 times as fast as the ground around it
  std::vector<EngineMaterial> elastic = materials();
  for (EngineMaterial& m : elastic) m.beta = 0;
  for (const int threads : {1, 3}) {
    WaveEngine<double> engine(lattice, elastic, {}, free_boundary(), threads);
    engine.set_time_step(0.95 * engine.compute_stable_step());
    double work = 0;
    for (int step = 0; step < 400; ++step) {
      engine.advance({{1, 6, step < 150 ? -1e3 * std::pow(std::sin(M_PI * step / 150), 2) : 0.0}}, true);
      work += engine.step_work();
    }
    EXPECT_GT(work, 0);
    EXPECT_NEAR(engine.energy(), work, 1e-11 * work) << threads << " threads";
    EXPECT_EQ(engine.mass(6, 6, 12), 0);
    EXPECT_EQ(engine.displacement(2, 6, 6, 14), 0);  // inside the trench
    EXPECT_NE(engine.displacement(2, 4, 6, 14), 0);  // on its wall
  }
}

Site ground_with(const Block& block) {
  Site site;
  Layer top;
  top.name = "top";
  top.thickness = 2;
  top.density = 1800;
  top.cs = 100;
  top.cp = 200;
  Layer bottom = top;
  bottom.name = "bottom";
  bottom.cs = 200;
  bottom.cp = 400;
  site.layers = {top, bottom};
  site.receivers = {{"near", {0.4, 2.1, 0}}, {"behind", {-0.7, 6.2, 0}}};
  site.highest_frequency = 20;
  site.points_per_wavelength = 4;
  site.margin = 1;
  site.duration = 0.3;
  site.blocks = {block};
  return site;
}

Block trench() {
  Block block;
  block.name = "trench";
  block.x = {-3, 3};
  block.y = {3.1, 4.6};
  block.z = {-2.7, 0};
  block.open = true;
  block.mirrored = true;
  return block;
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
  options.sponge_elements = 3;
  options.double_precision = true;
  options.output_step = 2e-3;
  return options;
}

TEST(BlockInTheLattice, HasLinesOnItsFacesAndElementsForItsMaterial) {
  Block block = trench();
  block.open = false;
  block.material = {"fill", 0, 1500, 60, 120, 0.02, ""};
  const Site site = ground_with(block);
  const Lattice lattice = make_lattice(site, {{0, 0, 0.5, 2.4}});
  ASSERT_EQ(lattice.blocks.size(), 1u);  // the half model holds the one at y > 0
  const LatticeBlock& b = lattice.blocks[0];
  EXPECT_EQ(b.material, 2);
  EXPECT_NEAR(lattice.x[b.x[0]], -3, 1e-12);
  EXPECT_NEAR(lattice.x[b.x[1]], 3, 1e-12);
  EXPECT_NEAR(lattice.y[b.y[0]], 3.1, 1e-12);
  EXPECT_NEAR(lattice.y[b.y[1]], 4.6, 1e-12);
  EXPECT_NEAR(lattice.z[b.z[0]], -2.7, 1e-12);
  EXPECT_EQ(b.z[1], lattice.nz());
  const double h = lattice.degree * 60.0 / (20 * 4) * (1 + 1e-9);  // of 60 m/s
  for (int e = lattice.sponge_x[0]; e < lattice.nx() - lattice.sponge_x[1]; ++e)
    EXPECT_LE(lattice.x[e + 1] - lattice.x[e], h);
  for (int e = b.z[0]; e < b.z[1]; ++e) EXPECT_LE(lattice.z[e + 1] - lattice.z[e], h);
  // Interfaces stay where they were.
  EXPECT_TRUE(
      std::any_of(lattice.z.begin(), lattice.z.end(), [](double z) { return std::abs(z + 2) < 1e-12; }));
  for (int e = 0; e < lattice.nz(); ++e)
    EXPECT_EQ(lattice.layer[e], (lattice.z[e] + lattice.z[e + 1]) / 2 > -2 ? 0 : 1);

  LatticeOptions full;
  full.half_model = false;
  EXPECT_EQ(make_lattice(site, {{0, 0, 0.5, 2.4}}, full).blocks.size(), 2u);
  // Through the whole model, sponge included.
  block.x = Block().x;
  const Lattice through = make_lattice(ground_with(block), {{0, 0, 0.5, 2.4}});
  EXPECT_EQ(through.blocks[0].x[0], 0);
  EXPECT_EQ(through.blocks[0].x[1], through.nx());
}

TEST(BlockInTheLattice, NamesWhatIsWrongWithIt) {
  const SurfaceLoads loads = pulse({{0, 0, 0.5, 2.4}});
  const auto expect = [&](const Block& block, auto matcher) {
    EXPECT_THAT([&] { WaveSolver(ground_with(block), loads, small_options()); },
                ThrowsMessage<ModelError>(matcher));
  };
  Block block = trench();
  block.mirrored = false;
  expect(block, AllOf(HasSubstr("block 1 \"trench\": y = 3.1..4.6 m"), HasSubstr("half model"),
                      HasSubstr("mirrored = true")));
  block = trench();
  block.z = {-1, 0.5};
  expect(block, AllOf(HasSubstr("trench"), HasSubstr("z = -1..0.5 m"), HasSubstr("<= 0")));
  block = trench();
  block.y = {-1, 2};
  expect(block, AllOf(HasSubstr("y = -1..2 m contains y = 0"), HasSubstr("mirrored")));
  block = trench();
  block.open = false;
  block.material = {"", 0, 1500, -5, 120, 0.02, ""};
  expect(block, AllOf(HasSubstr("trench"), HasSubstr("cs = -5 m/s")));
  block = trench();
  block.y = {1, 3};  // under the load, and under the receiver
  expect(block, AllOf(HasSubstr("footprint 1"), HasSubstr("open block")));
  block.y = {1.9, 3};
  expect(block, AllOf(HasSubstr("receiver \"near\""), HasSubstr("open block")));
}

TEST(BlockInTheSolver, GivesTheSameMotionInTheHalfModel) {
  Site site = ground_with(trench());
  for (Layer& layer : site.layers) layer.damping = 0.03;
  Block stiff;  // beneath the trench
  stiff.x = {-1, 2};
  stiff.y = {2, 4.6};
  stiff.z = {-4, -3};
  stiff.mirrored = true;
  stiff.material = {"stiff", 0, 2300, 400, 800, 0.01, ""};
  site.blocks.push_back(stiff);
  site.receivers.push_back({"mirror", {-0.7, -6.2, 0}});  // makes the full lattice symmetric
  site.duration = 0.08;
  SolverOptions options = small_options();
  const SurfaceLoads loads = pulse({{0.2, 0, 0.6, 2.4}});
  const GroundMotion half = WaveSolver(site, loads, options).run();
  options.half_model = false;
  const GroundMotion full = WaveSolver(site, loads, options).run();
  for (const auto& [a, b] : {std::pair{&half.vx, &full.vx}, {&half.vy, &full.vy}, {&half.vz, &full.vz}})
    EXPECT_LT((*a - *b).cwiseAbs().maxCoeff(), 1e-10 * b->cwiseAbs().maxCoeff());
}

TEST(BlockInTheSolver, LosesEnergyOnceTheLoadStops) {
  // A trench through the whole model, its damping layers included.
  for (const DampingModel model : {DampingModel::none, DampingModel::constant_ratio}) {
    Block block = trench();
    block.x = Block().x;
    Site site = ground_with(block);
    for (Layer& layer : site.layers) layer.damping = 0.05;
    SolverOptions options = small_options();
    options.damping = model;
    const GroundMotion motion = WaveSolver(site, pulse({{0, 0, 0.6, 2.4}}), options).run();
    for (Eigen::Index i = 52; i < motion.energy.size(); ++i)
      EXPECT_LE(motion.energy(i), motion.energy(i - 1) * (1 + 1e-12)) << "t = " << motion.time(i);
  }
}

TEST(BlockInTheSolver, IsReciprocal) {
  // Across a trench on one side, vertical here and horizontal there.
  Block block = trench();
  block.mirrored = false;
  Site site = ground_with(block);
  site.taper_length = 0;
  site.duration = 0.15;
  SolverOptions options = small_options();
  options.half_model = false;
  SurfaceLoads loads = pulse({{-1.1, 1.4, 0.6, 0.8}, {1.4, 5.4, 0.5, 0.7, LoadDirection::x}});
  const Eigen::MatrixXd force = loads.force;
  loads.force.col(1).setZero();
  const Eigen::VectorXd there = WaveSolver(site, loads, options).run().footprint_displacement.col(1);
  loads.force = force;
  loads.force.col(0).setZero();
  const Eigen::VectorXd back = WaveSolver(site, loads, options).run().footprint_displacement.col(0);
  EXPECT_LT((there - back).cwiseAbs().maxCoeff(), 1e-10 * back.cwiseAbs().maxCoeff());
}

}  // namespace
}  // namespace easydyn::soil

// How a lattice is shared out among ranks, and what its engines make of it.

#include <gmock/gmock.h>

#include <atomic>
#include <cmath>
#include <mutex>

#include "easydyn/error.hpp"
#include "soil/agreement.hpp"
#include "soil/wave_engine.hpp"
#include "tests/soil/thread_ranks.hpp"

namespace easydyn::soil {
namespace {

using test::ThreadRanks;

TEST(Partition, GivesEachRowOfElementsToOneRank) {
  for (const int ranks : {1, 2, 3, 4, 6, 7, 12}) {
    const Partition partition(13, 9, 4, ranks);
    ASSERT_EQ(partition.ranks(), ranks);
    for (int ez = 0; ez < 9; ++ez)
      for (int ey = 0; ey < 13; ++ey) {
        int holders = 0;
        for (int r = 0; r < ranks; ++r) holders += partition.block(r).has(ey, ez) ? 1 : 0;
        EXPECT_EQ(holders, 1) << ranks << " ranks, row " << ey << ", slab " << ez;
      }
  }
}

TEST(Partition, CutsTheLongSideAndKeepsBlocksCompact) {
  const auto shape = [](int rows, int slabs, int ranks) {
    const Partition partition(rows, slabs, 4, ranks);
    return std::pair(partition.along_y(), partition.along_z());
  };
  EXPECT_EQ(shape(40, 20, 2), std::pair(2, 1));  // the shorter cut: 20 slabs instead of 40 rows
  EXPECT_EQ(shape(20, 40, 2), std::pair(1, 2));
  EXPECT_EQ(shape(32, 32, 16), std::pair(4, 4));  // squares have the shortest edges
  EXPECT_EQ(shape(64, 16, 16), std::pair(8, 2));  // blocks of 8 x 8
  EXPECT_EQ(shape(30, 7, 5), std::pair(5, 1));    // 7 slabs in 5 parts would leave one with 2 of them
  EXPECT_EQ(Partition(40, 21, 4, 4).largest_block(), 210);  // 40 x 21 elements in four equal parts
}

TEST(Partition, NamesTheSharersOfEachLine) {
  const int degree = 3;
  const Partition partition(7, 6, degree, 6);
  std::vector<long> received(6, 0);
  for (int Z = 0; Z <= 6 * degree; ++Z)
    for (int Y = 0; Y <= 7 * degree; ++Y) {
      std::vector<int> expected;  // blocks whose closed rectangle of nodes holds the line
      for (int r = 0; r < 6; ++r) {
        const ElementBlock& b = partition.block(r);
        if (b.rows[0] * degree <= Y && Y <= b.rows[1] * degree && b.slabs[0] * degree <= Z &&
            Z <= b.slabs[1] * degree)
          expected.push_back(r);
      }
      ASSERT_EQ(partition.sharers({Y, Z}), expected) << Y << " " << Z;
      // One line for each row of elements of another rank that touches it.
      for (int ez = 0; ez < 6; ++ez)
        for (int ey = 0; ey < 7; ++ey) {
          const bool touches = std::abs(2 * Y - (2 * ey + 1) * degree) <= degree &&
                               std::abs(2 * Z - (2 * ez + 1) * degree) <= degree;
          for (const int r : expected) received[r] += touches && !partition.block(r).has(ey, ez) ? 1 : 0;
        }
    }
  for (int r = 0; r < 6; ++r) EXPECT_EQ(partition.received_lines(r), received[r]);
}

TEST(Partition, RefusesMoreRanksThanItCanServe) {
  EXPECT_THROW(Partition(3, 2, 4, 7), ModelError);  // a prime larger than either side
  EXPECT_THROW(Partition(3, 2, 4, 12), ModelError);
  EXPECT_NO_THROW(Partition(3, 2, 4, 6));
}

TEST(Agreement, ThrowsTheFirstFailureOnAllRanks) {
  std::atomic<int> thrown{0};
  ThreadRanks::run(3, [&](Ranks& ranks) {
    EXPECT_NO_THROW(act_together(&ranks, [] {}));
    try {
      act_together(&ranks, [&] {
        if (ranks.rank() > 0) throw InputError("rank " + std::to_string(ranks.rank()));
      });
    } catch (const InputError& error) {
      if (std::string(error.what()) == "rank 1") ++thrown;
    }
  });
  EXPECT_EQ(thrown, 3);
}

// --- engines on ranks

/// Uneven lattice of 5 x 7 x 6 elements on two layers, with a stiff block over the middle and an open trench.
Lattice make_ground(bool blocks) {
  Lattice lattice;
  lattice.degree = 3;
  lattice.half_model = true;
  lattice.x = {-2.0, -0.8, 0.1, 1.5, 2.2, 3.4};
  lattice.y = {0, 1.1, 2.0, 3.2, 4.0, 5.3, 6.1, 7.5};
  lattice.z = {-5.2, -4.1, -3.0, -1.9, -1.2, -0.5, 0};
  lattice.layer = {1, 1, 1, 0, 0, 0};
  lattice.sponge_x = {1, 1};
  lattice.sponge_y = {0, 2};
  lattice.sponge_z = {1, 0};
  if (blocks) lattice.blocks = {{{1, 4}, {2, 5}, {2, 5}, 2}, {{2, 4}, {5, 6}, {4, 6}, -1}};
  return lattice;
}

enum class Damping { none, viscous, memory };

struct Motion {
  std::vector<double> displacement;  // [component][Z][Y][X]
  double energy = 0, largest = 0;
};

template <class T>
Motion compute_motion(const Lattice& lattice, Damping damping, int threads, Ranks* ranks,
                      int* differing_bits) {
  std::vector<EngineMaterial> materials{{2.3e7, 1.1e7, 1800, 0, {0.02, 0.03}},
                                        {9.1e7, 2.7e7, 2000, 0, {0.01, 0.02}},
                                        {3.2e8, 1.9e8, 2400, 0, {0.004, 0.005}}};
  for (EngineMaterial& material : materials) {
    if (damping == Damping::viscous) material.beta = 1e-5;
    if (damping != Damping::memory) material.memory_weights.clear();
  }
  const std::vector<double> rates =
      damping == Damping::memory ? std::vector<double>{60, 400} : std::vector<double>{};
  EngineBoundary boundary;
  boundary.sponge_speed = 120;
  WaveEngine<T> engine(lattice, materials, rates, boundary, threads, ranks);
  Motion motion;
  motion.largest = engine.compute_largest_eigenvalue(false);
  engine.set_time_step(2e-4);
  // Forces on lines that several ranks share among them.
  const std::vector<SurfaceNodeForce> forces{
      {6, 0, 1e3, 2}, {7, 9, 2e3, 2}, {4, 12, 500, 0}, {9, 15, 800, 1}};
  for (int step = 0; step < 80; ++step)
    engine.advance(step < 30 ? forces : std::vector<SurfaceNodeForce>{}, true);
  motion.energy = engine.energy();
  const int nX = engine.nodes_x(), nY = engine.nodes_y(), nZ = engine.nodes_z();
  std::vector<double> held(static_cast<std::size_t>(3) * nX * nY * nZ, 0.0);
  motion.displacement = held;
  for (int c = 0; c < 3; ++c)
    for (int Z = 0; Z < nZ; ++Z)
      for (int Y = 0; Y < nY; ++Y)
        for (int X = 0; X < nX; ++X) {
          const std::size_t place = ((static_cast<std::size_t>(c) * nZ + Z) * nY + Y) * nX + X;
          if (engine.has_line(Y, Z)) held[place] = engine.displacement(c, X, Y, Z);
          if (engine.owns_line(Y, Z)) motion.displacement[place] = held[place];
        }
  if (!ranks) return motion;
  ranks->sum(motion.displacement.data(), motion.displacement.size());
  ranks->sum(&motion.energy, 1);
  *differing_bits = 0;  // of lines that another rank owns
  for (int c = 0; c < 3; ++c)
    for (int Z = 0; Z < nZ; ++Z)
      for (int Y = 0; Y < nY; ++Y)
        for (int X = 0; X < nX; ++X) {
          const std::size_t place = ((static_cast<std::size_t>(c) * nZ + Z) * nY + Y) * nX + X;
          if (engine.has_line(Y, Z) && held[place] != motion.displacement[place]) ++*differing_bits;
        }
  return motion;
}

template <class T>
void expect_same_on_ranks(int count, int threads, Damping damping, bool blocks, double tolerance) {
  const Lattice lattice = make_ground(blocks);
  const Motion alone = compute_motion<T>(lattice, damping, threads, nullptr, nullptr);
  double peak = 0;
  for (const double u : alone.displacement) peak = std::max(peak, std::abs(u));
  ASSERT_GT(peak, 0);
  std::mutex one_at_a_time;
  ThreadRanks::run(count, [&](Ranks& ranks) {
    int differing_bits = -1;
    const Motion shared = compute_motion<T>(lattice, damping, threads, &ranks, &differing_bits);
    const std::lock_guard<std::mutex> lock(one_at_a_time);
    EXPECT_EQ(differing_bits, 0) << "rank " << ranks.rank();
    double difference = 0;
    for (std::size_t i = 0; i < alone.displacement.size(); ++i)
      difference = std::max(difference, std::abs(shared.displacement[i] - alone.displacement[i]));
    // The same bits but where lines between ranks touch blocks.
    EXPECT_LE(difference, blocks ? tolerance * peak : 0) << count << " ranks, " << threads << " threads";
    EXPECT_NEAR(shared.energy, alone.energy, 10 * tolerance * alone.energy);
    EXPECT_NEAR(shared.largest, alone.largest, 10 * tolerance * alone.largest);
  });
}

// Tolerances: sums over all nodes (energy, eigenvalue) and lines between ranks that touch blocks end in other last
// digits; the promise is 1e-12 and 1e-5 of the peak.
TEST(WaveEngineOnRanks, MovesAsOnOneRank) {
  for (const int ranks : {2, 3, 4, 6}) expect_same_on_ranks<double>(ranks, 1, Damping::none, false, 1e-12);
}

TEST(WaveEngineOnRanks, MovesAsOnOneRankWithThreads) {
  expect_same_on_ranks<double>(2, 3, Damping::none, false, 1e-12);
  expect_same_on_ranks<double>(4, 2, Damping::memory, true, 1e-12);
}

TEST(WaveEngineOnRanks, MovesAsOnOneRankWithDampingAndBlocks) {
  for (const Damping damping : {Damping::none, Damping::viscous, Damping::memory})
    expect_same_on_ranks<double>(4, 1, damping, true, 1e-12);
  expect_same_on_ranks<double>(6, 1, Damping::memory, true, 1e-12);
}

TEST(WaveEngineOnRanks, MovesAsOnOneRankInSinglePrecision) {
  expect_same_on_ranks<float>(4, 1, Damping::memory, true, 1e-5);
  expect_same_on_ranks<float>(3, 1, Damping::memory, false, 1e-5);
}

TEST(WaveEngineOnRanks, HoldsPartOfTheLatticeEach) {
  const Lattice lattice = make_ground(false);
  std::vector<double> bytes(4, 0);
  ThreadRanks::run(4, [&](Ranks& ranks) {
    WaveEngine<float> engine(lattice, {{2.3e7, 1.1e7, 1800, 0, {}}, {9.1e7, 2.7e7, 2000, 0, {}}}, {}, {}, 1,
                             &ranks);
    engine.visit_state(
        [&](const void*, std::size_t field) { bytes[ranks.rank()] += static_cast<double>(field); });
    EXPECT_GT(engine.halo_size(), 0);
    const Partition partition(lattice.ny(), lattice.nz(), lattice.degree, 4);
    EXPECT_EQ(engine.table_memory(),
              WaveEngine<float>::compute_table_memory(lattice, partition, ranks.rank(), 1));
  });
  const double whole = WaveEngine<float>::compute_memory(lattice, 0);
  // A quarter, and lines held twice: half of 22 x 19 lines each way is at most 13 x 10.
  for (const double part : bytes) EXPECT_LT(part, 0.33 * whole);
}

}  // namespace
}  // namespace easydyn::soil

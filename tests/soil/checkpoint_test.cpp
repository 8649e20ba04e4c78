#include "soil/checkpoint.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "easydyn/error.hpp"
#include "soil/disk_space.hpp"
#include "soil/prediction.hpp"
#include "tests/soil/small_ground.hpp"
#include "tests/temporary_folder.hpp"

namespace easydyn::soil {
namespace {

using easydyn::testing::message_of;
using easydyn::testing::read_whole_file;
using easydyn::testing::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(Checksum, IsTheSameHoweverTheStreamIsCut) {
  std::string text;
  for (int i = 0; i < 1000; ++i) text += static_cast<char>(i * i % 251);
  Checksum whole;
  whole.add(text.data(), text.size());
  for (const std::size_t piece : {1u, 3u, 7u, 8u, 9u, 64u}) {
    Checksum pieces;
    for (std::size_t at = 0; at < text.size(); at += piece)
      pieces.add(text.data() + at, std::min(piece, text.size() - at));
    EXPECT_EQ(pieces.value(), whole.value()) << piece;
  }
}

TEST(Checksum, SeesEverySingleBitAndTheLength) {
  std::string text(67, 'a');
  const auto sum = [](const std::string& t) {
    Checksum checksum;
    checksum.add(t.data(), t.size());
    return checksum.value();
  };
  const std::uint64_t before = sum(text);
  for (std::size_t byte = 0; byte < text.size(); ++byte)
    for (int bit = 0; bit < 8; ++bit) {
      std::string changed = text;
      changed[byte] = static_cast<char>(changed[byte] ^ (1 << bit));
      EXPECT_NE(sum(changed), before) << byte << " " << bit;
    }
  EXPECT_NE(sum(text + std::string(1, '\0')), before);
  EXPECT_NE(sum(std::string(1, '\0')), sum(std::string(2, '\0')));
}

class Checkpoint : public ::testing::Test {
 protected:
  void write() const {
    CheckpointWriter file(path_, identity_);
    file.write_value(3.5);
    file.write("state", 5);
    file.commit();
  }
  std::string fault(const RunIdentity& identity) const {
    return message_of<InputError>([&] { CheckpointReader(path_, identity); });
  }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "checkpoint.bin";
  RunIdentity identity_{{"site", "12ab"}, {"option degree", "4"}};
};

TEST_F(Checkpoint, BringsBackWhatWasWritten) {
  write();
  CheckpointReader file(path_, identity_);
  double value = 0;
  std::string text(5, ' ');
  file.read_value(value);
  EXPECT_THROW(file.finish(), InputError);
  file.read(text.data(), 5);
  EXPECT_EQ(value, 3.5);
  EXPECT_EQ(text, "state");
  EXPECT_NO_THROW(file.finish());
  EXPECT_THROW(file.read_value(value), InputError);
}

TEST_F(Checkpoint, LeavesTheEarlierOneUntilItIsComplete) {
  write();
  const std::string before = read_whole_file(path_);
  {
    CheckpointWriter file(path_, identity_);
    file.write_value(7.0);
  }  // stopped before commit()
  EXPECT_EQ(read_whole_file(path_), before);
  EXPECT_EQ(folder_.count(), 1);
}

TEST_F(Checkpoint, IsRefusedWhenAnyByteIsDamaged) {
  write();
  const std::string whole = read_whole_file(path_);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ 4);
    folder_.write("checkpoint.bin", damaged);
    EXPECT_THAT(fault(identity_), AllOf(HasSubstr("checkpoint.bin: is damaged"), HasSubstr("checksum"))) << i;
  }
  for (const std::size_t length : {std::size_t{0}, std::size_t{9}, whole.size() / 2, whole.size() - 1}) {
    folder_.write("checkpoint.bin", whole.substr(0, length));
    EXPECT_THAT(fault(identity_), HasSubstr("checkpoint.bin: is damaged")) << length;
  }
}

TEST_F(Checkpoint, IsRefusedForAnotherRunByTheNameOfWhatDiffers) {
  write();
  EXPECT_THAT(fault({{"site", "34cd"}, {"option degree", "4"}}),
              HasSubstr("checkpoint.bin: belongs to another run: site was 12ab, is 34cd"));
  EXPECT_THAT(fault({{"site", "12ab"}, {"option degree", "5"}}), HasSubstr("option degree was 4, is 5"));
  EXPECT_THAT(fault({{"site", "12ab"}}), HasSubstr("belongs to another run"));
}

TEST_F(Checkpoint, IsMissedByName) {
  EXPECT_THAT(fault(identity_),
              AllOf(HasSubstr("checkpoint.bin: cannot be read"), HasSubstr("no checkpoint")));
}

/// Runs until `steps` steps are done in this call; true if the run is complete.
bool run_for(WaveSolver& solver, RunControl control, long steps, GroundMotion& motion) {
  control.is_stop_wanted = [left = steps]() mutable { return --left <= 0; };
  try {
    motion = solver.run(control);
    return true;
  } catch (const RunStopped&) {
    return false;
  }
}

void expect_same_bits(const GroundMotion& a, const GroundMotion& b) {
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.vx, b.vx);
  EXPECT_EQ(a.vy, b.vy);
  EXPECT_EQ(a.vz, b.vz);
  EXPECT_EQ(a.footprint_displacement, b.footprint_displacement);
  EXPECT_EQ(a.energy, b.energy);
}

TEST(Restart, GivesTheSameBitsAsARunThatWasNotStopped) {
  const TemporaryFolder folder;
  RunControl control;
  control.checkpoint = folder / "checkpoint.bin";
  for (const DampingModel damping :
       {DampingModel::none, DampingModel::stiffness_proportional, DampingModel::constant_ratio})
    for (const bool double_precision : {false, true})
      for (const bool starts_loaded : {false, true}) {
        SolverOptions options = test::small_options();
        options.damping = damping;
        options.double_precision = double_precision;
        options.preload_time = 0.02;
        SurfaceLoads loads = test::small_loads();
        if (starts_loaded) loads.force.array() += 1e3;  // steps before the first output
        const GroundMotion whole = WaveSolver(test::small_site(), loads, options).run();
        ASSERT_GT(whole.vz.cwiseAbs().maxCoeff(), 0);
        // A new solver for each part, as in a new process. Primes: stops at and between output steps.
        GroundMotion motion;
        int parts = 0;
        for (bool complete = false; !complete; ++parts) {
          ASSERT_LT(parts, 1000);
          WaveSolver solver(test::small_site(), loads, options);
          control.restart = parts > 0;
          complete = run_for(solver, control, std::max(7L, solver.steps() / 5), motion);
        }
        EXPECT_GE(parts, 4);
        expect_same_bits(motion, whole);
      }
}

TEST(Restart, KeepsTheStatesOfAMatchedLayer) {
  const TemporaryFolder folder;
  RunControl control;
  control.checkpoint = folder / "checkpoint.bin";
  SolverOptions options = test::small_options();
  options.boundary = AbsorbingBoundary::matched_layer;
  options.sponge_elements = 2;
  const SurfaceLoads loads = test::small_loads();
  const GroundMotion whole = WaveSolver(test::small_site(), loads, options).run();
  ASSERT_GT(whole.vz.cwiseAbs().maxCoeff(), 0);
  EXPECT_EQ(whole.energy.size(), 0);
  GroundMotion motion;
  int parts = 0;
  for (bool complete = false; !complete; ++parts) {
    ASSERT_LT(parts, 1000);
    WaveSolver solver(test::small_site(), loads, options);
    control.restart = parts > 0;
    complete = run_for(solver, control, std::max(7L, solver.steps() / 5), motion);
    if (parts == 0) {
      SolverOptions other = options;
      other.boundary = AbsorbingBoundary::sponge;
      WaveSolver sponge(test::small_site(), loads, other);
      control.restart = true;
      EXPECT_THAT(message_of<InputError>([&] { sponge.run(control); }),
                  HasSubstr("option boundary was pml, is sponge"));
    }
  }
  EXPECT_GE(parts, 4);
  expect_same_bits(motion, whole);
}

TEST(RankCheckpoints, FollowTheirCheckpointAndGoWithIt) {
  const TemporaryFolder folder;
  for (const char* name : {"checkpoint.rank1.step40.bin", "checkpoint.rank2.step40.bin.partial",
                           "checkpoint.previous.rank1.step7.bin", "checkpoint.low.rank1.step9.bin"})
    folder.write(name, "");
  const auto is_there = [&](const char* name) { return std::filesystem::exists(folder / name); };
  set_rank_checkpoints_aside(folder / "checkpoint.bin", folder / "checkpoint.previous.bin");
  EXPECT_EQ(rank_checkpoint_of(folder / "checkpoint.previous.bin", 1, 40),
            folder / "checkpoint.previous.rank1.step40.bin");
  EXPECT_TRUE(is_there("checkpoint.previous.rank1.step40.bin"));
  EXPECT_FALSE(is_there("checkpoint.rank1.step40.bin"));
  EXPECT_FALSE(is_there("checkpoint.previous.rank1.step7.bin"));
  EXPECT_TRUE(is_there("checkpoint.low.rank1.step9.bin"));  // of another checkpoint

  remove_rank_checkpoints(folder / "checkpoint.previous.bin", 1,
                          folder / "checkpoint.previous.rank1.step40.bin");
  EXPECT_TRUE(is_there("checkpoint.previous.rank1.step40.bin"));
  remove_rank_checkpoints(folder / "checkpoint.previous.bin", 0);
  EXPECT_FALSE(is_there("checkpoint.previous.rank1.step40.bin"));
  EXPECT_FALSE(is_there("checkpoint.previous.rank2.step40.bin.partial"));
}

TEST(Restart, GoesOnInBothPartsOfARunWithACrossover) {
  const TemporaryFolder folder;
  RunControl control;
  control.checkpoint = folder / "checkpoint.bin";
  SolverOptions options = test::small_options();
  options.crossover_frequency = 10;
  const SurfaceLoads loads = test::small_loads();
  const GroundMotion whole = WaveSolver(test::small_site(), loads, options).run();
  ASSERT_GT(whole.vz.cwiseAbs().maxCoeff(), 0);
  GroundMotion motion;
  int stops_below = 0, stops_above = 0;
  control.restart = false;
  for (bool complete = false; !complete;) {
    ASSERT_LT(stops_below + stops_above, 1000);
    WaveSolver solver(test::small_site(), loads, options);
    complete = run_for(solver, control, std::max(7L, solver.steps() / 4), motion);
    if (!complete) ++(std::filesystem::exists(control.checkpoint) ? stops_above : stops_below);
    EXPECT_TRUE(std::filesystem::exists(low_checkpoint_of(control.checkpoint)));
    control.restart = true;
  }
  EXPECT_GE(stops_below, 1);
  EXPECT_GE(stops_above, 2);
  expect_same_bits(motion, whole);

  std::filesystem::remove(low_checkpoint_of(control.checkpoint));
  WaveSolver solver(test::small_site(), loads, options);
  EXPECT_THAT(message_of<InputError>([&] { solver.run(control); }),
              AllOf(HasSubstr("checkpoint.low.bin"), HasSubstr("no checkpoint")));
}

TEST(Restart, CanGoOnInTheSameSolver) {
  const TemporaryFolder folder;
  RunControl control;
  control.checkpoint = folder / "checkpoint.bin";
  WaveSolver solver(test::small_site(), test::small_loads(), test::small_options());
  const GroundMotion whole = solver.run();
  GroundMotion motion;
  ASSERT_FALSE(run_for(solver, control, 20, motion));
  solver.compute_summary();  // times the kernel with the fields of the solver
  control.restart = true;
  ASSERT_TRUE(run_for(solver, control, 1000000, motion));
  expect_same_bits(motion, whole);
}

TEST(Restart, SaysFirstWhereItGoesOn) {
  const TemporaryFolder folder;
  RunControl control;
  control.checkpoint = folder / "checkpoint.bin";
  WaveSolver solver(test::small_site(), test::small_loads(), test::small_options());
  GroundMotion motion;
  const long half = solver.steps() / 2;
  ASSERT_FALSE(run_for(solver, control, half, motion));
  control.restart = true;
  std::vector<double> fractions;
  control.progress = [&](double fraction) { fractions.push_back(fraction); };
  solver.run(control);
  ASSERT_GE(fractions.size(), 2u);
  EXPECT_DOUBLE_EQ(fractions.front(), static_cast<double>(half) / static_cast<double>(solver.steps()));
  EXPECT_EQ(fractions.back(), 1);
}

TEST(Restart, IsRefusedWithAnotherSiteOtherLoadsOrOtherOptions) {
  const TemporaryFolder folder;
  RunControl control;
  control.checkpoint = folder / "checkpoint.bin";
  GroundMotion motion;
  {
    WaveSolver solver(test::small_site(), test::small_loads(), test::small_options());
    ASSERT_FALSE(run_for(solver, control, 20, motion));
  }
  control.restart = true;
  const auto fault = [&](const Site& site, const SurfaceLoads& loads, const SolverOptions& options) {
    return message_of<InputError>([&] { WaveSolver(site, loads, options).run(control); });
  };
  Site site = test::small_site();
  site.layers[1].cs += 1e-9;
  EXPECT_THAT(fault(site, test::small_loads(), test::small_options()),
              HasSubstr("checkpoint.bin: belongs to another run: site was "));
  SurfaceLoads loads = test::small_loads();
  loads.force(50, 0) += 1e-6;
  EXPECT_THAT(fault(test::small_site(), loads, test::small_options()), HasSubstr("surface loads was "));
  SolverOptions options = test::small_options();
  options.degree = 4;
  EXPECT_THAT(fault(test::small_site(), test::small_loads(), options),
              HasSubstr("option degree was 3, is 4"));
  options = test::small_options();
  options.threads = 1;
  EXPECT_THAT(fault(test::small_site(), test::small_loads(), options),
              HasSubstr("option threads was 2, is 1"));
  options = test::small_options();
  options.double_precision = true;
  EXPECT_THAT(fault(test::small_site(), test::small_loads(), options),
              HasSubstr("option double was no, is yes"));
}

TEST(CheckpointOfARun, IsWrittenAtItsInterval) {
  const TemporaryFolder folder;
  RunControl control;
  control.checkpoint = folder / "checkpoint.bin";
  control.checkpoint_interval = 1e-9;  // after every step
  WaveSolver solver(test::small_site(), test::small_loads(), test::small_options());
  const GroundMotion whole = solver.run(control);
  EXPECT_NEAR(static_cast<double>(std::filesystem::file_size(control.checkpoint)),
              solver.compute_summary().checkpoint, 2048);
  // The last one was written before the last step.
  control.restart = true;
  expect_same_bits(solver.run(control), whole);
}

TEST(CheckpointOfARun, MayLieInTheCurrentFolder) {
  const TemporaryFolder folder;
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  RunControl control;
  control.checkpoint = "a.h5";
  WaveSolver solver(test::small_site(), test::small_loads(), test::small_options());
  const GroundMotion whole = solver.run();
  GroundMotion motion;
  EXPECT_NO_THROW(print_file_summary(stdout, solver, control));
  EXPECT_FALSE(run_for(solver, control, 20, motion));
  EXPECT_TRUE(std::filesystem::exists(folder / "a.h5"));
  control.restart = true;
  EXPECT_TRUE(run_for(solver, control, 1000000, motion));
  std::filesystem::current_path(before);
  expect_same_bits(motion, whole);
  // A disk is asked for what it has.
  EXPECT_THAT(message_of<InputError>([] { require_disk_space("", 1e18, "checkpoints"); }),
              HasSubstr(".: checkpoints need 1000000000.0 GB, must be at most "));
}

TEST(CheckpointOfARun, DoesNotEndTheRunWhenItCannotBeWritten) {
  const TemporaryFolder folder;
  RunControl control;
  control.checkpoint = folder / "no folder/checkpoint.bin";
  control.checkpoint_interval = 0.01;
  std::vector<std::string> warnings;
  control.warn = [&](const std::string& sentence) { warnings.push_back(sentence); };
  WaveSolver solver(test::small_site(), test::small_loads(), test::small_options());
  EXPECT_EQ(solver.run(control).vz, solver.run().vz);
  ASSERT_FALSE(warnings.empty());
  EXPECT_THAT(warnings[0], AllOf(HasSubstr("checkpoint.bin"), HasSubstr("the run goes on")));
  // Asked to stop, it must not pretend that one can go on.
  GroundMotion motion;
  EXPECT_THROW(run_for(solver, control, 20, motion), InputError);
}

}  // namespace
}  // namespace easydyn::soil

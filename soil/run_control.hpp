#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "easydyn/error.hpp"

namespace easydyn::soil {

/// What accompanies a run of the wave solver; by default nothing.
struct RunControl {
  std::function<void(double fraction)> progress;  ///< gets the fraction done, 0..1, a few times per second;
                                                  ///< first of all the one that the run starts from
  std::function<bool()> is_stop_wanted;           ///< asked after every step
  std::filesystem::path checkpoint;               ///< the file; empty: none
  double checkpoint_interval = 600;               ///< [s] of real time; 0: only when the run is stopped
  bool restart = false;                           ///< go on from the checkpoint
  std::filesystem::path snapshots;                ///< folder of Site::snapshots; empty: none are taken
  /// Gets one sentence on what went wrong without harm to the run: a checkpoint that could not be written.
  std::function<void(const std::string& sentence)> warn;
};

/// Beside the checkpoint of a run with a crossover frequency, that of its part below: checkpoint.bin, checkpoint.low.bin.
/// Empty without checkpoint.
inline std::filesystem::path low_checkpoint_of(const std::filesystem::path& checkpoint) {
  if (checkpoint.empty()) return {};
  std::filesystem::path low = checkpoint;
  low.replace_filename(checkpoint.stem().string() + ".low" + checkpoint.extension().string());
  return low;
}

/// The file of a rank: checkpoint.bin of the first one, checkpoint.rank3.step4200.bin of another one.
inline std::filesystem::path rank_checkpoint_of(const std::filesystem::path& checkpoint, int rank,
                                                long step) {
  if (rank == 0) return checkpoint;
  std::filesystem::path file = checkpoint;
  file.replace_filename(checkpoint.stem().string() + ".rank" + std::to_string(rank) + ".step" +
                        std::to_string(step) + checkpoint.extension().string());
  return file;
}

/// Removes the files of one rank beside a checkpoint, also half-written ones, of all ranks but the first if `rank` is 0,
/// except `kept`.
void remove_rank_checkpoints(const std::filesystem::path& checkpoint, int rank,
                             const std::filesystem::path& kept = {});

/// The files of the other ranks follow a checkpoint that has been renamed to `previous`; an older set there is removed.
void set_rank_checkpoints_aside(const std::filesystem::path& checkpoint,
                                const std::filesystem::path& previous);

/// A run ended because it was asked to; what() says where and how to go on.
class RunStopped : public Error {
 public:
  RunStopped(const std::string& what, long steps_done, long steps)
      : Error(what), steps_done_(steps_done), steps_(steps) {}
  long steps_done() const { return steps_done_; }
  long steps() const { return steps_; }

 private:
  long steps_done_, steps_;
};

}  // namespace easydyn::soil

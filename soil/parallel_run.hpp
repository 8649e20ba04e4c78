#pragma once

#include <memory>
#include <string>

#include "soil/ranks.hpp"

namespace easydyn::soil {

/// Ranks that a launcher (mpirun, srun) has started: what a program needs beside what a run needs.
class LaunchedRanks : public Ranks {
 public:
  /// Whether all ranks come here within some seconds.
  virtual bool meet(double seconds) = 0;
  /// Ends all ranks at once.
  virtual void abort(int status) = 0;
  virtual void finish() = 0;  ///< the last call
};

/// What the program and the module with the ranks must agree on: the version, and how these classes lie in memory.
/// The number is raised with every change of Ranks, Halo or LaunchedRanks.
inline std::string describe_ranks_interface(const std::string& version) {
  return version + ", interface 1";
}

/// Number of processes that the launcher has started, by the variables of its environment; 1 without launcher.
///
/// Open MPI: OMPI_COMM_WORLD_SIZE; MPICH, Intel MPI: PMI_SIZE; srun: SLURM_STEP_NUM_TASKS. (SLURM_NTASKS is set in the
/// job script, too, where nobody has started ranks.)
int count_launched_ranks();

/// One program, many ranks. MPI is loaded only if the launcher has started more than one rank; only the first rank
/// prints.
class ParallelRun {
 public:
  /// @throws InputError if there are several ranks and this program cannot use MPI, or its module is of another version
  ParallelRun();
  ~ParallelRun();
  ParallelRun(const ParallelRun&) = delete;
  ParallelRun& operator=(const ParallelRun&) = delete;

  Ranks* ranks() const { return ranks_; }  ///< nullptr: this process alone
  bool is_first() const { return !ranks_ || ranks_->rank() == 0; }

  /// Prints the message of an error, once. Ranks that do not know of it are ended.
  void fail(const std::string& message);

 private:
  LaunchedRanks* ranks_ = nullptr;
  int own_stderr_ = -1;  // of a rank that does not print
};

}  // namespace easydyn::soil

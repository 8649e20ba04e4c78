#include "soil/parallel_run.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "easydyn/error.hpp"

namespace easydyn::soil {
namespace {

constexpr const char* module_name = "libsoil_mpi.so";
constexpr double patience = 2;  // [s] until a rank with an error thinks that it is the only one

}  // namespace

int count_launched_ranks() {
  for (const char* const variable : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"})
    if (const char* const value = std::getenv(variable)) return std::max(1, std::atoi(value));
  return 1;
}

ParallelRun::ParallelRun() {
  const int launched = count_launched_ranks();
  if (launched == 1) return;
  void* const module = dlopen(module_name, RTLD_NOW | RTLD_LOCAL);
  if (!module)
    throw InputError(
        fmt::format("started as one of {} ranks, but this program has no MPI (CMake option EASYDYN_MPI): {}",
                    launched, dlerror()));
  using Start = LaunchedRanks* (*)();
  const auto start = reinterpret_cast<Start>(dlsym(module, "easydyn_start_ranks"));
  if (!start) throw InputError(fmt::format("{}: {}", module_name, dlerror()));
  ranks_ = start();
  if (ranks_->size() != launched)
    throw InputError(
        fmt::format("started as one of {} ranks, but MPI knows of {}: the launcher must be that of the MPI "
                    "which the program uses (with srun: --mpi=pmix)",
                    launched, ranks_->size()));
  if (ranks_->rank() == 0) return;
  own_stderr_ = dup(STDERR_FILENO);
  if (const int nowhere = open("/dev/null", O_WRONLY); nowhere >= 0) {
    std::fflush(stdout);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    close(nowhere);
  }
}

ParallelRun::~ParallelRun() {
  if (ranks_) ranks_->finish();
}

void ParallelRun::fail(const std::string& message) {
  if (!ranks_ || ranks_->meet(is_first() ? patience : 1.5 * patience)) {
    std::fputs(message.c_str(), stderr);  // that of another rank than the first goes nowhere
    return;
  }
  std::fflush(stdout);
  const ssize_t ignored = write(is_first() ? STDERR_FILENO : own_stderr_, message.data(), message.size());
  static_cast<void>(ignored);
  ranks_->abort(1);
}

}  // namespace easydyn::soil

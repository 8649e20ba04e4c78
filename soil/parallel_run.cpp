#include "soil/parallel_run.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "easydyn/error.hpp"
#include "easydyn/results/provenance.hpp"

namespace easydyn::soil {
namespace {

constexpr const char* module_name = "libsoil_mpi.so";
constexpr double patience = 2;  // [s] until a rank with an error thinks that it is the only one

/// A function of the module.
template <class Function>
Function find_function(void* module, const char* name) {
  return reinterpret_cast<Function>(dlsym(module, name));
}

// A module of another version would be called by functions that it does not have.
void require_same_interface(void* module, void* any_function) {
  const auto describe = find_function<const char* (*)()>(module, "easydyn_ranks_interface");
  const std::string there = describe ? describe() : "an earlier version",
                    here = describe_ranks_interface(results::library_version());
  if (there == here) return;
  Dl_info file{};
  throw InputError(fmt::format("{}: is of {}, must be of {}, that of this program: install both together",
                               dladdr(any_function, &file) ? file.dli_fname : module_name, there, here));
}

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
  const auto start = find_function<LaunchedRanks* (*)()>(module, "easydyn_start_ranks");
  if (!start) throw InputError(fmt::format("{}: {}", module_name, dlerror()));
  require_same_interface(module, reinterpret_cast<void*>(start));
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

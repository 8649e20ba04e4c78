// The module that the program loads if it has been started as one of several ranks; nothing else knows MPI.

#include <petscsys.h>

#include <chrono>
#include <string>
#include <thread>

#include "soil/halo_exchange.hpp"
#include "soil/parallel_run.hpp"

namespace easydyn::soil {
namespace {

class MpiRanks : public LaunchedRanks {
 public:
  MpiRanks() {
    PetscCallAbort(MPI_COMM_WORLD, PetscInitializeNoArguments());
    PetscCallAbort(MPI_COMM_WORLD, PetscPopSignalHandler());  // signals are the program's
    MPI_Comm_rank(PETSC_COMM_WORLD, &rank_);
    MPI_Comm_size(PETSC_COMM_WORLD, &size_);
    MPI_Comm node = MPI_COMM_NULL;
    MPI_Comm_split_type(PETSC_COMM_WORLD, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &node);
    MPI_Comm_size(node, &on_this_node_);
    MPI_Comm_free(&node);
    MPI_Comm_dup(PETSC_COMM_WORLD, &meeting_);
  }
  int rank() const override { return rank_; }
  int size() const override { return size_; }
  int on_this_node() const override { return on_this_node_; }

  // By the first rank and back, so that all have the same bits.
  void sum(double* values, std::size_t count) override {
    const bool is_first = rank_ == 0;
    MPI_Reduce(is_first ? MPI_IN_PLACE : values, is_first ? values : nullptr, static_cast<int>(count),
               MPI_DOUBLE, MPI_SUM, 0, PETSC_COMM_WORLD);
    MPI_Bcast(values, static_cast<int>(count), MPI_DOUBLE, 0, PETSC_COMM_WORLD);
  }
  void maximise(double* values, std::size_t count) override {
    MPI_Allreduce(MPI_IN_PLACE, values, static_cast<int>(count), MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD);
  }
  void broadcast(void* data, std::size_t bytes, int from) override {
    MPI_Bcast(data, static_cast<int>(bytes), MPI_BYTE, from, PETSC_COMM_WORLD);
  }
  std::unique_ptr<Halo> make_halo(const HaloGraph& graph) override { return make_halo_exchange(graph); }

  bool meet(double seconds) override {
    MPI_Request all = MPI_REQUEST_NULL;
    MPI_Ibarrier(meeting_, &all);
    const auto begin = std::chrono::steady_clock::now();
    for (;;) {
      int done = 0;
      MPI_Test(&all, &done, MPI_STATUS_IGNORE);
      if (done) return true;
      if (std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() > seconds)
        return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
  void abort(int status) override { MPI_Abort(MPI_COMM_WORLD, status); }
  void finish() override {
    MPI_Comm_free(&meeting_);
    PetscCallAbort(MPI_COMM_WORLD, PetscFinalize());
  }

 private:
  int rank_ = 0, size_ = 1, on_this_node_ = 1;
  MPI_Comm meeting_ = MPI_COMM_NULL;  // errors meet on a communicator of their own
};

}  // namespace
}  // namespace easydyn::soil

extern "C" const char* easydyn_ranks_interface() {
  static const std::string interface = easydyn::soil::describe_ranks_interface(EASYDYN_VERSION);
  return interface.c_str();
}

extern "C" easydyn::soil::LaunchedRanks* easydyn_start_ranks() {
  static easydyn::soil::MpiRanks ranks;
  return &ranks;
}

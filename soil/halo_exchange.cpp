#include "soil/halo_exchange.hpp"

#include <petscsf.h>

#include <vector>

namespace easydyn::soil {
namespace {

// An error of PETSc ends all ranks.
void check(PetscErrorCode code) {
  PetscCallAbort(PETSC_COMM_WORLD, code);
}

class HaloExchange : public Halo {
 public:
  explicit HaloExchange(const HaloGraph& graph) {
    MPI_Type_contiguous(static_cast<int>(graph.line_bytes), MPI_BYTE, &line_);
    MPI_Type_commit(&line_);
    std::vector<PetscSFNode> roots;
    for (const HaloGraph::Line& line : graph.wanted) roots.push_back({line.rank, line.number});
    check(PetscSFCreate(PETSC_COMM_WORLD, &forest_));
    check(PetscSFSetGraph(forest_, graph.own, static_cast<PetscInt>(roots.size()), nullptr, PETSC_COPY_VALUES,
                          roots.data(), PETSC_COPY_VALUES));
    check(PetscSFSetUp(forest_));
  }
  ~HaloExchange() override {
    check(PetscSFDestroy(&forest_));
    MPI_Type_free(&line_);
  }
  HaloExchange(const HaloExchange&) = delete;
  HaloExchange& operator=(const HaloExchange&) = delete;

  void begin(const void* own, void* received) override {
    own_ = own;
    received_ = received;
    check(PetscSFBcastBegin(forest_, line_, own, received, MPI_REPLACE));
  }
  void end() override { check(PetscSFBcastEnd(forest_, line_, own_, received_, MPI_REPLACE)); }
  // MPI moves messages while one of its functions is called.
  void make_progress() override {
    int arrived = 0;
    MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, PETSC_COMM_WORLD, &arrived, MPI_STATUS_IGNORE);
  }

 private:
  PetscSF forest_ = nullptr;
  MPI_Datatype line_ = MPI_DATATYPE_NULL;
  const void* own_ = nullptr;
  void* received_ = nullptr;
};

}  // namespace

std::unique_ptr<Halo> make_halo_exchange(const HaloGraph& graph) {
  return std::make_unique<HaloExchange>(graph);
}

}  // namespace easydyn::soil

#pragma once
// Private to soil: part of the module that uses MPI.

#include <memory>

#include "soil/ranks.hpp"

namespace easydyn::soil {

/// Halo over PETSc's star forest (PetscSF): lines of a rank are roots, its copies of others' lines are leaves; an
/// exchange is a broadcast from the roots to their leaves. All ranks of PETSC_COMM_WORLD make it together.
std::unique_ptr<Halo> make_halo_exchange(const HaloGraph& graph);

}  // namespace easydyn::soil

#pragma once

#include <cstdio>
#include <vector>

#include "soil/site.hpp"
#include "soil/surface_loads.hpp"
#include "soil/vibrations.hpp"
#include "soil/wave_solver.hpp"

namespace easydyn::soil {

/// Solver of the waves that these loads send through the ground of this site. The loads are first
/// limited by limit_band(): unchanged up to Site::highest_frequency, nothing from 1.25 times it. Nothing above
/// Site::highest_frequency is claimed.
/// @param ranks  see WaveSolver
/// @throws ModelError if site, loads and options do not fit
WaveSolver make_solver(const Site& site, const SurfaceLoads& loads, const SolverOptions& options = {},
                       Ranks* ranks = nullptr);

/// Runs the solver and draws up the indicators. Progress goes to `out` (nullptr: silent).
/// @param control  what accompanies the run; its `progress` is not used
/// @throws SolverError if the motion grows without bound, RunStopped if the run was stopped
Vibrations predict_vibrations(const Site& site, const SurfaceLoads& loads, WaveSolver& solver,
                              std::FILE* out = stdout, const RunControl& control = {});

/// Everything but the motion and what depends on the solver: receivers, footprints, site.
Vibrations describe_prediction(const Site& site, const SurfaceLoads& loads);

/// Rows of the table of parameters for the settings of the site file, but for those of the mesh.
void add_settings(std::vector<Parameter>& rows, const Site& site);

/// Rows of the table of parameters for solver, boundary, mesh and time step.
void add_mesh(std::vector<Parameter>& rows, const Site& site, WaveSolver& solver);

/// Takes the motion over and draws up the indicators.
void set_motion(Vibrations& vibrations, GroundMotion motion);

/// Mesh, memory, steps and expected time, before a run.
void print_run_summary(std::FILE* out, const Site& site, const SurfaceLoads& loads, WaveSolver& solver);

/// Size of the checkpoint and the snapshots that a run will write.
/// @throws InputError if the disk has no room for them
void print_file_summary(std::FILE* out, WaveSolver& solver, const RunControl& control);

/// PPV, KB_Fmax and VdB of every receiver as a table.
void print_indicators(std::FILE* out, const Vibrations& vibrations);

}  // namespace easydyn::soil

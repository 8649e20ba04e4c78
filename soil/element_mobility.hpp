#pragma once

#include <vector>

#include "soil/mobility_file.hpp"
#include "soil/surface_loads.hpp"
#include "soil/wave_solver.hpp"

namespace easydyn::soil {

struct ElementMobilityOptions {
  SolverOptions solver;  ///< model, output step and observed footprints are chosen here, not by the caller
  double window = 0;     ///< [s] of the responses; 0: estimate_element_window()
  bool removes_time_error = true;  ///< false: to see what it is worth
};

/// Impulse responses by finite elements: one run of a quarter model under a pulse on the footprint at the origin, all
/// receivers at |dx|, |dy|, z, and the mean displacement of all neighbouring footprints.
///
/// The pulse is p(t) = exp(-(t / s)^2), with a tenth of its spectrum left at 1.25 times the highest frequency, where
/// loads end. The response is divided by its transform P, and by that of the leapfrog, which at step dt solves the equations
/// of motion at a shifted frequency:
///
///   H(i w) = U(z) / P(z),   i w = (2 / dt) sinh(z dt / 2),   U(z) = sum_n u_n e^(-z t_n)
///
/// so that the mass is that of continuous time. Re z > 0 (the exponential window of ImpulseSynthesis) bounds what a record
/// that has not died out does. The mesh resolves the highest frequency as in a run under all loads; between 1.25 times
/// it and 1.75 times it the responses hold what the mesh makes of it, but loads have nothing there.
///
/// The lattice reaches as far along x as receivers are from loads. Footprints are farther from each other: on a site without
/// blocks the responses beyond are those of the layered half-space, in a window of their own, which saves half of the
/// mesh. So are those of footprints nearer to each other than an element is long, the loaded one first of all: elements
/// that only resolve the waves are too stiff under a smaller load. With blocks these are as the elements have them.
/// StoredMobility::shift_methods says which are which.
///
/// The ground may vary with y and z: blocks without ends along x, symmetric about y = 0.
class ElementMobility {
 public:
  /// @throws ModelError if a block ends along x or is not symmetric about y = 0, footprints beside blocks lie off y = 0,
  ///         footprints differ or are loaded horizontally, a value is out of range or the fields do not fit in memory
  ElementMobility(const Site& site, const std::vector<Footprint>& footprints,
                  const ElementMobilityOptions& options = {});

  WaveSolver& solver() { return solver_; }
  const Site& model() const { return model_; }          ///< the site with the receivers of the run
  const SurfaceLoads& pulse() const { return pulse_; }  ///< [N]
  double window() const { return window_; }  ///< [s] of the responses, by elements, from the pulse on

  /// @throws SolverError if the motion grows without bound, RunStopped if the run was stopped
  StoredMobility compute(const RunControl& control = {});

 private:
  Mobility compute_layered_shifts(GroundDamping damping);

  Site site_;
  ElementMobilityOptions options_;
  Mobility near_, far_;  // distances by elements; shifts by the layered half-space
  double window_;
  SurfaceLoads pulse_;
  Site model_;
  WaveSolver solver_;
};

/// Length of the responses [s]: r / (0.8 c_S) + max(0.5 s, 10 / f, 8 times 2 sum h / c_S).
///
/// r the farthest of those of these receivers and footprints that elements compute, c_S the slowest shear wave, f the highest
/// frequency, h / c_S the way through each layer above the half-space: the slowest waves pass, the low frequencies that
/// are most of a response at low f fade, and echoes go eight times down and up. What is left then is below 1 % where soft
/// layers have a third of the stiffer ground's speed and 3 % of damping; ResponseRest finds where it is more.
double estimate_element_window(const Site& site, const Mobility& distances);

}  // namespace easydyn::soil

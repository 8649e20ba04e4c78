#pragma once

#include "easydyn/mbs/system.hpp"

namespace easydyn {

struct StaticOptions {
  double tolerance = 1e-9;  ///< largest residual of KINSOL, relative to the largest force at the start
  int max_iterations = 200;
  bool damping = true;  ///< false: Newton alone, to whatever equilibrium it finds
};

/// Coordinates at which the residual vanishes for the given time, rates and accelerations:
///
///   r(q, qd, qdd, t) = 0 for q        qd = qdd = 0: static equilibrium
///
/// The given rates and accelerations act as constant damping and inertia forces. KINSOL (Newton with line
/// search) on the bodies' coordinates and the port forces of structures, which are condensed out. Where it does not get
/// through, the system is let go with heavy damping from the guess, to a stable equilibrium. A last undamped Newton takes
/// the residual to rounding.
/// @param guess  start of the iteration; its t, qd and qdd are kept
/// @throws SolverError naming the coordinate with the largest residual
State solve_static_equilibrium(System& system, const State& guess, const StaticOptions& options = {});
State solve_static_equilibrium(System& system, const StaticOptions& options = {});

/// A smooth start for a load that moves over linear structures from t = guess.t on. Static equilibria at t - 2 dt ...
/// t + 2 dt give rates and accelerations of the structures by central differences; the coordinates then balance the
/// damping and inertia forces that these produce, so the residual vanishes and the structures get no jolt.
///
/// Bodies start at rest in their coordinates (imposed motions go on): a soft suspension does not follow the ripple of
/// discrete supports, and differences of the ripple would set it swinging.
/// @param dt  difference step [s]; the load should move by a small part of the shortest feature
State solve_quasi_static_motion(System& system, const State& guess, double dt,
                                const StaticOptions& options = {});

}  // namespace easydyn

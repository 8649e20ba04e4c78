#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "track/flexible_track.hpp"
#include "track/passage_stepper.hpp"
#include "track/track_contact.hpp"

namespace easydyn::track {

struct PassageOptions {
  double duration = 1;        ///< [s], > 0
  double step = 1e-4;         ///< of Newmark's method [s], > 0: 300 Hz keeps its period within 0.3 %
  double window = 0;          ///< length of track that travels with the train [m]; 0: all of it at once
  bool use_kernel = false;    ///< the general-purpose `Newmark` of the kernel, as a check; slow, no window
  double run_in = 0;          ///< time before t = 0 in which the train runs and nothing is recorded [s], >= 0
  double output_step = 5e-4;  ///< [s], a multiple of the step
  double first_sleeper_x = 0;      ///< sleepers from here ...
  double last_sleeper_x = 0;       ///< ... to here [m] are recorded; at least one must stand there
  double start_difference = 2e-3;  ///< of the quasi-static start [s]
};

/// What a passage gives, one row per output time. Track displacements are positive **downward**.
struct Passage {
  Eigen::VectorXd time;                                ///< nt [s], from 0
  std::vector<std::string> contact_names;              ///< nw
  Eigen::MatrixXd contact_force, contact_position;     ///< nt x nw [N], [m]
  Eigen::VectorXd largest_contact_force;               ///< nw, over every time step [N]
  std::string foundation;                              ///< kind_of() the foundation
  Eigen::VectorXd smallest_contact_force;              ///< nw, over every time step [N]
  Eigen::VectorXi contact_losses;                      ///< nw, how often a wheel has left the rail
  Eigen::VectorXd contact_loss_time;                   ///< nw, total time without contact [s]
  Eigen::VectorXd longest_contact_loss;                ///< nw [s]
  Eigen::VectorXd sleeper_x;                           ///< ns recorded sleepers [m]
  Eigen::MatrixXd rail_deflection;                     ///< nt x ns, above the sleepers [m]
  Eigen::MatrixXd sleeper_displacement;                ///< nt x ns [m]
  Eigen::MatrixXd foundation_displacement;             ///< nt x ns [m]; empty on rigid ground
  Eigen::MatrixXd ballast_reaction;                    ///< nt x ns [N], compression positive
  std::vector<std::string> coordinate_names;           ///< nq coordinates of the bodies
  Eigen::MatrixXd coordinates;                         ///< nt x nq [m, rad]
  std::vector<std::string> body_names;                 ///< nb
  Eigen::MatrixXd body_acceleration;                   ///< nt x nb, vertical [m/s^2]
  Eigen::MatrixXd body_height;                         ///< nt x nb, z of the centre of mass [m]
  Eigen::MatrixXd body_pitch;                          ///< nt x nb, rotation about y, nose down [rad]
  Eigen::VectorXd kinetic_energy, potential_energy;    ///< nt [J]
  Eigen::VectorXd dissipated_energy, supplied_energy;  ///< nt [J], since the start
  double static_ballast_reaction = 0;  ///< of all sleepers together, at rest at the place of the start [N]
  double track_weight =
      0;  ///< per spacing, above the springs of the reaction: rails, sleeper, slab, ballast mass [N]
  std::vector<std::string> warnings;  ///< where a result leaves the range of the model
  PassageStepper::Statistics statistics;
  std::size_t memory = 0;  ///< of the results and of what solves the track [bytes]
};

/// Runs a system that moves over a flexible track, from the smooth quasi-static start at t = -run_in
/// (`solve_quasi_static_motion`) with Newmark's method (`PassageStepper`).
///
/// With a window the cost of a step does not depend on the length of the track. What the window leaves behind is at rest,
/// and recorded so. Energies: kinetic and potential ones of bodies, contacts and the window; works by the trapezoidal rule
/// for bodies and contacts, exactly as Newmark's method has it for the track.
/// @param contacts  wheels and loads on the rail, in the order in which the system applies them; the ballast of hanging
///                  sleepers needs no mention
/// @param progress  called with the fraction done, of the run-in too
/// @throws ModelError on impossible options, SolverError if a step does not converge
Passage compute_passage(System& system, const FlexibleTrack& track,
                        const std::vector<const TrackContact*>& contacts, const PassageOptions& options,
                        const std::function<void(double fraction)>& progress = {});

}  // namespace easydyn::track

#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <vector>

#include "easydyn/mbs/system.hpp"
#include "track/flexible_track.hpp"
#include "track/track_contact.hpp"
#include "track/track_window.hpp"

namespace easydyn::track {

struct PassageStepperOptions {
  double step = 1e-4;        ///< h [s], > 0
  double window = 0;         ///< length of track around the train that is solved [m]; 0: the whole track
  double tolerance = 1e-10;  ///< last correction of accelerations and contact forces, relative
  int max_iterations = 25;
};

/// Newmark's method (beta = 1/4, gamma = 1/2) for bodies that run over a long track: the equations of the general-purpose
/// `Newmark`, solved in the way that this problem allows.
///
///   bodies:    r(q, qd, qdd, t) = sum_i B_i^T F_i        B_i: gradient of the height of contact i in q
///   track:     A y = -C qd* - K q* + sum_i N_i^T F_i     (TrackWindow, one banded substitution)
///   contacts:  F_i = F_i(a_i)                            a_i falls as the rail goes down or the body up
///
/// Without the contacts the bodies are linear, or nearly so: their matrix J = dr/dqdd is factorised once. Then approach i
/// is an affine function of the forces,
///
///   a_i = a_i0 - h^2/4 sum_j (N_i A^-1 N_j^T + B_i J^-1 B_j^T) (F_j - F_j0),
///
/// with a symmetric positive definite matrix, and all nonlinear laws rise monotonically: contact by contact, each solved
/// for its own force (nonlinear Gauss-Seidel), the forces converge whatever opens or closes. An evaluation of the whole
/// system gives the true residual; if the bodies were not quite linear it is repeated.
///
/// The ballast of hanging sleepers (`apply_hanging_sleepers`) is a force of the same kind between sleeper and ground.
class PassageStepper {
 public:
  /// @param contacts  all that touches the rail, in the order in which forces() does
  /// @param start     of the whole system, as `solve_quasi_static_motion` gives it
  /// @throws ModelError if the system has first-order states, velocity constraints or other structures, touches the track
  ///         elsewhere, or leaves no room in the window
  PassageStepper(System& system, const FlexibleTrack& track, std::vector<const TrackContact*> contacts,
                 const State& start, const PassageStepperOptions& options);

  void step();

  double t() const { return t_; }
  const Eigen::VectorXd& q() const { return q_; }  ///< of the bodies
  const Eigen::VectorXd& qd() const { return qd_; }
  const Eigen::VectorXd& qdd() const { return qdd_; }
  const TrackWindow& window() const { return window_; }

  /// Energies at the end of the step, and the powers of bodies and contacts; `dissipated` without the track, whose share
  /// of the step is window().dissipated_in_step().
  EnergyBalance energy() const;

  struct Statistics {
    long steps = 0, evaluations = 0, jacobians = 0, moves = 0;
  };
  const Statistics& statistics() const { return statistics_; }

 private:
  /// What acts at a port: a contact, or the ballast of a hanging sleeper.
  struct Partner {
    const TrackContact* contact;
    UnilateralBallast ballast;
    double direction;  // of F on the port: +1 where it falls from above
    const Body* body() const { return contact ? contact->body() : nullptr; }
  };
  TrackContact::Force force_after(std::size_t port, double change, double rate_change) const;
  void evaluate();
  void compute_jacobian();
  void find_contact_forces();
  void update_responses();
  int wanted_first_bay() const;

  System& system_;
  const FlexibleTrack& track_;
  std::vector<Partner> partners_;  // by port
  PassageStepperOptions options_;
  TrackWindow window_;
  System::PortMotionFunction motion_;
  Statistics statistics_;
  double start_, t_;
  Eigen::VectorXd q_, qd_, qdd_;  // of the bodies
  Eigen::VectorXd q_star_, qd_star_;
  Eigen::VectorXd F_, F_evaluated_;  // on the ports: wanted, and as the system applied them
  Eigen::VectorXd residual_;         // of the bodies, without contacts
  Eigen::VectorXd correction_, approach_, lift_;
  Eigen::MatrixXd B_, inverse_, body_response_, track_response_, slope_response_,
      response_;  // B: one row per contact
  std::vector<PortShape> shapes_;
  std::vector<PortMotion> free_;
  bool knows_responses_ = false, jacobian_known_ = false;
  std::size_t port_ = 0;
};

}  // namespace easydyn::track

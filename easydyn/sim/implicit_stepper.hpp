#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <functional>
#include <limits>
#include <memory>

#include "easydyn/sim/accelerations.hpp"
#include "easydyn/sim/integrator.hpp"

namespace easydyn {

class Condensation;

/// Options of the implicit one-step methods.
struct StepperOptions {
  double step = 1e-3;          ///< h [s]: the step, or the first one where it varies; > 0
  bool variable_step = false;  ///< choose h from the local error
  /// Bound of the local error of each coordinate [m, rad] and first-order state per step; variable step only.
  double tolerance = 1e-6;
  double min_step = 1e-10;                                    ///< [s]
  double max_step = std::numeric_limits<double>::infinity();  ///< [s]
  double newton_tolerance = 1e-10;  ///< last Newton correction of accelerations and port forces, relative
  int max_iterations = 25;
};

/// The family of implicit one-step methods of second order on the residual of a system: Newmark, HHT and
/// generalised-alpha. The equations of motion hold at the end of every step; the difference is in the pseudo
/// accelerations a that carry the motion on (Arnold & Bruels, Multibody Syst. Dyn. 18, 2007):
///
///   (1 - alpha_m) a_1 + alpha_m a_0 = (1 - alpha_f) qdd_1 + alpha_f qdd_0
///   q_1  = q_0 + h qd_0 + h^2 ((1/2 - beta) a_0 + beta a_1)
///   qd_1 = qd_0 + h ((1 - gamma) a_0 + gamma a_1)          r(q_1, qd_1, qdd_1, t_1) = 0 for qdd_1
///
/// First-order states follow as the rates qd do; velocity constraints hold at the end of every step.
///
/// Unknowns of Newton's iteration are the accelerations of the bodies' coordinates, the rates of first-order states,
/// the constraint forces and the port forces of linear structures, which are condensed out (`Condensation`) with one
/// factorisation per step size. The iteration matrix is kept until convergence slows down.
///
/// With a variable step the local error is estimated for each coordinate by
/// |beta - 1/6 + (alpha_m - alpha_f) / 2| h^2 |qdd_1 - qdd_0| (after Zienkiewicz & Xie, Earthquake Eng. Struct.
/// Dyn. 20, 1991), for each first-order state from the changes of its rate over this step and the one before, h_0, by
/// |1/12 - (alpha_m - alpha_f) (1/2 - alpha_f)| h |xd_1 - xd_0 - (h / h_0) (xd_0 - xd_-1)|; in the first step the
/// earlier change counts as zero, which is too much rather than too little. `tolerance` bounds this leading term per step
/// (the error itself reached 2.1 times as much where the term passes zero): it is not the accuracy of the result after
/// many steps.
class ImplicitStepper : public Integrator {
 public:
  ~ImplicitStepper() override;

  void step() override;
  /// Meets t_end within a millionth of a step (the last step is shortened if need be).
  void advance(double t_end, const Watcher& after_each_step = {}) override;

  struct Statistics {
    long steps = 0, rejected = 0, evaluations = 0, jacobians = 0, factorisations = 0;
  };
  const Statistics& statistics() const { return statistics_; }
  double step_size() const { return h_; }

 protected:
  struct Coefficients {
    double alpha_m, alpha_f, beta, gamma;
  };
  /// @throws ModelError if an option is out of its range
  ImplicitStepper(const char* method, const Coefficients& coefficients, System& system, State state,
                  const StepperOptions& options);
  /// The system's initial state with accelerations that satisfy the equations of motion.
  static State consistent_initial_state(System& system);

 private:
  void take_initial_unknowns(Eigen::VectorXd& z) const;
  void make_consistent();
  bool try_step(double h, State& next);  // false: Newton did not converge
  void accept(State& next);
  void prepare(double h);
  void set_unknowns(const Eigen::VectorXd& z, State& next);
  void evaluate(const Eigen::VectorXd& z, State& next, Eigen::VectorXd& residual);
  void compute_jacobian(const Eigen::VectorXd& z, State& next);
  double local_error(const State& next, double h) const;

  std::string method_;
  Coefficients c_;
  double beta_, gamma_;  // weights of qdd_1 in q_1 and qd_1
  StepperOptions options_;
  Statistics statistics_;
  int n_bodies_, n_first_, n_constraints_;
  double h_;                  // size of the next step
  double prepared_step_ = 0;  // for which condensation and Jacobian hold
  std::unique_ptr<Condensation> condensation_;
  Eigen::VectorXd last_change_;  // of the rates of first-order states, per second
  Eigen::VectorXd port_forces_, q_star_, qd_star_, x_star_, y_;
  Eigen::VectorXd a_, w_;  // pseudo accelerations of coordinates and pseudo rates of first-order states
  // Magnitudes of the unknowns: those of the last steps, never below the floors; renewed by accepted steps only.
  Eigen::VectorXd floors_, scale_, next_scale_;
  // Kept from step to step, so that no memory is asked for again.
  State next_;
  Eigen::VectorXd z_, residual_, shifted_residual_, shifted_, correction_, carried_, forces_, forces_before_,
      b_;
  Eigen::MatrixXd differences_;
  Eigen::PartialPivLU<Eigen::MatrixXd> jacobian_;
  bool jacobian_known_ = false;
  double last_residual_ = 0;
};

/// Newmark's method, beta = 1/4, gamma = 1/2 (trapezoidal rule): no numerical damping, unconditionally stable for
/// linear systems; the energy of a nonlinear conservative system oscillates at second order. Period error of a mode
/// (w h)^2 / 12.
class Newmark : public ImplicitStepper {
 public:
  /// Starts from the system's initial state with accelerations that satisfy the equations of motion.
  explicit Newmark(System& system, const StepperOptions& options = {})
      : Newmark(system, consistent_initial_state(system), options) {}
  /// Starts from a given state. Accelerations that do not satisfy the equations of motion are replaced by those that do, and
  /// velocities are projected on the velocity constraints.
  Newmark(System& system, State state, const StepperOptions& options = {})
      : ImplicitStepper("Newmark", {0, 0, 0.25, 0.5}, system, std::move(state), options) {}
};

/// Chung & Hulbert's generalised-alpha method (J. Appl. Mech. 60, 1993): damps what the step does not resolve down
/// to the spectral radius rho per step, and the rest as little as a method of second order can.
///
///   alpha_m = (2 rho - 1) / (rho + 1)   alpha_f = rho / (rho + 1)
///   gamma = 1/2 - alpha_m + alpha_f     beta = (1 - alpha_m + alpha_f)^2 / 4
class GeneralizedAlpha : public ImplicitStepper {
 public:
  /// @param spectral_radius  rho at infinite frequency, 0 (annihilates) to 1 (keeps everything)
  explicit GeneralizedAlpha(System& system, const StepperOptions& options = {}, double spectral_radius = 0.8)
      : GeneralizedAlpha(system, consistent_initial_state(system), options, spectral_radius) {}
  GeneralizedAlpha(System& system, State state, const StepperOptions& options = {},
                   double spectral_radius = 0.8);
};

/// The method of Hilber, Hughes & Taylor (Earthquake Eng. Struct. Dyn. 5, 1977): alpha_m = 0, alpha_f = -alpha,
/// gamma = 1/2 - alpha, beta = (1 - alpha)^2 / 4.
class Hht : public ImplicitStepper {
 public:
  /// @param alpha  -1/3 (strongest damping of high frequencies) to 0 (Newmark)
  explicit Hht(System& system, const StepperOptions& options = {}, double alpha = -0.1)
      : Hht(system, consistent_initial_state(system), options, alpha) {}
  Hht(System& system, State state, const StepperOptions& options = {}, double alpha = -0.1);
};

}  // namespace easydyn

#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <functional>
#include <limits>
#include <memory>

#include "easydyn/mbs/system.hpp"

namespace easydyn {

class Condensation;

struct NewmarkOptions {
  double step = 1e-3;          ///< h [s]: the step, or the first one where it varies; > 0
  bool variable_step = false;  ///< choose h from the local error
  double tolerance =
      1e-6;  ///< bound of the local error of each coordinate per step [m, rad]; variable step only
  double min_step = 1e-10;                                    ///< [s]
  double max_step = std::numeric_limits<double>::infinity();  ///< [s]
  double newton_tolerance = 1e-10;  ///< last Newton correction of accelerations and port forces, relative
  int max_iterations = 25;
};

/// Newmark's method with beta = 1/4, gamma = 1/2 (trapezoidal rule) on the residual of a system:
///
///   q_1  = q_0 + h qd_0 + h^2 ((1/2 - beta) qdd_0 + beta qdd_1)
///   qd_1 = qd_0 + h ((1 - gamma) qdd_0 + gamma qdd_1)          r(q_1, qd_1, qdd_1, t_1) = 0 for qdd_1
///
/// Second order, no numerical damping, unconditionally stable for linear systems; the energy of a nonlinear
/// conservative system oscillates at second order. Period error of a mode (w h)^2 / 12.
///
/// Unknowns of Newton's iteration are the accelerations of the bodies' coordinates and the port forces of
/// linear structures, which are condensed out (`Condensation`) with one factorisation per step size. The
/// iteration matrix is kept until convergence slows down.
///
/// With a variable step the local error is estimated by |beta - 1/6| h^2 |qdd_1 - qdd_0| for each coordinate
/// (Zienkiewicz & Xie, Earthquake Eng. Struct. Dyn. 20, 1991); `tolerance` bounds it per step: it is not the
/// accuracy of the result after many steps.
class Newmark {
 public:
  /// Starts from the system's initial state with accelerations that satisfy the equations of motion.
  Newmark(System& system, const NewmarkOptions& options = {});
  /// Starts from a given state, taken as it is (qdd included).
  /// @throws ModelError if an option is out of its range
  Newmark(System& system, State state, const NewmarkOptions& options = {});
  ~Newmark();

  const State& state() const { return state_; }
  /// One accepted step. @throws SolverError naming time, step, residual and what to try
  void step();
  /// Steps until t_end, met within a millionth of a step (the last step is shortened if need be).
  void advance(double t_end, const std::function<void(const State&)>& after_each_step = {});

  struct Statistics {
    long steps = 0, rejected = 0, evaluations = 0, jacobians = 0, factorisations = 0;
  };
  const Statistics& statistics() const { return statistics_; }
  double step_size() const { return h_; }

 private:
  bool try_step(double h, State& next);  // false: Newton did not converge
  void accept(State& next);
  void prepare(double h);
  void set_unknowns(const Eigen::VectorXd& z, State& next);
  void evaluate(const Eigen::VectorXd& z, State& next, Eigen::VectorXd& residual);
  void compute_jacobian(const Eigen::VectorXd& z, State& next, const Eigen::VectorXd& residual);
  double local_error(const State& next, double h) const;

  System& system_;
  State state_;
  NewmarkOptions options_;
  Statistics statistics_;
  int n_bodies_;
  double h_;                  // size of the next step
  double prepared_step_ = 0;  // for which condensation and Jacobian hold
  std::unique_ptr<Condensation> condensation_;
  Eigen::VectorXd port_forces_, q_star_, qd_star_, y_;
  // Magnitudes of the unknowns: those of the last steps, never below the floors; renewed by accepted steps only.
  Eigen::VectorXd floors_, scale_, next_scale_;
  Eigen::PartialPivLU<Eigen::MatrixXd> jacobian_;
  bool jacobian_known_ = false;
  double last_residual_ = 0;
};

/// Sets state.qdd so that the equations of motion hold: M qdd = Q - h.
/// @throws SolverError if the mass matrix is singular
void set_consistent_accelerations(System& system, State& state);

}  // namespace easydyn

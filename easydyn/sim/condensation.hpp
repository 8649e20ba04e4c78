#pragma once

#include <Eigen/Core>
#include <vector>

#include "easydyn/mbs/system.hpp"
#include "easydyn/sim/banded_cholesky.hpp"

namespace easydyn {

/// The linear structures of a system, solved out of an implicit step so that only their port forces remain.
///
/// A step (Newmark, static equilibrium) asks of each structure that A y = b + sum_l N_l^T F_l with
/// A = a_M M + a_C C + a_K K, the same at every step. With G = A^-1 N^T (one column per port) the motion at a
/// port is an affine function of the few port forces F:
///
///   y = y_free + G F      q = q_base + c_q y      qd = qd_base + c_v y
///
/// so the nonlinear problem keeps the bodies' coordinates and F only (Schur complement). The free response
/// and all columns of G come from one pass of banded substitution with several right-hand sides.
class Condensation {
 public:
  /// A = a_M M + a_C C + a_K K of every structure, factorised.
  Condensation(const System& system, double a_M, double a_C, double a_K);

  /// Solves for y_free and G: b and the bases have the size of all structure coordinates together.
  /// @param ports  where the structures are touched
  void solve(const Eigen::VectorXd& b, const std::vector<System::PortRecord>& ports);
  /// Whether these ports touch elsewhere than those of the last solve(): then G is not theirs.
  bool ports_moved(const std::vector<System::PortRecord>& ports) const;
  /// How y enters coordinates and rates.
  void set_bases(const Eigen::Ref<const Eigen::VectorXd>& q_base, double c_q,
                 const Eigen::Ref<const Eigen::VectorXd>& qd_base, double c_v);
  /// Motion of a port for given port forces F.
  PortMotion motion(int structure, const PortShape& shape, const Eigen::VectorXd& F) const;
  /// y = y_free + G F.
  void compute_response(const Eigen::VectorXd& F, Eigen::Ref<Eigen::VectorXd> y);

 private:
  const System& system_;
  std::vector<BandedCholesky> factors_;
  std::vector<RightHandSides> X_;          // per structure: y_free, then the columns of its ports
  std::vector<std::vector<int>> port_of_;  // per structure: which port each column belongs to
  std::vector<PortShape> shapes_;          // of the ports, as condensed
  std::vector<int> offset_;                // of each structure among the structure coordinates
  Eigen::VectorXd q_base_, qd_base_, weights_;
  double c_q_ = 0, c_v_ = 0;
};

}  // namespace easydyn

#pragma once

#include <Eigen/SparseCore>
#include <array>

#include "track/rail_beam.hpp"
#include "track/track_data.hpp"

namespace easydyn::track {

/// A sparse row over the track's degrees of freedom: the rail's deflection at one point and its derivatives,
///   w(x) = sum_i N[i] q[dof[i]],  and so for w' and w''.
struct RailPoint {
  std::array<int, 4> dof;
  BeamShape shape;

  double deflection(const Eigen::Ref<const Eigen::VectorXd>& q) const { return dot(shape.N, q); }  ///< w [m]
  double slope(const Eigen::Ref<const Eigen::VectorXd>& q) const { return dot(shape.dN, q); }      ///< w' [1]
  double curvature(const Eigen::Ref<const Eigen::VectorXd>& q) const {
    return dot(shape.ddN, q);
  }  ///< w'' [1/m]

  double dot(const Eigen::RowVector4d& row, const Eigen::Ref<const Eigen::VectorXd>& q) const {
    return row[0] * q[dof[0]] + row[1] * q[dof[1]] + row[2] * q[dof[2]] + row[3] * q[dof[3]];
  }
};

/// Matrices of a straight track of n bays, rail on pads, sleepers, ballast and foundation:
///
///   M qdd + C qd + K q = f,   M, C, K constant, sparse, symmetric
///
/// q: rail deflections [m] and slopes [rad], sleeper and foundation displacements [m]; everything positive
/// **downward**, for the whole track. Sleepers stand at x = begin + j spacing, j = 0..n, the rail ends at the
/// first and the last of them. Unknowns are numbered bay by bay
///   u_f[j], u_s[j], w, w' of the node above sleeper j, w, w' of the nodes up to the next sleeper
/// so that the half-bandwidth is that of one bay: 2 elements_per_bay + 2 (one less on rigid ground).
/// Without foundation mass M is singular (rows of u_f), K never is.
class TrackModel {
 public:
  /// @param data   the track; a copy is kept
  /// @param bays   number of sleeper spacings, >= 1 and >= 2 x the absorbing bays
  /// @param begin  x of the first sleeper [m]
  /// @throws ModelError on impossible data
  TrackModel(const TrackData& data, int bays, double begin = 0);

  const TrackData& data() const { return data_; }
  const Eigen::SparseMatrix<double>& M() const { return M_; }
  const Eigen::SparseMatrix<double>& C() const { return C_; }
  const Eigen::SparseMatrix<double>& K() const { return K_; }
  int size() const { return static_cast<int>(K_.rows()); }
  int half_bandwidth() const { return half_bandwidth_; }  ///< largest |i - j| of an entry of M, C, K

  int bays() const { return bays_; }
  int sleepers() const { return bays_ + 1; }
  int nodes() const { return bays_ * data_.elements_per_bay + 1; }  ///< of the rail
  double begin() const { return begin_; }                           ///< x of the first sleeper [m]
  double end() const { return begin_ + bays_ * data_.sleeper_spacing; }
  double node_x(int node) const { return begin_ + node * data_.sleeper_spacing / data_.elements_per_bay; }
  double sleeper_x(int j) const { return begin_ + j * data_.sleeper_spacing; }

  int rail_dof(int node) const;  ///< of the deflection; the slope follows it
  int sleeper_dof(int j) const;
  int foundation_dof(int j) const;  ///< -1 on rigid ground

  /// The rail at position x. @throws ModelError if x is off the rail
  RailPoint rail_point(double x) const;
  /// f for a vertical force on the rail at x, positive downward [N].
  Eigen::VectorXd rail_load(double x, double force) const;

  /// What the soil receives under sleeper j, positive downward [N]: k_b (u_s - u_f) + d_b (u_s' - u_f').
  /// @param q, qd  coordinates and rates: vectors, or functions of the coordinate's number
  template <class Q, class Qd>
  double ballast_reaction(int j, const Q& q, const Qd& qd) const {
    const int u_s = sleeper_dof(j), u_f = foundation_dof(j);
    return data_.ballast_stiffness * (q(u_s) - (rigid_ ? 0 : q(u_f))) +
           data_.ballast_damping * (qd(u_s) - (rigid_ ? 0 : qd(u_f)));
  }
  Eigen::VectorXd ballast_reactions(const Eigen::Ref<const Eigen::VectorXd>& q,
                                    const Eigen::Ref<const Eigen::VectorXd>& qd) const;

 private:
  TrackData data_;
  int bays_;
  double begin_;
  int rigid_;  ///< 1 on rigid ground, else 0: unknowns less per bay
  int dofs_per_bay_;
  int half_bandwidth_ = 0;
  Eigen::SparseMatrix<double> M_, C_, K_;

  double absorption(double x) const;  ///< t^3, 0 inside, 1 at the ends
};

}  // namespace easydyn::track

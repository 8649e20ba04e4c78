#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <vector>

#include "easydyn/mbs/linear_structure.hpp"
#include "track/rail_beam.hpp"
#include "track/track_data.hpp"
#include "track/unilateral_ballast.hpp"

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

/// Matrices of a straight track of n bays, rail on pads, sleepers or slab, ballast and foundation:
///
///   M qdd + C qd + K q = f,   M, C, K constant, sparse, symmetric
///
/// q: rail deflections [m] and rotations [rad], sleeper and foundation displacements [m]; everything positive
/// **downward**, for the whole track. Sleepers stand at x = begin + j spacing, j = 0..n, the rail ends at the
/// first and the last of them. Unknowns are numbered bay by bay, those in brackets where the data have them:
///
///   [u_f], [u_b ballast mass], [u_u above the ballast, below the under-sleeper pad], u_s, [slope of the slab],
///   w, phi of the node above sleeper j, w, phi of the nodes up to the next sleeper
///
/// so that the half-bandwidth is that of one bay, 2 elements_per_bay + support_dofs() (one more with a slab).
/// M is singular where an unknown has no mass (u_u; u_f without foundation mass), K never is.
///
/// A hanging sleeper (`SupportVariation::gap` > 0) has no ballast in C and K: `apply_hanging_sleepers` adds it
/// as a force.
class TrackModel {
 public:
  /// @param data   the track; a copy is kept
  /// @param bays   number of sleeper spacings, >= 1 and >= 2 x the absorbing bays
  /// @param begin  x of the first sleeper [m]
  /// @throws ModelError on impossible data
  TrackModel(const TrackData& data, int bays, double begin = 0);

  const TrackData& data() const { return data_; }
  const Eigen::SparseMatrix<double>& M() const { return M_; }
  const Eigen::SparseMatrix<double>& C() const { return C_; }  ///< with the absorbing ends
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

  int rail_dof(int node) const;  ///< of the deflection; the rotation follows it
  int sleeper_dof(int j) const;
  int foundation_dof(int j) const;  ///< -1 on rigid ground
  int ballast_dof(int j) const;     ///< of the ballast mass, -1 without
  int ballast_top_dof(
      int j) const;  ///< what rests on the ballast: lower face of the under-sleeper pad, or sleeper
  int slab_slope_dof(int j) const;  ///< -1 without a slab

  // ---- windows: bays first .. first + bays of a long track as a track of their own ----

  int dofs_per_bay() const { return dofs_per_bay_; }
  int support_dofs() const { return support_dofs_; }  ///< below the rail, per sleeper
  /// First unknown of a bay, 0 .. bays(): those of its sleeper's support, then the rail's. Bays f .. f + n with the
  /// sleeper that closes them are the unknowns from first_dof(f), dofs_of(n) of them: a principal block of M, C, K.
  int first_dof(int bay) const { return bay * dofs_per_bay_; }
  int dofs_of(int bays) const { return bays * dofs_per_bay_ + support_dofs_ + 2; }
  /// All bays alike, apart from the ends of the track: no variation of supports, no gap.
  bool is_uniform() const { return is_uniform_; }
  /// C without what the absorbing ends add.
  const Eigen::SparseMatrix<double>& inner_damping() const { return C_inner_; }
  /// What absorbing ends add to C on a track of so many bays, numbered from its first unknown: dofs_of(bays) square;
  /// C() = inner_damping() + compute_end_damping(bays()). @throws ModelError if two ends do not fit
  Eigen::SparseMatrix<double> compute_end_damping(int bays) const;

  /// The rail at position x. @throws ModelError if x is off the rail
  RailPoint rail_point(double x) const;
  /// f for a vertical force on the rail at x, positive downward [N].
  Eigen::VectorXd rail_load(double x, double force) const;

  /// What the soil receives under sleeper j, positive downward [N]: k_b (u_s - u_f) + d_b (u_s' - u_f'); with ballast
  /// mass the force of the springs below it, k_g (u_b - u_f) + d_g (u_b' - u_f'); of a hanging sleeper without
  /// ballast mass that of `UnilateralBallast`.
  /// @param q, qd  coordinates and rates: vectors, or functions of the coordinate's number
  template <class Q, class Qd>
  double ballast_reaction(int j, const Q& q, const Qd& qd) const {
    const int above = data_.ballast_mass ? ballast_dof(j) : ballast_top_dof(j), u_f = foundation_dof(j);
    return ballast_force(j, q(above) - (u_f < 0 ? 0.0 : q(u_f)), qd(above) - (u_f < 0 ? 0.0 : qd(u_f)));
  }
  Eigen::VectorXd ballast_reactions(const Eigen::Ref<const Eigen::VectorXd>& q,
                                    const Eigen::Ref<const Eigen::VectorXd>& qd) const;

  const SupportVariation& support(int j) const { return supports_[static_cast<std::size_t>(j)]; }
  const std::vector<int>& hanging_sleepers() const { return hanging_; }  ///< those with a gap, ascending
  /// Law of the ballast below a hanging sleeper.
  UnilateralBallast unilateral_ballast(int j) const;
  /// Compression of the ballast below sleeper j as a port: +1 on what rests on it, -1 on what it rests on.
  PortShape ballast_shape(int j) const;

 private:
  TrackData data_;
  int bays_;
  double begin_;
  int rigid_;  ///< 1 on rigid ground, else 0: unknowns less per bay
  int support_dofs_, dofs_per_bay_;
  int half_bandwidth_ = 0;
  bool is_uniform_ = true;
  std::vector<SupportVariation> supports_;  ///< by sleeper
  std::vector<int> hanging_;
  BeamElement element_;  ///< of the rail
  Eigen::SparseMatrix<double> M_, C_, C_inner_, K_;

  double ballast_force(int j, double compression, double rate) const;
  void read_variation();
  int below_ballast_dof(int j) const { return data_.ballast_mass ? ballast_dof(j) : foundation_dof(j); }
};

/// Rows of the data and of the supports that vary: smallest and largest factors, every gap.
std::vector<Parameter> parameters(const TrackModel& track);

}  // namespace easydyn::track

#pragma once

#include <Eigen/Core>
#include <vector>

#include "easydyn/mbs/linear_structure.hpp"
#include "easydyn/sim/banded_cholesky.hpp"
#include "track/track_model.hpp"

namespace easydyn::track {

/// The bays of a long track around a train, which travel with it, in steps of Newmark's method (beta = 1/4, gamma = 1/2)
/// of constant size h:
///
///   A y = -C qd* - K q* + sum_p N_p^T F_p      A = M + h/2 C + h^2/4 K      y = qdd at the end of the step
///   q* = q + h qd + h^2/4 qdd                  qd* = qd + h/2 qdd           q = q* + h^2/4 y,  qd = qd* + h/2 y
///
/// What lies outside the window is at rest. Absorbing ends travel with it. When it moves by a bay, the bay left behind
/// is forgotten and a new one at rest joins in front: A stays the same on a track whose bays are alike, else it is
/// factorised anew, which costs less than the steps that the train needs for a bay.
///
/// Forces act at a few moving places. The response to them needs no substitution of its own: A is ruled by the mass, so
/// that the columns of A^-1 decay within some metres, and they are kept as a table, bay by bay. A step costs one banded
/// substitution.
///
/// Coordinates are those of the TrackModel, all indices those of the whole track.
class TrackWindow {
 public:
  /// @param bays  of the window; 0, or more than the track has less 2: the whole track, which stays where it is
  /// @throws ModelError if the window has no room for its absorbing ends
  TrackWindow(const TrackModel& model, int bays, double step);
  TrackWindow(const TrackWindow&) = delete;

  int bays() const { return bays_; }
  int first_bay() const { return first_bay_; }
  bool is_whole_track() const { return bays_ == model_.bays(); }
  /// Bays on each side over which a column of A^-1 is kept.
  int reach() const { return reach_; }
  int factorisations() const { return factorisations_; }
  std::size_t memory() const;  ///< of matrices, tables and vectors [bytes]

  /// The state of the whole track; what lies outside the window from `first_bay` on is dropped.
  void set_state(int first_bay, const Eigen::Ref<const Eigen::VectorXd>& q,
                 const Eigen::Ref<const Eigen::VectorXd>& qd, const Eigen::Ref<const Eigen::VectorXd>& qdd);
  void move_to(int first_bay);

  /// Begins a step: q*, qd*, and the response without forces.
  void predict();
  /// Motion at the end of the step without forces.
  PortMotion free_motion(const PortShape& shape) const;
  /// By a unit force at `of`: the acceleration N y at `at`, and the slope N' y.
  struct Response {
    double acceleration = 0;  ///< [1/kg]
    double slope = 0;         ///< [1/(kg m)]
  };
  Response response(const PortShape& at, const PortShape& of);
  /// Ends the step with the forces F at the places `shapes`.
  void accept(const std::vector<PortShape>& shapes, const Eigen::VectorXd& F);

  /// Of coordinate i of the whole track; 0 outside the window.
  double q(int i) const { return holds(i) ? q_[padding_ + i - offset_] : 0; }
  double qd(int i) const { return holds(i) ? qd_[padding_ + i - offset_] : 0; }
  double qdd(int i) const { return holds(i) ? y_[padding_ + i - offset_] : 0; }
  bool holds(int i) const { return i >= offset_ && i < offset_ + size_; }

  double kinetic_energy() const;    ///< [J]
  double potential_energy() const;  ///< [J]
  /// Energy turned into heat by the last step, h vm^T C vm with vm = (q_1 - q_0) / h, exact for Newmark's method [J].
  double dissipated_in_step() const;

 private:
  // A symmetric matrix of the whole track by rows; where all bays are alike also the rows of an inner bay as a dense block,
  // its columns that are not zero one after the other.
  struct Product {
    int per_bay = 0, bays = 0;
    std::vector<int> begin, column;
    std::vector<double> value;
    bool is_uniform = false;
    std::vector<int> block_columns;  // counted from the bay before
    std::vector<double> block;
    Product(const SparseMatrix& A, const TrackModel& model, bool is_uniform);
    /// y -= (rows offset ... offset + size - 1) x, both with `padding` entries around, which are zero in x.
    void subtract(int offset, int size, int padding, const double* x, double* y) const;
    void subtract_row(int row, const double* x, double& y) const;  // x by column of the whole track
  };
  // Columns of A^-1 for all unknowns of one bay, over the bays from `-reach` to `reach`.
  struct Table {
    int bay = -1;  // of the whole track; -1: empty
    bool is_interior = false;
    std::vector<double> columns;
  };
  void factorise();
  void choose_reach();
  void subtract_end_damping(const Eigen::VectorXd& rate, Eigen::VectorXd& force) const;
  const Table& table_of(int bay);
  void fill(Table& table, int bay) const;

  const TrackModel& model_;
  int bays_, per_bay_, size_, padding_;
  double h_;
  int first_bay_ = 0, offset_ = 0;  // offset_: first coordinate of the window
  int reach_ = 0, factorisations_ = 0;
  SparseMatrix M_, C_, K_;    // of the whole track
  SparseMatrix end_damping_;  // of the travelling ends, window size
  Product C_product_, K_product_;
  BandedCholesky factor_;
  std::vector<Table> tables_;                 // by bay modulo their number; the last one for all like bays
  Eigen::VectorXd q_, qd_, y_, rate_before_;  // with padding on both sides
};

}  // namespace easydyn::track

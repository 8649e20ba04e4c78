#pragma once

// Private to soil: how a mobility comes from frequency responses.

#include <Eigen/Core>

#include "soil/mobility.hpp"

namespace easydyn::soil {

/// The lines at which frequency responses H(w) give band-limited impulse responses:
///
///   h(t) = e^(eta t) 1/T sum_i H(w_i) B(f_i) e^(2 pi i f_i t),   w_i = 2 pi f_i - i eta,  f_i = i / T
///
/// e^(-eta T) = 1e-3, so that what still moves after T, and folds back into it, is a thousandth. B is 1 up to
/// `roll_off` (1.25) times the highest frequency, where the loads end, and falls to 0 at 1.75 times it as an error function:
/// short in time. T is the window and what precedes t = 0, since a band-limited impulse has no sharp start.
class ImpulseSynthesis {
 public:
  /// @param window   [s] > 0 after t = 0, at least
  /// @param threads  0: one per core
  ImpulseSynthesis(double highest_frequency, double window, int threads = 1);

  const Eigen::VectorXcd& w() const { return w_; }  ///< [rad/s]
  double window() const;                            ///< [s] after t = 0, as it is

  /// Fills time step and responses. Rows: lines; columns: as Mobility::hx, hy, hz and mean [m/N].
  void update(Mobility& mobility, const Eigen::MatrixXcd& ux, const Eigen::MatrixXcd& uy,
              const Eigen::MatrixXcd& uz, const Eigen::MatrixXcd& mean) const;

  /// Impulse responses: samples x columns.
  Eigen::MatrixXd transform(const Eigen::MatrixXcd& spectra) const;

 private:
  double highest_frequency_, step_, period_, eta_;
  Eigen::Index before_, samples_;
  int threads_;
  Eigen::VectorXcd w_;
};

}  // namespace easydyn::soil

#pragma once

// Private to soil/report: receivers as tables and charts have them, and their spectra.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "easydyn/visu/chart.hpp"

namespace easydyn::soil::report {

/// Receivers of a result, or those that several results share.
struct Receivers {
  /// @param groups  line or grid of each; may be shorter, the others then belong to none
  Receivers(Eigen::MatrixXd position, std::vector<std::string> names, std::vector<std::string> groups);

  Eigen::MatrixXd position;  ///< n x 3 [m]
  std::vector<std::string> names, groups;
  Eigen::VectorXd distance;        ///< from the axis of the track [m]
  std::vector<Eigen::Index> near;  ///< indices, nearest first; of many, those that belong to no line or grid
                                   ///< and the first and the last one of each line or grid

  Eigen::Index count() const { return position.rows(); }
  std::string label(Eigen::Index i) const;
  /// Of one line or grid, in their order.
  std::vector<Eigen::Index> members(const std::string& group) const;
  std::vector<std::string> group_names() const;
  /// "x = 0 m, y = 10 m, z = 0 m"
  std::string place(Eigen::Index i) const;
};

/// Velocity level re `level_reference` [dB]; NaN for no motion.
double compute_level(double velocity);

/// The x axis of spectra in one-third octave bands.
visu::Axis third_octave_axis();

}  // namespace easydyn::soil::report

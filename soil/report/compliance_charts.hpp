#pragma once

#include <Eigen/Core>
#include <vector>

#include "easydyn/visu/chart.hpp"

namespace easydyn::soil {

/// A ground and the foundation that stands for it, under the loaded footprint (00) and at the next one (01): displacement
/// per unit harmonic force, time factor exp(i w t).
struct ComplianceFit {
  Eigen::VectorXd frequency;                                  ///< [Hz]
  Eigen::VectorXcd ground_00, ground_01, model_00, model_01;  ///< [m/N]
};

/// Magnitudes and phases over frequency, the ground as lines, the foundation dashed.
std::vector<visu::Chart> draw_compliances(const ComplianceFit& fit);

}  // namespace easydyn::soil

#pragma once

#include <Eigen/Core>
#include <string>

#include "easydyn/mbs/frame.hpp"

namespace easydyn {

/// Spring and damper that act along the vertical only, with a preload: a suspension whose given geometry is
/// the loaded state.
///
///   F = F0 - k u - d u.          u = (z_B - z_A) - (z_B - z_A)_nominal      on B upward, on A downward
///
/// A is the lower, B the upper end; F is the compression. Small relative rotations; the lateral distance of
/// the ends produces no force. Potential energy k u^2 / 2 - F0 u, dissipated power d u.^2.
class VerticalSpringDamper {
 public:
  /// @param stiffness  k [N/m], >= 0
  /// @param damping    d [N s/m], >= 0
  /// @param height     z_B - z_A in the nominal geometry [m]
  /// @param preload    F0, compression in the nominal geometry [N]
  /// @throws ModelError naming the element, the value and the range
  VerticalSpringDamper(std::string name, double stiffness, double damping, double height = 0,
                       double preload = 0);

  /// Applies the force, in System::forces(). Points in the axes of their frames [m].
  void apply(const Frame& frame_A, const Eigen::Vector3d& p_A, const Frame& frame_B,
             const Eigen::Vector3d& p_B);

  double force() const { return force_; }             ///< compression at the last evaluation [N]
  double displacement() const { return extension_; }  ///< u at the last evaluation [m]
  const std::string& name() const { return name_; }

 private:
  std::string name_;
  double stiffness_, damping_, height_, preload_;
  double force_ = 0, extension_ = 0;
};

}  // namespace easydyn

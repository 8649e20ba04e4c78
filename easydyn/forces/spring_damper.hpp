#pragma once

#include <Eigen/Core>
#include <string>

#include "easydyn/mbs/frame.hpp"

namespace easydyn {

/// Linear spring and damper in parallel between a point A of one frame and a point B of another.
///
///   F = k (l - l0) + d l.           along the line AB, tension positive
///
/// l = |p_AB| [m]. Valid for l > 0 (the direction is undefined at l = 0).
/// Potential energy k (l - l0)^2 / 2, dissipated power d l.^2.
class SpringDamper {
 public:
  /// @param stiffness    k [N/m], >= 0
  /// @param damping      d [N s/m], >= 0
  /// @param free_length  l0 [m], >= 0
  /// @throws ModelError naming the element, the value and the range
  SpringDamper(std::string name, double stiffness, double damping, double free_length);

  /// Applies the force, in System::forces(). Points in the axes of their frames [m].
  /// @throws ModelError if A and B coincide
  void apply(const Frame& frame_A, const Eigen::Vector3d& p_A, const Frame& frame_B,
             const Eigen::Vector3d& p_B);

  double force() const { return force_; }    ///< at the last evaluation [N], tension positive
  double length() const { return length_; }  ///< at the last evaluation [m]
  const std::string& name() const { return name_; }

 private:
  std::string name_;
  double stiffness_, damping_, free_length_;
  double force_ = 0, length_ = 0;
};

}  // namespace easydyn

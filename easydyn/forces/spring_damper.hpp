#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "easydyn/forces/stops.hpp"
#include "easydyn/mbs/frame.hpp"

namespace easydyn {

/// Linear spring and damper in parallel between a point A of one frame and a point B of another.
///
///   F = k (l - l0) + d l.           along the line AB, tension positive
///
/// l = |p_AB| [m]. Valid for l > 0 (the direction is undefined at l = 0). Stops may bound l.
/// Potential energy k (l - l0)^2 / 2, dissipated power d l.^2, and those of the stops.
class SpringDamper {
 public:
  /// @param stiffness    k [N/m], >= 0
  /// @param damping      d [N s/m], >= 0
  /// @param free_length  l0 [m], >= 0
  /// @throws ModelError naming the element, the value and the range
  SpringDamper(std::string name, double stiffness, double damping, double free_length);

  /// Bounds the length. @throws ModelError
  SpringDamper& set_stops(const Stops& stops);

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
  std::optional<Stops> stops_;
  double force_ = 0, length_ = 0;
};

/// A spring alone: F = k (l - l0).
class Spring : public SpringDamper {
 public:
  Spring(std::string name, double stiffness, double free_length)
      : SpringDamper(std::move(name), stiffness, 0, free_length) {}
};

/// A damper alone: F = d l.
class Damper : public SpringDamper {
 public:
  Damper(std::string name, double damping) : SpringDamper(std::move(name), 0, damping, 0) {}
};

}  // namespace easydyn

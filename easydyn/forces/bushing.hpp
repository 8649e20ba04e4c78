#pragma once

#include <Eigen/Core>
#include <string>

#include "easydyn/mbs/frame.hpp"

namespace easydyn {

/// An elastic joint between two frames: six stiffnesses and six dampings along the axes of frame A.
///
///   F = -(k_t u + d_t u.)                  on B, at the origin of B
///   M = -(E(phi)^-T k_r phi + d_r w)       on B
///
/// u is the origin of B seen from A, phi the rotation vector of B relative to A, w their relative angular velocity,
/// all in the axes of A; phi. = E^-1 w. On A the same act in reverse, the force at the same point, so that
/// nothing but heat is lost for rotations of any size below 180 degrees. Where the axes coincide at rest, that is the
/// place of no force.
/// Potential energy (u . k_t u + phi . k_r phi) / 2, dissipated power u. . d_t u. + w . d_r w.
class Bushing {
 public:
  struct Data {
    Eigen::Vector3d stiffness = Eigen::Vector3d::Zero();             ///< k_t along x, y, z [N/m], >= 0
    Eigen::Vector3d rotational_stiffness = Eigen::Vector3d::Zero();  ///< k_r about x, y, z [N m/rad], >= 0
    Eigen::Vector3d damping = Eigen::Vector3d::Zero();               ///< d_t [N s/m], >= 0
    Eigen::Vector3d rotational_damping = Eigen::Vector3d::Zero();    ///< d_r [N m s/rad], >= 0
  };

  /// @throws ModelError naming the element, the value and the range
  Bushing(std::string name, const Data& data);

  /// Applies force and moment, in System::forces(). Give frames at the joint: `body.frame() * translate(...)` made in
  /// positions().
  void apply(const Frame& frame_A, const Frame& frame_B);

  const Eigen::Vector3d& force() const { return force_; }  ///< on B, axes of A, at the last evaluation [N]
  const Eigen::Vector3d& moment() const {
    return moment_;
  }  ///< on B, axes of A, at the last evaluation [N m]
  const std::string& name() const { return name_; }

 private:
  std::string name_;
  Data data_;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero(), moment_ = Eigen::Vector3d::Zero();
};

}  // namespace easydyn

#pragma once

#include <Eigen/Core>
#include <span>

#include "easydyn/math/expr.hpp"
#include "easydyn/math/spatial.hpp"

namespace easydyn {

/// A body whose inertia is not that of a rigid one: it moves in shape coordinates of its own about a frame F that the
/// tree carries (`FlexibleBody`).
class DeformableInertia {
 public:
  /// Of F, in world axes: angular velocity and acceleration, velocity and acceleration of the origin.
  struct FrameMotion {
    Eigen::Vector3d w, v, w_dot, v_dot;
  };
  virtual ~DeformableInertia() = default;
  virtual int motion() const = 0;                     ///< that carries F; -1: fixed to the ground
  virtual const Eigen::Vector3d& origin() const = 0;  ///< of F
  virtual std::span<const Expr> shape_coordinates() const = 0;
  /// Inertia force and moment about the origin, world axes, and those on the shape coordinates.
  virtual spatial::Wrench compute_inertia_force(const FrameMotion& motion,
                                                const Eigen::VectorXd& accelerations,
                                                Eigen::VectorXd& shape_forces) = 0;
  /// Of (w, v) of F in world axes and the rates of the shape coordinates.
  virtual const Eigen::MatrixXd& compute_mass_matrix() = 0;
  virtual double kinetic_energy(const FrameMotion& motion) = 0;
};

}  // namespace easydyn

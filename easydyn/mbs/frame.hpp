#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>  // cross products of the user

#include "easydyn/math/expr.hpp"
#include "easydyn/math/expr_vector.hpp"
#include "easydyn/math/spatial.hpp"

namespace easydyn {

class MotionTree;

/// One elementary motion: a rotation about an axis or a translation, by expressions of q and t.
class Motion {
 public:
  static Motion rotation(const Eigen::Vector3d& unit_axis, Expr angle) {
    return Motion(unit_axis, std::move(angle));
  }
  static Motion translation(Expr x, Expr y, Expr z) {
    return Motion(std::move(x), std::move(y), std::move(z));
  }

 private:
  friend class Frame;
  friend Motion rotate_x(Expr angle);
  friend Motion rotate_y(Expr angle);
  friend Motion rotate_z(Expr angle);
  friend Motion translate(const Eigen::Vector3d& p);
  enum class Kind { rotation_x, rotation_y, rotation_z, rotation, translation, offset };
  Motion(Kind kind, Expr&& angle) : kind_(kind), e_{std::move(angle), {}, {}} {}
  Motion(const Eigen::Vector3d& axis, Expr&& angle)
      : kind_(Kind::rotation), vector_(axis), e_{std::move(angle), {}, {}} {}
  Motion(Expr&& x, Expr&& y, Expr&& z)
      : kind_(Kind::translation), e_{std::move(x), std::move(y), std::move(z)} {}
  explicit Motion(const Eigen::Vector3d& offset) : kind_(Kind::offset), vector_(offset) {}
  Kind kind_;
  Eigen::Vector3d vector_;  // the axis, or a constant displacement, in the axes of the frame before
  Expr e_[3];               // angle, or the three displacements
};

inline Motion rotate_x(Expr angle) {
  return Motion(Motion::Kind::rotation_x, std::move(angle));
}
inline Motion rotate_y(Expr angle) {
  return Motion(Motion::Kind::rotation_y, std::move(angle));
}
inline Motion rotate_z(Expr angle) {
  return Motion(Motion::Kind::rotation_z, std::move(angle));
}
/// About any axis, given in the axes of the frame that the motion starts from; it need not have unit length.
inline Motion rotate(const Eigen::Vector3d& axis, Expr angle) {
  return Motion::rotation(axis.normalized(), std::move(angle));
}
inline Motion translate(Expr x, Expr y, Expr z) {
  return Motion::translation(std::move(x), std::move(y), std::move(z));
}
inline Motion translate(const Eigen::Vector3d& p) {
  return Motion(p);
}
inline Motion translate(double x, double y, double z) {
  return translate(Eigen::Vector3d(x, y, z));
}

/// A frame moving with the mechanism: its pose T_0F = (R_0F, p_0F) and the motions that lead to it.
///
/// Frames are made inside `System::positions()` by `frame * motion`, read from left to right: each motion is
/// taken in the axes of the frame before it. Only the pose is given; velocities and forces are available
/// afterwards, in `System::forces()`. Frames that share a first part share its partial velocities.
class Frame {
 public:
  Frame() = default;          ///< the ground frame 0
  Frame(const Motion& first)  // NOLINT: a motion that starts from the ground is a frame
      : Frame(Frame() * first) {}

  friend Frame operator*(const Frame& frame, const Motion& motion) { return frame.followed_by(motion); }

  const Eigen::Matrix3d& rotation() const { return R_; }  ///< R_0F: axes of F in world axes
  const Eigen::Vector3d& origin() const { return p_; }    ///< p_0F [m], world axes
  Eigen::Vector3d point(const Eigen::Vector3d& p_FP) const { return p_ + R_ * p_FP; }  ///< p_0P [m]
  Eigen::Vector3d direction(const Eigen::Vector3d& d_F) const { return R_ * d_F; }

  /// p_0P of the point P fixed in this frame, with rate, bias and gradient: for loops, constraints and forces.
  ExprVector express_point(const Eigen::Vector3d& p_FP) const;
  /// The direction d_F fixed in this frame, in world axes, with rate, bias and gradient.
  ExprVector express_direction(const Eigen::Vector3d& d_F) const;

  /// w_0F [rad/s]; in forces() only.
  Eigen::Vector3d angular_velocity() const;
  /// Velocity [m/s] of the frame-fixed point that is now at p_0P (world axes); in forces() only.
  Eigen::Vector3d velocity_at(const Eigen::Vector3d& p_0P) const;
  /// Applies the force F_0 [N] at p_0P (world axes) to the body or link that carries this frame.
  void add_force(const Eigen::Vector3d& F_0, const Eigen::Vector3d& p_0P) const;
  /// Applies the moment M_0 [N m] (world axes).
  void add_moment(const Eigen::Vector3d& M_0) const;

  /// The motions of the system that made this frame; null for frames fixed to the ground.
  MotionTree* tree() const { return tree_; }
  int motion_index() const { return motion_; }  ///< last varying motion, -1: fixed to the ground

 private:
  Frame followed_by(const Motion& motion) const;

  Eigen::Matrix3d R_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_ = Eigen::Vector3d::Zero();
  MotionTree* tree_ = nullptr;
  int motion_ = -1;
};

inline Frame operator*(const Motion& first, const Motion& second) {
  return Frame(first) * second;
}

}  // namespace easydyn

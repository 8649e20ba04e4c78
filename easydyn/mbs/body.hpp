#pragma once

#include <string>

#include "easydyn/math/inertia.hpp"
#include "easydyn/mbs/frame.hpp"

namespace easydyn {

/// A rigid body: its inertia and the frame that carries it, assigned in `System::positions()`.
/// The origin of the frame is the centre of mass.
class Body {
 public:
  Body(std::string name, const Inertia& inertia);
  Body(const Body&) = delete;
  Body(Body&&) = delete;

  /// In positions(). @throws ModelError inside the equations of a loop, whose motions do not stay
  Body& operator=(const Frame& frame) {
    if (frame.tree()) check_place();
    frame_ = frame;
    is_placed_ = true;
    return *this;
  }
  Body& operator=(const Motion& motion) { return *this = Frame(motion); }

  const std::string& name() const { return name_; }
  const Inertia& inertia() const { return inertia_; }
  double mass() const { return inertia_.mass; }
  /// Where it is. @throws ModelError if positions() has not placed it yet
  const Frame& frame() const {
    if (!is_placed_) throw_not_placed();
    return frame_;
  }
  operator const Frame&() const { return frame(); }  // NOLINT: a body stands for its frame
  friend Frame operator*(const Body& body, const Motion& motion) { return body.frame() * motion; }

  const Eigen::Vector3d& position() const { return frame().origin(); }  ///< p_0G [m]
  Eigen::Vector3d point(const Eigen::Vector3d& p_GP) const { return frame().point(p_GP); }
  Eigen::Vector3d velocity() const { return frame().velocity_at(frame_.origin()); }  ///< v_0G [m/s]
  Eigen::Vector3d angular_velocity() const { return frame().angular_velocity(); }
  /// Acceleration of the centre of mass [m/s^2]; after an evaluation with given accelerations.
  Eigen::Vector3d acceleration() const;
  void add_force(const Eigen::Vector3d& F_0, const Eigen::Vector3d& p_0P) const {
    frame().add_force(F_0, p_0P);
  }
  void add_moment(const Eigen::Vector3d& M_0) const { frame().add_moment(M_0); }

 private:
  friend class System;
  void check_place() const;
  [[noreturn]] void throw_not_placed() const;
  std::string name_;
  Inertia inertia_;
  Frame frame_;
  bool is_placed_ = false;
};

}  // namespace easydyn

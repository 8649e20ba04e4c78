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

  Body& operator=(const Frame& frame) {
    frame_ = frame;
    is_placed_ = true;
    return *this;
  }
  Body& operator=(const Motion& motion) { return *this = Frame(motion); }

  const std::string& name() const { return name_; }
  const Inertia& inertia() const { return inertia_; }
  double mass() const { return inertia_.mass; }
  const Frame& frame() const { return frame_; }
  operator const Frame&() const { return frame_; }  // NOLINT: a body stands for its frame
  friend Frame operator*(const Body& body, const Motion& motion) { return body.frame_ * motion; }

  const Eigen::Vector3d& position() const { return frame_.origin(); }  ///< p_0G [m]
  Eigen::Vector3d point(const Eigen::Vector3d& p_GP) const { return frame_.point(p_GP); }
  Eigen::Vector3d velocity() const { return frame_.velocity_at(frame_.origin()); }  ///< v_0G [m/s]
  Eigen::Vector3d angular_velocity() const { return frame_.angular_velocity(); }
  /// Acceleration of the centre of mass [m/s^2]; after an evaluation with given accelerations.
  Eigen::Vector3d acceleration() const;
  void add_force(const Eigen::Vector3d& F_0, const Eigen::Vector3d& p_0P) const {
    frame_.add_force(F_0, p_0P);
  }
  void add_moment(const Eigen::Vector3d& M_0) const { frame_.add_moment(M_0); }

 private:
  friend class System;
  std::string name_;
  Inertia inertia_;
  Frame frame_;
  bool is_placed_ = false;
};

}  // namespace easydyn

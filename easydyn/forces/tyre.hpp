#pragma once

#include <Eigen/Core>
#include <string>

#include "easydyn/mbs/frame.hpp"

namespace easydyn {

/// Tyre on a plane road: vertical spring and damper, and the brush model for the forces in the contact patch.
///
///   F_z = (k_z p + d_z p.) / cos(lean) >= 0    p = r - distance of the wheel's centre from the road in the wheel's plane
///   s   = v_s / |v_r|                   theoretical slip, v_s sliding velocity of the patch, v_r = w (r - p)
///   F   = -mu F_z (3 t - 3 t^2 + t^3) s / |s|       t = C |s| / (3 mu F_z) < 1, else mu F_z: all slides
///   M_z = mu F_z a t (1 - t)^3 s_y / |s|            self-aligning moment, half length of the patch a
///
/// Longitudinal and lateral slip combine, with one slip stiffness C for both. Steady state: the patch follows at once.
/// For standing wheels |v_r| is replaced by sqrt(v_r^2 + v_low^2): below v_low the tyre acts as a viscous damper.
/// Wheel: turns about the y axis of its carrier frame. Road: z = 0 of its frame, z upward.
/// Potential energy k_z p^2 / 2; the rest of the power that the patch takes counts as dissipated.
/// Reference: H. B. Pacejka, Tyre and Vehicle Dynamics, 2nd ed., Butterworth-Heinemann, 2006, sect. 3.2.
class Tyre {
 public:
  struct Data {
    double radius = 0;              ///< r, unloaded [m], > 0
    double vertical_stiffness = 0;  ///< k_z [N/m], > 0
    double vertical_damping = 0;    ///< d_z [N s/m], >= 0
    double slip_stiffness = 0;      ///< C: force per unit of slip at zero slip [N], > 0
    double friction = 1;            ///< mu, > 0
    double patch_half_length = 0;   ///< a [m], >= 0; 0: no aligning moment
    double low_speed = 0.1;         ///< v_low [m/s], > 0
  };

  /// @throws ModelError naming the element, the value and the range
  Tyre(std::string name, const Data& data);

  /// Applies the forces, in System::forces().
  /// @param carrier  frame at the wheel's centre that steers and leans with the wheel but need not turn with it; its y
  ///                 axis is the wheel's
  /// @param wheel    the turning body
  void apply(const Frame& road, const Frame& carrier, const Frame& wheel);

  double vertical_force() const { return F_z_; }            ///< at the last evaluation [N]
  double longitudinal_force() const { return force_.x(); }  ///< forward along the wheel [N]
  double lateral_force() const { return force_.y(); }       ///< to the left [N]
  double aligning_moment() const { return M_z_; }           ///< about the road's normal [N m]
  const Eigen::Vector2d& slip() const { return slip_; }     ///< s, longitudinal and lateral
  const std::string& name() const { return name_; }

 private:
  std::string name_;
  Data data_;
  double F_z_ = 0, M_z_ = 0;
  Eigen::Vector2d force_ = Eigen::Vector2d::Zero(), slip_ = Eigen::Vector2d::Zero();
};

}  // namespace easydyn

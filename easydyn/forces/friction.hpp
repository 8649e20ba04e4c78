#pragma once

#include <Eigen/Core>
#include <string>

#include "easydyn/mbs/frame.hpp"

namespace easydyn {

/// Coefficient of dry friction, regularised: a smooth function of the sliding speed v,
///
///   mu(v) = (mu_d + (mu_s - mu_d) exp(-(v / v_s)^2)) tanh(v / v_0)
///
/// Below about 3 v_0 the contact creeps instead of sticking: it holds a force F with the creep speed v_0 atanh(F /
/// (mu_s N)). Take v_0 small against the speeds of interest; steps of explicit integrators shrink with v_0.
struct FrictionLaw {
  double sliding = 0;            ///< mu_d, >= 0
  double sticking = -1;          ///< mu_s, >= mu_d; -1: as sliding
  double creep_speed = 1e-3;     ///< v_0 [m/s or rad/s], > 0
  double stribeck_speed = 0.01;  ///< v_s [m/s or rad/s], > 0: where sticking has passed into sliding

  double coefficient(double speed) const;  ///< of the sign of the speed
  /// @throws ModelError naming `object`
  void check(const std::string& object) const;
};

/// Dry friction in a guide or a bearing, where the normal force is known or given.
///
///   F = -mu(v) N               sliding: v along an axis of frame A, on B at a point; the reverse on A
///   M = -mu(w) r N             turning: w about an axis of frame A, r the radius of friction
///
/// Dissipated power |F v|, |M w|; no potential energy. Where N is a joint reaction, take it from
/// `System::compute_reactions` of the last step, or estimate it.
class Friction {
 public:
  /// @throws ModelError naming the element, the value and the range
  Friction(std::string name, const FrictionLaw& law);

  /// Sliding of B along A at the origin of B. @param normal_force  N [N], >= 0
  void apply_sliding(const Frame& frame_A, const Frame& frame_B, const Eigen::Vector3d& axis_A,
                     double normal_force);
  /// Turning of B about A. @param moment_scale  r N [N m], >= 0
  void apply_turning(const Frame& frame_A, const Frame& frame_B, const Eigen::Vector3d& axis_A,
                     double moment_scale);

  double force() const { return force_; }  ///< F or M on B along the axis, at the last evaluation [N, N m]
  const std::string& name() const { return name_; }

 private:
  Eigen::Vector3d axis_0(const Frame& frame_A, const Eigen::Vector3d& axis_A) const;
  std::string name_;
  FrictionLaw law_;
  double force_ = 0;
};

}  // namespace easydyn

#include "easydyn/forces/tyre.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "easydyn/forces/account.hpp"
#include "easydyn/require.hpp"

namespace easydyn {

using Eigen::Vector2d;
using Eigen::Vector3d;

Tyre::Tyre(std::string name, const Data& data) : name_(std::move(name)), data_(data) {
  const std::string object = "tyre \"" + name_ + "\"";
  require_positive(object, "radius", data.radius, "m");
  require_positive(object, "vertical stiffness", data.vertical_stiffness, "N/m");
  require_not_negative(object, "vertical damping", data.vertical_damping, "N s/m");
  require_positive(object, "slip stiffness", data.slip_stiffness, "N");
  require_positive(object, "friction", data.friction, "");
  require_not_negative(object, "half length of the patch", data.patch_half_length, "m");
  require_positive(object, "low speed", data.low_speed, "m/s");
}

void Tyre::apply(const Frame& road, const Frame& carrier, const Frame& wheel) {
  F_z_ = M_z_ = 0;
  force_.setZero();
  slip_.setZero();

  // Axes of the patch: along the wheel, to its left, off the road.
  const Vector3d normal = road.rotation().col(2), axle = carrier.rotation().col(1);
  const Vector3d along = axle.cross(normal);
  if (along.norm() < 1e-6)
    throw ModelError(fmt::format("tyre \"{}\": the wheel lies flat on the road", name_));
  const Vector3d e_x = along.normalized(), e_y = normal.cross(e_x);
  const Vector3d down = axle.cross(e_x);  // in the plane of the wheel, towards the road
  const double steepness = -down.dot(normal), height = normal.dot(carrier.origin() - road.origin());
  const double depth = data_.radius - height / steepness;  // along the wheel's plane
  if (depth <= 0) return;

  // The patch is a point of the road, carried by the wheel.
  const Vector3d centre = carrier.origin(), patch = centre + (data_.radius - depth) * down;
  const Vector3d v = wheel.velocity_at(patch) - road.velocity_at(patch);
  const double depth_rate = -normal.dot(v) / steepness;
  const double elastic = data_.vertical_stiffness * depth,
               radial = std::max(0.0, elastic + data_.vertical_damping * depth_rate);
  F_z_ = radial / steepness;  // the road pushes along its normal: only a part of it presses the tyre

  // Slip: what the material of the tyre slides at the patch, by the speed at which it runs through.
  const Vector2d sliding(e_x.dot(v), e_y.dot(v));
  const double spin = axle.dot(wheel.angular_velocity() - road.angular_velocity());
  const double rolling = std::hypot(spin * (data_.radius - depth), data_.low_speed);
  slip_ = sliding / rolling;
  const double s = slip_.norm(), limit = data_.friction * F_z_;
  if (s > 0 && limit > 0) {
    const double t = std::min(1.0, data_.slip_stiffness * s / (3 * limit));
    force_ = -limit * t * (3 - 3 * t + t * t) / s * slip_;
    M_z_ = limit * data_.patch_half_length * t * std::pow(1 - t, 3) * slip_.y() / s;
  }

  const Vector3d F = F_z_ * normal + force_.x() * e_x + force_.y() * e_y, M = M_z_ * normal;
  wheel.add_force(F, patch);
  wheel.add_moment(M);
  road.add_force(-F, patch);
  road.add_moment(-M);
  const double power = F.dot(v) + M.dot(wheel.angular_velocity() - road.angular_velocity());
  account(wheel, road, 0.5 * data_.vertical_stiffness * depth * depth, -power - elastic * depth_rate);
}

}  // namespace easydyn

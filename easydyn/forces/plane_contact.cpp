#include "easydyn/forces/plane_contact.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "easydyn/forces/account.hpp"
#include "easydyn/require.hpp"

namespace easydyn {

using Eigen::Vector3d;

PlaneContact::PlaneContact(std::string name, const Data& data) : name_(std::move(name)), data_(data) {
  const std::string object = "contact \"" + name_ + "\"";
  require_positive(object, "stiffness", data.stiffness, "N/m^n");
  require(data.exponent >= 1, object, "exponent", data.exponent, "", ">= 1");
  require_not_negative(object, "damping", data.damping, "s/m");
  data.friction.check(object);
}

void PlaneContact::begin() {
  force_.setZero();
  depth_ = -std::numeric_limits<double>::infinity();
}

void PlaneContact::touch(const Frame& plane, const Frame& body, const Vector3d& p_0P) {
  const Vector3d normal = plane.rotation().col(2);
  const double depth = -normal.dot(p_0P - plane.origin());
  depth_ = std::max(depth_, depth);
  if (depth <= 0) return;

  // Relative velocity of the two material points that touch.
  const Vector3d v = body.velocity_at(p_0P) - plane.velocity_at(p_0P);
  const double depth_rate = -normal.dot(v), elastic = data_.stiffness * std::pow(depth, data_.exponent),
               N = std::max(0.0, elastic * (1 + data_.damping * depth_rate));
  const Vector3d sliding = v + depth_rate * normal;
  const double speed = sliding.norm(), T = data_.friction.coefficient(speed) * N;

  Vector3d F = N * normal;
  if (speed > 0) F -= T / speed * sliding;
  body.add_force(F, p_0P);
  plane.add_force(-F, p_0P);
  force_ += F;
  account(body, plane, elastic * depth / (data_.exponent + 1), (N - elastic) * depth_rate + T * speed);
}

void PlaneContact::apply_point(const Frame& plane, const Frame& body, const Vector3d& p_B) {
  begin();
  touch(plane, body, body.point(p_B));
}

void PlaneContact::apply_sphere(const Frame& plane, const Frame& body, const Vector3d& centre_B,
                                double radius) {
  require_positive("contact \"" + name_ + "\"", "radius", radius, "m");
  begin();
  touch(plane, body, body.point(centre_B) - radius * plane.rotation().col(2));
}

void PlaneContact::apply_cylinder(const Frame& plane, const Frame& body, const Vector3d& centre_B,
                                  const Vector3d& axis_B, double radius, double half_length) {
  const std::string object = "contact \"" + name_ + "\"";
  require_positive(object, "radius", radius, "m");
  require_not_negative(object, "half length", half_length, "m");
  const double length = axis_B.norm();
  require(length > 0, object, "length of the axis", length, "", "> 0");
  begin();
  const Vector3d axis = body.direction(axis_B / length), normal = plane.rotation().col(2);

  // Downward in the plane of the rim; a cylinder that stands upright has no such direction, and any will do.
  Vector3d down = -(normal - normal.dot(axis) * axis);
  if (down.norm() < 1e-9) down = axis.unitOrthogonal();
  down.normalize();
  const Vector3d across = axis.cross(down), centre = body.point(centre_B);
  const int ends = half_length > 0 ? 2 : 1;
  for (int end = 0; end < ends; ++end) {
    const Vector3d rim_centre = centre + (end == 0 ? -half_length : half_length) * axis;
    for (const Vector3d& d : {down, across, Vector3d(-down), Vector3d(-across)})
      touch(plane, body, rim_centre + radius * d);
  }
}

}  // namespace easydyn

#include "easydyn/forces/bushing.hpp"

#include <Eigen/Geometry>

#include "easydyn/forces/account.hpp"
#include "easydyn/require.hpp"

namespace easydyn {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

// M with w . M phi' = ... : inverse transpose of the left Jacobian of the rotation vector, so that the moment is the
// gradient of the potential: M = E^-T (dV/dphi), phi. = E^-1 w.
Vector3d moment_of_gradient(const Vector3d& phi, const Vector3d& gradient) {
  const double angle = phi.norm();
  // E^-1 = 1 - [phi]/2 + c [phi]^2; its transpose changes the sign of the middle term.
  const double c = angle < 1e-4 ? 1.0 / 12 + angle * angle / 720
                                : (1 - 0.5 * angle / std::tan(0.5 * angle)) / (angle * angle);
  return gradient + 0.5 * phi.cross(gradient) + c * phi.cross(phi.cross(gradient));
}

}  // namespace

Bushing::Bushing(std::string name, const Data& data) : name_(std::move(name)), data_(data) {
  const std::string object = "bushing \"" + name_ + "\"";
  const auto check = [&](const char* quantity, const Vector3d& values, const char* unit) {
    for (int i = 0; i < 3; ++i)
      require_not_negative(object, std::string(quantity) + " " + "xyz"[i], values[i], unit);
  };
  check("stiffness", data.stiffness, "N/m");
  check("rotational stiffness", data.rotational_stiffness, "N m/rad");
  check("damping", data.damping, "N s/m");
  check("rotational damping", data.rotational_damping, "N m s/rad");
}

void Bushing::apply(const Frame& frame_A, const Frame& frame_B) {
  const Matrix3d& R = frame_A.rotation();
  const Vector3d p = frame_B.origin();
  const Vector3d u = R.transpose() * (p - frame_A.origin()),
                 u_dot = R.transpose() * (frame_B.velocity_at(p) - frame_A.velocity_at(p)),
                 w = R.transpose() * (frame_B.angular_velocity() - frame_A.angular_velocity());
  const Eigen::AngleAxisd turn(Matrix3d(R.transpose() * frame_B.rotation()));
  const Vector3d phi = turn.angle() * turn.axis();

  const Vector3d k_u = data_.stiffness.cwiseProduct(u), k_phi = data_.rotational_stiffness.cwiseProduct(phi),
                 d_u = data_.damping.cwiseProduct(u_dot), d_w = data_.rotational_damping.cwiseProduct(w);
  force_ = -(k_u + d_u);
  moment_ = -(moment_of_gradient(phi, k_phi) + d_w);
  frame_B.add_force(R * force_, p);
  frame_A.add_force(-(R * force_), p);
  frame_B.add_moment(R * moment_);
  frame_A.add_moment(-(R * moment_));
  account(frame_A, frame_B, 0.5 * (u.dot(k_u) + phi.dot(k_phi)), u_dot.dot(d_u) + w.dot(d_w));
}

}  // namespace easydyn

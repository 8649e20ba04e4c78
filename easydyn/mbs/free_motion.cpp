#include "easydyn/mbs/free_motion.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "easydyn/error.hpp"
#include "easydyn/mbs/system.hpp"

namespace easydyn {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

// Angle b beyond which the chart changes: conditions are still within a factor 2 of the best.
constexpr double largest_tilt = 1.0;

Matrix3d rotation_of(const Vector3d& angles) {
  return (Eigen::AngleAxisd(angles[0], Vector3d::UnitX()) * Eigen::AngleAxisd(angles[1], Vector3d::UnitY()) *
          Eigen::AngleAxisd(angles[2], Vector3d::UnitZ()))
      .toRotationMatrix();
}

// What remains of the angular acceleration without second derivatives of the angles, in the axes of the chart; the
// columns of J carry rates to the angular velocity.
struct Kinematics {
  Matrix3d J;
  Vector3d bias;
};
Kinematics kinematics_of(const Vector3d& angles, const Vector3d& rates) {
  const Matrix3d Rx = Eigen::AngleAxisd(angles[0], Vector3d::UnitX()).toRotationMatrix();
  const Vector3d e1 = Vector3d::UnitX(), e2 = Rx * Vector3d::UnitY(),
                 e3 = Rx * (Eigen::AngleAxisd(angles[1], Vector3d::UnitY()) * Vector3d::UnitZ());
  Kinematics k;
  k.J << e1, e2, e3;
  const Vector3d w1 = rates[0] * e1, w2 = w1 + rates[1] * e2;
  k.bias = rates[1] * w1.cross(e2) + rates[2] * w2.cross(e3);
  return k;
}

}  // namespace

FreeMotion::FreeMotion(System& system, const std::string& name, const Vector3d& origin, int chart)
    : x(system.coordinate(name + ".x", origin.x())),
      y(system.coordinate(name + ".y", origin.y())),
      z(system.coordinate(name + ".z", origin.z())),
      a(system.coordinate(name + ".a")),
      b(system.coordinate(name + ".b")),
      c(system.coordinate(name + ".c")),
      system_(&system),
      chart_(chart) {}

Frame FreeMotion::frame(const Frame& parent) const {
  if (!system_->chart_pointer_)
    throw ModelError("a free motion has a frame in positions() and forces() only");
  const Eigen::AngleAxisd chart(system_->chart_pointer_[chart_]);
  return parent * translate(x, y, z) * Motion::rotation(chart.axis(), chart.angle()) * rotate_x(a) *
         rotate_y(b) * rotate_z(c);
}

FreeMotion System::free_motion(const std::string& name, const Vector3d& origin, const Matrix3d& orientation) {
  if (!((orientation.transpose() * orientation).isIdentity(1e-12) && orientation.determinant() > 0))
    throw ModelError(fmt::format("free motion \"{}\": the orientation is not a rotation matrix", name));
  initial_charts_.push_back(orientation);
  free_motions_.push_back(FreeMotion(*this, name, origin, static_cast<int>(initial_charts_.size()) - 1));
  return free_motions_.back();
}

bool System::update_charts(State& state, Eigen::VectorXd* pseudo_accelerations) const {
  bool has_changed = false;
  for (const FreeMotion& f : free_motions_) {
    if (f.a.is_held() || f.b.is_held() || f.c.is_held()) continue;
    const int at[3] = {f.a.index(), f.b.index(), f.c.index()};
    if (std::abs(state.q[at[1]]) <= largest_tilt) continue;
    const auto take = [&](const Eigen::VectorXd& v) { return Vector3d(v[at[0]], v[at[1]], v[at[2]]); };
    const auto put = [&](Eigen::VectorXd& v, const Vector3d& value) {
      for (int i = 0; i < 3; ++i) v[at[i]] = value[i];
    };
    const Vector3d angles = take(state.q), rates = take(state.qd);
    const Matrix3d R = rotation_of(angles);
    const Kinematics old = kinematics_of(angles, rates);
    const Vector3d new_rates = R.transpose() * (old.J * rates);
    const Vector3d new_bias = kinematics_of(Vector3d::Zero(), new_rates).bias;  // J = 1 there
    const auto convert = [&](Eigen::VectorXd& qdd) {
      put(qdd, R.transpose() * (old.J * take(qdd) + old.bias) - new_bias);
    };
    convert(state.qdd);
    if (pseudo_accelerations) convert(*pseudo_accelerations);
    put(state.qd, new_rates);
    put(state.q, Vector3d::Zero());
    Matrix3d& chart = state.charts[static_cast<std::size_t>(f.chart_)];
    chart = Eigen::Quaterniond(chart * R).normalized().toRotationMatrix();
    has_changed = true;
  }
  return has_changed;
}

}  // namespace easydyn

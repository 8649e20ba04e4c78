#include "easydyn/forces/external_force.hpp"

#include <fmt/format.h>

#include "easydyn/error.hpp"
#include "easydyn/forces/account.hpp"

namespace easydyn {

using Eigen::Vector3d;

void ExternalForce::apply(const Frame& frame, const Vector3d& p_P) {
  const double t = frame.tree() ? frame.tree()->time() : 0;
  const Vector3d p = frame.point(p_P), v = frame.velocity_at(p);
  force_ = function_(t, p, v);
  if (!force_.allFinite())
    throw ModelError(fmt::format("external force \"{}\": not finite at t = {:g} s", name_, t));
  frame.add_force(force_, p);
  account(frame, frame, 0, 0, force_.dot(v));
}

void ExternalMoment::apply(const Frame& frame) {
  const double t = frame.tree() ? frame.tree()->time() : 0;
  const Vector3d w = frame.angular_velocity();
  moment_ = function_(t, w);
  if (!moment_.allFinite())
    throw ModelError(fmt::format("external moment \"{}\": not finite at t = {:g} s", name_, t));
  frame.add_moment(moment_);
  account(frame, frame, 0, 0, moment_.dot(w));
}

}  // namespace easydyn

#include "easydyn/mbs/body.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>

#include "easydyn/error.hpp"
#include "easydyn/mbs/motion_tree.hpp"

namespace easydyn {

Body::Body(std::string name, const Inertia& inertia) : name_(std::move(name)), inertia_(inertia) {
  if (!(inertia.mass >= 0 && std::isfinite(inertia.mass)))
    throw ModelError(fmt::format("body \"{}\": mass = {} kg, must be >= 0", name_, inertia.mass));
  if (!inertia.J.allFinite() || !inertia.J.isApprox(inertia.J.transpose(), 1e-12))
    throw ModelError(fmt::format("body \"{}\": the inertia must be finite and symmetric", name_));
  const Eigen::Vector3d J = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia.J).eigenvalues();
  const double slack = 1e-9 * J[2];
  if (!(J[0] >= -slack && J[0] + J[1] >= J[2] - slack))
    throw ModelError(
        fmt::format("body \"{}\": principal moments {}, {}, {} kg m^2 must be >= 0 and obey J1 + J2 >= J3",
                    name_, J[0], J[1], J[2]));
}

void Body::check_place() const {
  const MotionTree* const tree = MotionTree::current();
  if (tree && tree->is_in_trial())
    throw ModelError(fmt::format(
        "body \"{}\" is placed inside the equations of a loop: place it after the loop is solved", name_));
}

void Body::throw_not_placed() const {
  throw ModelError(fmt::format("body \"{}\" is used before positions() places it", name_));
}

Eigen::Vector3d Body::acceleration() const {
  return frame_.tree() ? frame_.tree()->acceleration_at(frame_.motion_index(), frame_.origin())
                       : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

}  // namespace easydyn

#include "easydyn/mbs/system.hpp"

namespace easydyn {

void System::gravity(const Eigen::Vector3d& field) {
  tree_.add_gravity(field);
  for (const auto& b : flexible_bodies_) b->apply_weight(field, energy());
}

}  // namespace easydyn

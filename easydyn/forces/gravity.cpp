#include "easydyn/mbs/system.hpp"

namespace easydyn {

void System::gravity(const Eigen::Vector3d& field) {
  tree_.add_gravity(field);
}

}  // namespace easydyn

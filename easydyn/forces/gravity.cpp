#include "easydyn/mbs/system.hpp"

namespace easydyn {

// Weight of all bodies, F = m g at the centre of mass; potential energy -m g . p (zero at the origin).
void System::gravity(const Eigen::Vector3d& field) {
  for (const Body& b : bodies_) {
    b.add_force(b.mass() * field, b.position());
    energy().potential -= b.mass() * field.dot(b.position());
  }
  for (const auto& b : flexible_bodies_) b->apply_weight(field, energy());
}

}  // namespace easydyn

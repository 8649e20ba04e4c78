#pragma once
// Private to easydyn/forces: how force elements keep the accounts of the system that they act in.

#include "easydyn/mbs/motion_tree.hpp"

namespace easydyn {

/// Adds to the accounts of the system that a frame or its partner belongs to: energy [J], powers [W].
inline void account(const Frame& a, const Frame& b, double potential, double dissipated,
                    double supplied = 0) {
  MotionTree* const tree = a.tree() ? a.tree() : b.tree();
  if (!tree) return;  // both fixed to the ground: nothing moves
  tree->energy().potential += potential;
  tree->energy().dissipated += dissipated;
  tree->energy().supplied += supplied;
}

}  // namespace easydyn

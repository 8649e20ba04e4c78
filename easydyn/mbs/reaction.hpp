#pragma once

#include <Eigen/Core>

#include "easydyn/mbs/frame.hpp"

namespace easydyn {

class System;

/// The force and moment that go through a section of the mechanism: of a joint, or inside a body's link. Costs
/// nothing until `System::compute_reactions` asks for it.
///
///     Reaction bearing = reaction("bearing");
///     void positions() override { rod = bearing.cut(translate(0, 0, 2)) * rotate_y(a) * translate(0, 0, -l / 2); }
///     ...
///     system.compute_reactions(integrator.state());
///     bearing.force();
///
/// Each reaction is cut once, in positions(). Six held coordinates move what follows the cut; the generalised forces
/// that hold them are the reaction. This is exact in closed loops, too, where the loop's equations are given by frames
/// that contain the cut; equations in angles and lengths alone do not know of the cut.
class Reaction {
 public:
  /// The frame after the cut: the same frame, or, while reactions are computed, one that could move.
  Frame cut(const Frame& frame) const;

  /// What the part before the cut exerts on the part after it, in the axes of the frame, at its origin.
  /// @throws ModelError before System::compute_reactions
  const Eigen::Vector3d& force() const;   ///< [N]
  const Eigen::Vector3d& moment() const;  ///< [N m]

 private:
  friend class System;
  void require_known() const;
  Reaction(System& system, int number) : system_(&system), number_(number) {}
  System* system_;
  int number_;
};

}  // namespace easydyn

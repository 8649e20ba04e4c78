#pragma once

#include <Eigen/Core>
#include <string>

#include "easydyn/mbs/coordinate.hpp"
#include "easydyn/mbs/frame.hpp"

namespace easydyn {

/// A body that nothing guides: six coordinates, the place of its origin and three small angles about a reference
/// orientation, the chart:
///
///   R = R_chart R_x(a) R_y(b) R_z(c)
///
/// Angles of any kind are singular somewhere (here at b = 90 degrees). Before they come near, integrators change the
/// chart to the orientation reached: the angles start from zero again, rates and accelerations are converted
/// exactly. Each State carries its charts, so that old states stay valid.
///
///     FreeMotion motion = free_motion("satellite");
///     void positions() override { satellite = motion.frame(); }
class FreeMotion {
 public:
  Coordinate x, y,
      z;  ///< of the origin, in the axes of the frame that the motion starts from: the ground's [m]
  Coordinate a, b, c;  ///< [rad]

  /// The frame; in positions() only. With a parent, all six coordinates count from that frame, which may move.
  Frame frame(const Frame& parent = {}) const;

 private:
  friend class System;
  FreeMotion(System& system, const std::string& name, const Eigen::Vector3d& origin, int chart);
  System* system_;
  int chart_;
};

}  // namespace easydyn

#pragma once

#include "easydyn/mbs/system.hpp"
#include "track/track_model.hpp"

namespace easydyn::track {

/// A track built into a multibody system as a linear structure: rail, pads, sleepers, ballast and foundation.
/// Its coordinates are those of `TrackModel`, positive **downward**.
class FlexibleTrack {
 public:
  /// @throws ModelError as TrackModel
  FlexibleTrack(System& system, TrackModel model);
  FlexibleTrack(const FlexibleTrack&) = delete;

  const TrackModel& model() const { return model_; }

  /// Touches the rail at x [m]; within System::forces(). displacement() of the port is the deflection w
  /// (downward), slope() is w', a force on the port pushes the rail down.
  /// @throws ModelError if x is off the rail
  Port touch_rail(double x) const;
  /// Touches any of the track's coordinates, e.g. the ballast of a hanging sleeper; within System::forces().
  Port touch(const PortShape& shape) const { return system_.touch(structure_, shape); }

  /// The track's part of a state: a view on its coordinates (or rates).
  Eigen::VectorXd coordinates(const Eigen::VectorXd& q) const;

 private:
  System& system_;
  TrackModel model_;
  const LinearStructure& structure_;
};

}  // namespace easydyn::track

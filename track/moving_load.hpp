#pragma once

#include "track/flexible_track.hpp"
#include "track/track_contact.hpp"

namespace easydyn::track {

/// A constant force Q that moves along the rail: a vehicle without mass. Its power Q dw/dt, w at the moving place, is that
/// of an external force.
class MovingLoad : public TrackContact {
 public:
  /// @param load  Q, downward, both rails together [N], finite
  MovingLoad(std::string name, double load);

  /// Applies the force at x [m], which moves with `speed` [m/s]; within System::forces().
  void apply(double x, double speed, const FlexibleTrack& track, EnergyAccounts& energy);

  Force force_after(double, double) const override { return {force_, 0, 0}; }
  const Body* body() const override { return nullptr; }
  bool is_closed() const override { return true; }  // whatever its sign

 private:
  double load_;
};

}  // namespace easydyn::track

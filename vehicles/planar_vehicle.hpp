#pragma once

#include <optional>
#include <string>
#include <vector>

#include "easydyn/easydyn.hpp"
#include "vehicles/axle_loads.hpp"
#include "vehicles/rail_vehicle.hpp"
#include "vehicles/vehicle_model.hpp"
#include "vehicles/wheel_pair_model.hpp"

namespace easydyn::vehicles {

/// A rail vehicle in the vertical plane (bounce and pitch), built into a multibody system from its data
/// sheet.
///
/// Coordinates, all zero in the loaded state on a level rigid track: heave z [m, up] and pitch [rad, nose
/// down] of every body and frame, heave of every hub and tyre. A body hinged to the one before it has its
/// relative pitch only. The forward motion x(t) is imposed. Suspensions carry the preloads of
/// `compute_axle_loads`.
///
///     class Tram : public System {
///       PlanarVehicle tram{*this, t2000_like()};
///       void positions() override { tram.place(-30 + 8.33 * time()); }
///       void forces() override { gravity(vehicles::gravity); tram.apply_suspensions(); ... }
///     };
class PlanarVehicle : public VehicleModel {
 public:
  /// @throws ModelError on impossible data
  PlanarVehicle(System& system, RailVehicle data);

  void place(const Expr& x) override;
  void apply_suspensions() override;
  void hold_wheels() override;

  const RailVehicle& data() const { return data_; }
  const AxleLoads& axle_loads() const { return loads_; }

  /// Bodies in the order of the data sheet.
  const std::vector<Body*>& car_bodies() const { return car_bodies_; }
  const std::vector<Body*>& frames() const { return frames_; }  ///< of the gears that have one

 private:
  struct CarMotion {
    std::optional<Coordinate> heave;  // none for a body hinged to the one before it
    Coordinate pitch;
    double hinge_x = 0;
  };
  struct WheelPairMotion {
    WheelPairModel pair;
    VerticalSpringDamper primary;
    double x;
  };
  struct FrameMotion {
    Body* body;
    Coordinate heave, pitch;
  };
  struct GearMotion {
    std::optional<FrameMotion> frame;
    std::vector<VerticalSpringDamper> secondaries;
    std::vector<WheelPairMotion> wheel_pairs;
  };

  RailVehicle data_;
  AxleLoads loads_;
  std::vector<Body*> car_bodies_, frames_;
  std::vector<CarMotion> cars_;
  std::vector<GearMotion> gears_;
};

}  // namespace easydyn::vehicles

#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "easydyn/easydyn.hpp"
#include "vehicles/axle_loads.hpp"
#include "vehicles/rail_vehicle.hpp"

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
class PlanarVehicle {
 public:
  /// One wheel pair where it meets the rail.
  struct Wheel {
    std::string name;    ///< of the wheel pair
    Body* body;          ///< runs on the rail: the tyre, or the hub of a solid wheel
    double x;            ///< from the vehicle's origin [m]
    double radius;       ///< [m]
    int contacts;        ///< wheel/rail contacts side by side
    double static_load;  ///< axle load in the loaded state [N]
  };

  /// @throws ModelError on impossible data
  PlanarVehicle(System& system, RailVehicle data);
  PlanarVehicle(const PlanarVehicle&) = delete;

  /// Places all bodies; x = position of the vehicle's origin [m]. In System::positions().
  void place(const Expr& x);
  /// Applies all suspensions. In System::forces().
  void apply_suspensions();

  const RailVehicle& data() const { return data_; }
  const std::vector<Wheel>& wheels() const { return wheels_; }
  const AxleLoads& axle_loads() const { return loads_; }
  double weight() const { return data_.weight(); }
  double front_wheel_x() const;  ///< of the foremost wheel pair, from the origin [m]
  double rear_wheel_x() const;

  /// Bodies in the order of the data sheet.
  const std::vector<Body*>& car_bodies() const { return car_bodies_; }
  const std::vector<Body*>& frames() const { return frames_; }

 private:
  struct CarMotion {
    std::optional<Coordinate> heave;  // none for a body hinged to the one before it
    Coordinate pitch;
    double hinge_x = 0;
  };
  struct WheelPairMotion {
    Body* hub;
    Coordinate hub_heave;
    Body* tyre;  // null for a solid wheel
    std::optional<Coordinate> tyre_heave;
    VerticalSpringDamper primary;
    std::optional<VerticalSpringDamper> resilient;
    double x;
  };
  struct GearMotion {
    Body* frame;
    Coordinate heave, pitch;
    std::vector<VerticalSpringDamper> secondaries;
    std::vector<WheelPairMotion> wheel_pairs;
  };

  RailVehicle data_;
  AxleLoads loads_;
  std::vector<Body*> car_bodies_, frames_;
  std::vector<CarMotion> cars_;
  std::vector<GearMotion> gears_;
  std::vector<Wheel> wheels_;
};

}  // namespace easydyn::vehicles

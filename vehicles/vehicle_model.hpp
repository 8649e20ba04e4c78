#pragma once

#include <string>
#include <vector>

#include "easydyn/easydyn.hpp"

namespace easydyn::vehicles {

/// A vehicle built into a multibody system, in as much detail as the class behind it has: the whole one
/// (`PlanarVehicle`) or a simplified one (`SimplifiedVehicle`). Programs that use this face can exchange them.
///
/// Every height is zero in the loaded state on a level rigid track. The forward motion x(t) is imposed.
class VehicleModel {
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

  VehicleModel() = default;
  virtual ~VehicleModel() = default;
  VehicleModel(const VehicleModel&) = delete;
  VehicleModel& operator=(const VehicleModel&) = delete;

  /// Places all bodies; x = position of the vehicle's origin [m]. In System::positions().
  virtual void place(const Expr& x) = 0;
  /// Applies all suspensions. In System::forces().
  virtual void apply_suspensions() = 0;
  /// Holds what runs on the rail at z = 0: the vehicle on rigid rails. Before a run, not during one.
  virtual void hold_wheels() = 0;

  const std::vector<Wheel>& wheels() const { return wheels_; }
  double weight() const;         ///< sum of the axle loads: of the whole vehicle, in any detail [N]
  double front_wheel_x() const;  ///< of the foremost wheel pair, from the origin [m]
  double rear_wheel_x() const;

 protected:
  std::vector<Wheel> wheels_;
};

}  // namespace easydyn::vehicles

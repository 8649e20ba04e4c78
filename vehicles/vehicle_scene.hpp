#pragma once

#include <Eigen/Core>
#include <vector>

#include "easydyn/visu/scene.hpp"
#include "vehicles/rail_vehicle.hpp"

namespace easydyn::vehicles {

/// Heights at which a vehicle is drawn; they play no part in its dynamics [m].
struct DrawingHeights {
  double rail = 0;           ///< top of the rail above z = 0
  double floor = 0.55;       ///< underside of the bodies above the rail
  double body_height = 2.7;  ///< of the bodies
  double width = 2.3;        ///< of the bodies
  double gauge = 1.435;
};

/// Motion of a vehicle over time, as `track::Passage` or any other run gives it.
struct VehicleMotion {
  Eigen::VectorXd time;             ///< nt [s]
  Eigen::VectorXd origin_x;         ///< nt, position of the vehicle's origin [m]
  std::vector<std::string> bodies;  ///< names, as in the multibody system
  Eigen::MatrixXd height;           ///< nt x bodies: heave [m], up
  Eigen::MatrixXd pitch;            ///< nt x bodies [rad], nose down
};

/// Adds a vehicle to a scene: bodies as boxes, frames as bars, wheels as discs, secondary and primary
/// suspensions as springs. Sets Scene::time. Small motions are exaggerated by the scene's factor.
void add_vehicle(visu::Scene& scene, const RailVehicle& vehicle, const VehicleMotion& motion,
                 const DrawingHeights& heights = {});

}  // namespace easydyn::vehicles

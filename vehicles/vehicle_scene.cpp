#include "vehicles/vehicle_scene.hpp"

#include <algorithm>

#include "easydyn/error.hpp"

namespace easydyn::vehicles {

namespace {

using Eigen::Index;
using Eigen::Vector3d;

// Adds the moving frame of one body whose place in the vehicle is (x, drawn height z).
void add_frame(visu::Scene& scene, const VehicleMotion& motion, const std::string& name, double x, double z) {
  const auto found = std::find(motion.bodies.begin(), motion.bodies.end(), name);
  if (found == motion.bodies.end()) throw ModelError("vehicle scene: no motion of body \"" + name + "\"");
  const Index b = found - motion.bodies.begin();
  visu::MovingFrame frame{name, {}, visu::Pose{Vector3d(x, 0, z)}};
  for (Index i = 0; i < motion.time.size(); ++i)
    frame.poses.push_back({Vector3d(motion.origin_x[i] + x, 0, z + motion.height(i, b)),
                           Eigen::Quaterniond(Eigen::AngleAxisd(motion.pitch(i, b), Vector3d::UnitY()))});
  scene.frames.push_back(std::move(frame));
}

}  // namespace

void add_vehicle(visu::Scene& scene, const RailVehicle& vehicle, const VehicleMotion& motion,
                 const DrawingHeights& heights) {
  scene.time = motion.time;
  const double body_z = heights.rail + heights.floor + heights.body_height / 2;
  for (const CarBody& car : vehicle.bodies) {
    add_frame(scene, motion, car.name, car.x, body_z);
    scene.items.push_back({.name = car.name,
                           .frame = car.name,
                           .shape = visu::Shape::box,
                           .size = {car.length - 0.15, heights.width, heights.body_height},
                           .colour = "#4477aa",
                           .offset = {Vector3d(car.middle_offset, 0, 0)},
                           .opacity = 0.55});
  }

  for (const RunningGear& gear : vehicle.gears) {
    double axle_z = 0, front = -1e9, rear = 1e9;
    for (const WheelPair& pair : gear.wheel_pairs) {
      axle_z = std::max(axle_z, double(pair.radius));
      front = std::max(front, double(pair.x));
      rear = std::min(rear, double(pair.x));
    }
    if (gear.has_frame()) {
      add_frame(scene, motion, gear.name, gear.x, heights.rail + axle_z + 0.12);
      scene.items.push_back({.name = gear.name,
                             .frame = gear.name,
                             .shape = visu::Shape::box,
                             .size = {front - rear + 0.3, 0.6 * heights.gauge, 0.14},
                             .colour = "#bb5566"});
    }
    for (const SecondarySuspension& s : gear.secondaries) {
      const auto body = static_cast<std::size_t>(vehicle.body_index(s.body));
      scene.links.push_back({.name = gear.name + ", secondary",
                             .a = {gear.name, {s.x - gear.x, 0, 0.07}},
                             .b = {s.body, {s.x - vehicle.bodies[body].x, 0, 0.3 - heights.body_height / 2}},
                             .shape = visu::LinkShape::spring,
                             .radius = 0.08,
                             .colour = "#228833"});
    }
    for (const WheelPair& pair : gear.wheel_pairs) {
      const std::string hub = pair.name + (pair.resilient ? ", hub" : "");
      const std::string rolling = pair.resilient ? pair.name + ", tyre" : hub;
      add_frame(scene, motion, rolling, pair.x, heights.rail + pair.radius);
      if (pair.resilient) add_frame(scene, motion, hub, pair.x, heights.rail + pair.radius);
      for (double side : {-0.5, 0.5})
        scene.items.push_back({.name = rolling,
                               .frame = rolling,
                               .shape = visu::Shape::wheel,
                               .size = {double(pair.radius), 0.12, 0},
                               .colour = "#444444",
                               .offset = {Vector3d(0, side * heights.gauge, 0)}});
      // The primary suspension, from the hub to the frame's underside or the body's floor.
      visu::Anchor top{gear.name, {pair.x - gear.x, 0, -0.07}};
      if (!gear.has_frame()) {
        const auto body = static_cast<std::size_t>(vehicle.body_index(gear.body));
        top = {gear.body, {pair.x - vehicle.bodies[body].x, 0, -heights.body_height / 2}};
      }
      for (double side : {-0.4, 0.4}) {
        top.point.y() = side * heights.gauge;
        scene.links.push_back({.name = pair.name + ", primary",
                               .a = {hub, {0, side * heights.gauge, 0}},
                               .b = top,
                               .shape = visu::LinkShape::spring,
                               .radius = 0.06,
                               .colour = "#228833"});
      }
    }
  }
}

}  // namespace easydyn::vehicles

#include "vehicles/vehicle_model.hpp"

#include <algorithm>

namespace easydyn::vehicles {

double VehicleModel::weight() const {
  double sum = 0;
  for (const Wheel& wheel : wheels_) sum += wheel.static_load;
  return sum;
}

double VehicleModel::front_wheel_x() const {
  return std::ranges::max_element(wheels_, {}, &Wheel::x)->x;
}

double VehicleModel::rear_wheel_x() const {
  return std::ranges::min_element(wheels_, {}, &Wheel::x)->x;
}

}  // namespace easydyn::vehicles

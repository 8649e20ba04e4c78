#include "vehicles/moving_loads.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "easydyn/math/units.hpp"
#include "vehicles/axle_loads.hpp"

namespace easydyn::vehicles {

double MovingLoads::total() const {
  double sum = 0;
  for (const MovingLoad& load : loads) sum += load.load;
  return sum;
}

double MovingLoads::length() const {
  if (loads.empty()) return 0;
  const auto [rear, front] =
      std::ranges::minmax(loads, {}, [](const MovingLoad& load) { return load.x.value; });
  return front.x - rear.x;
}

MovingLoads moving_loads(const RailVehicle& vehicle) {
  const AxleLoads statics = compute_axle_loads(vehicle);
  MovingLoads train{vehicle.name, {}};
  for (std::size_t g = 0; g < vehicle.gears.size(); ++g)
    for (std::size_t w = 0; w < vehicle.gears[g].wheel_pairs.size(); ++w) {
      const WheelPairLoad& pair = statics.wheel_pairs[g][w];
      train.loads.push_back({pair.name,
                             vehicle.gears[g].wheel_pairs[w].x,
                             {pair.axle_load, "C: statics of " + vehicle.label()}});
    }
  return train;
}

MovingLoads x2000_ledsgard() {
  using namespace easydyn::units;
  const std::string source = "F: FreqTrack repository, after Madshus & Kaynia 2000";
  // from one axle to the next one behind [m]; loads [kN]
  const double increments[20] = {0,    2.9, 6.6, 2.9, 4.1,  2.9, 14.8, 2.9, 4.1,  2.9,
                                 14.8, 2.9, 4.1, 2.9, 14.8, 2.9, 4.1,  2.9, 11.6, 2.9};
  const double loads[20] = {181, 181, 180, 180, 122, 122, 122, 122, 122, 122,
                            122, 122, 122, 122, 122, 122, 117, 117, 160, 160};
  double length = 0;
  for (const double step : increments) length += step;
  MovingLoads train{"X2000, Ledsgard", {}};
  double x = length / 2;
  for (int i = 0; i < 20; ++i) {
    x -= increments[i] * m;
    train.loads.push_back({fmt::format("axle {}", i + 1), {x, source}, {loads[i] * kN, source}});
  }
  return train;
}

std::vector<Parameter> parameters(const MovingLoads& train) {
  std::vector<Parameter> table;
  const std::string group = "moving loads \"" + train.name + "\"";
  for (const MovingLoad& load : train.loads) {
    table.push_back({group, load.name + ", x", load.x, "m", load.x.source});
    table.push_back({group, load.name + ", load", load.load, "N", load.load.source});
  }
  return table;
}

}  // namespace easydyn::vehicles

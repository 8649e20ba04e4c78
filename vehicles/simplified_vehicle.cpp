#include "vehicles/simplified_vehicle.hpp"

#include <fmt/format.h>

#include "easydyn/require.hpp"
#include "vehicles/axle_loads.hpp"

namespace easydyn::vehicles {
namespace {

struct Support {
  double stiffness, damping;
};

/// Limit of two complex stiffnesses k + i w d in series at w -> 0, to first order in w.
Support in_series(const Support& a, const Support& b) {
  const double sum = a.stiffness + b.stiffness;
  return {a.stiffness * b.stiffness / sum,
          (a.damping * b.stiffness * b.stiffness + b.damping * a.stiffness * a.stiffness) / (sum * sum)};
}

}  // namespace

SimplifiedVehicle::SimplifiedVehicle(System& system, const RailVehicle& data, VehicleDetail detail) {
  const AxleLoads statics = compute_axle_loads(data);
  for (std::size_t g = 0; g < data.gears.size(); ++g) {
    const RunningGear& gear = data.gears[g];
    Support secondary{0, 0};
    for (const SecondarySuspension& s : gear.secondaries) {
      secondary.stiffness += s.stiffness;
      secondary.damping += s.damping;
    }
    double gear_force = 0;
    for (const WheelPairLoad& load : statics.wheel_pairs[g]) gear_force += load.primary;

    for (std::size_t w = 0; w < gear.wheel_pairs.size(); ++w) {
      const WheelPair& pair = gear.wheel_pairs[w];
      const WheelPairLoad& load = statics.wheel_pairs[g][w];
      const std::string object = fmt::format("{}, wheel pair \"{}\", simplified", data.label(), pair.name);
      require_positive(object, "static force of the primary suspension", load.primary, "N");
      const double share = load.primary / gear_force;
      const double frame_mass = share * gear.frame_mass, mass = load.primary / gravity;
      const Support k_p{pair.primary_stiffness, pair.primary_damping};
      const Support k_s{share * secondary.stiffness, share * secondary.damping};

      Column column{WheelPairModel(system, pair, load), {}, {}};
      const auto add_mass = [&](const std::string& name, double m, const Support& support, double preload) {
        column.masses.push_back(
            {&system.body(pair.name + ", " + name, Inertia(m)),
             system.coordinate(pair.name + ", " + name + ", heave"),
             {pair.name + ", under its " + name, support.stiffness, support.damping, 0, preload}});
      };
      switch (detail) {
        case VehicleDetail::wheel_pair:
          column.load_above.emplace(pair.name + ", force above", 0, 0, 0, load.primary);
          break;
        case VehicleDetail::quarter:
          add_mass("body share", mass, gear.has_frame() ? in_series(k_p, k_s) : k_p, load.primary);
          break;
        case VehicleDetail::three_masses:
          require_positive(object, "body mass", mass - frame_mass, "kg");
          if (gear.has_frame()) add_mass("frame share", frame_mass, k_p, load.primary);
          add_mass("body share", mass - frame_mass, gear.has_frame() ? k_s : k_p,
                   gravity * (mass - frame_mass));
          break;
      }
      wheels_.push_back(column.pair.wheel());
      columns_.push_back(std::move(column));
    }
  }
}

void SimplifiedVehicle::place(const Expr& x) {
  for (Column& column : columns_) {
    column.pair.place(x);
    for (Mass& mass : column.masses) *mass.body = translate(x + column.pair.wheel().x, 0, mass.heave);
  }
}

void SimplifiedVehicle::apply_suspensions() {
  for (Column& column : columns_) {
    column.pair.apply_resilience();
    const Body* below = &column.pair.hub();
    for (Mass& mass : column.masses) {
      mass.support.apply(*below, {0, 0, 0}, *mass.body, {0, 0, 0});
      below = mass.body;
    }
    if (column.load_above) column.load_above->apply(column.pair.hub(), {0, 0, 0}, Frame(), {0, 0, 0});
  }
}

void SimplifiedVehicle::hold_wheels() {
  for (Column& column : columns_) column.pair.hold();
}

}  // namespace easydyn::vehicles

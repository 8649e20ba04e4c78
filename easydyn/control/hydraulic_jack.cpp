#include "easydyn/control/hydraulic_jack.hpp"

#include "easydyn/forces/account.hpp"
#include "easydyn/forces/line_of_action.hpp"
#include "easydyn/require.hpp"

namespace easydyn {

HydraulicJack::HydraulicJack(System& system, std::string name, const Data& data)
    : name_(std::move(name)),
      data_(data),
      p_1_(system.first_order_state(name_ + ".pressure 1", data.pressure_1)),
      p_2_(system.first_order_state(name_ + ".pressure 2", data.pressure_2)) {
  const std::string object = "jack \"" + name_ + "\"";
  require_positive(object, "area 1", data.area_1, "m^2");
  require_positive(object, "area 2", data.area_2, "m^2");
  require_positive(object, "shortest length", data.shortest, "m");
  require(data.longest > data.shortest, object, "longest length", data.longest, "m", "> shortest length");
  require_positive(object, "dead volume", data.dead_volume, "m^3");
  require_positive(object, "bulk modulus", data.bulk_modulus, "Pa");
  require_not_negative(object, "leakage", data.leakage, "m^3/(s Pa)");
  require_not_negative(object, "tank pressure", data.tank_pressure, "Pa");
  require(data.supply_pressure > data.tank_pressure, object, "supply pressure", data.supply_pressure, "Pa",
          "> tank pressure");
  require_positive(object, "rated flow", data.rated_flow, "m^3/s");
  require_positive(object, "rated pressure drop", data.rated_pressure_drop, "Pa");
  require_not_negative(object, "pressure 1", data.pressure_1, "Pa");
  require_not_negative(object, "pressure 2", data.pressure_2, "Pa");
}

// Q_r y sqrt(x), x = dp / p_r, with its sign; x / (x^2 + 1e-6)^(1/4) is smooth at zero.
double HydraulicJack::edge_flow(double opening, double pressure_drop) const {
  const double x = pressure_drop / data_.rated_pressure_drop;
  return data_.rated_flow * opening * x / std::pow(x * x + 1e-6, 0.25);
}

void HydraulicJack::apply(const Frame& frame_A, const Eigen::Vector3d& p_A, const Frame& frame_B,
                          const Eigen::Vector3d& p_B, double opening) {
  const LineOfAction line("jack", name_, frame_A, p_A, frame_B, p_B);
  length_ = line.length;
  if (!(std::abs(opening) <= 1) || !(length_ >= data_.shortest && length_ <= data_.longest)) {
    const std::string object = "jack \"" + name_ + "\"";
    require(std::abs(opening) <= 1, object, "valve opening", opening, "", "-1 to 1");
    require(false, object, "length", length_, "m",
            fmt::format("{:g} to {:g} (use stops)", data_.shortest, data_.longest));
  }

  // Flows into the chambers: from the supply, and to the tank.
  const double p_1 = p_1_.value(), p_2 = p_2_.value(), p_s = data_.supply_pressure, p_t = data_.tank_pressure;
  const double from_supply = edge_flow(std::abs(opening), p_s - (opening > 0 ? p_1 : p_2)),
               to_tank = edge_flow(std::abs(opening), (opening > 0 ? p_2 : p_1) - p_t);
  const double q_1 = opening > 0 ? from_supply : -to_tank, q_2 = opening > 0 ? -to_tank : from_supply;
  const double leak = data_.leakage * (p_1 - p_2);

  const double V_1 = data_.dead_volume + data_.area_1 * (length_ - data_.shortest),
               V_2 = data_.dead_volume + data_.area_2 * (data_.longest - length_),
               V_1_rate = data_.area_1 * line.rate, V_2_rate = -data_.area_2 * line.rate,
               beta = data_.bulk_modulus;
  p_1_.set_rate(beta / V_1 * (q_1 - V_1_rate - leak));
  p_2_.set_rate(beta / V_2 * (q_2 - V_2_rate + leak));
  force_ = p_1 * data_.area_1 - p_2 * data_.area_2;
  line.pull(-force_);

  const double density_1 = p_1 * p_1 / (2 * beta), density_2 = p_2 * p_2 / (2 * beta);  // energy per volume
  const double throttled = opening > 0 ? (p_s - p_1) * from_supply + (p_2 - p_t) * to_tank
                                       : (p_s - p_2) * from_supply + (p_1 - p_t) * to_tank;
  account(frame_A, frame_B, V_1 * density_1 + V_2 * density_2, throttled + leak * (p_1 - p_2),
          p_s * from_supply - p_t * to_tank + density_1 * V_1_rate + density_2 * V_2_rate);
}

}  // namespace easydyn

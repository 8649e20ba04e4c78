#pragma once

#include <Eigen/Core>
#include <string>

#include "easydyn/mbs/system.hpp"

namespace easydyn {

/// Double-acting hydraulic cylinder between the points A (bottom) and B (rod eye), fed by a four-way valve.
///
///   F = p_1 A_1 - p_2 A_2                                        pushes A and B apart, l = |AB|
///   V_1 p_1. = beta (q_1 - A_1 l. - c (p_1 - p_2))              V_1 = V_d + A_1 (l - l_min)
///   V_2 p_2. = beta (q_2 + A_2 l. + c (p_1 - p_2))              V_2 = V_d + A_2 (l_max - l)
///
/// Valve opening y, -1 to 1: for y > 0 chamber 1 is open to the supply and 2 to the tank, for y < 0 the reverse; flow of
/// one edge q = y Q_r sqrt(dp / p_r), made smooth below 1e-3 p_r. Pressures are above that of the tank's surroundings;
/// cavitation is not modelled: keep them positive.
/// The pressures are first-order states "name.pressure 1" and "name.pressure 2".
/// Potential energy of the compressed oil V p^2 / (2 beta); dissipated: throttling and leakage; supplied: p_s q from the
/// pump less p_t q to the tank, and the energy p^2 / (2 beta) per volume that compressed oil brings along.
/// Reference: H. E. Merritt, Hydraulic Control Systems, Wiley, 1967, ch. 6.
class HydraulicJack {
 public:
  struct Data {
    double area_1 = 0, area_2 = 0;          ///< of the piston, bottom and rod side [m^2], > 0
    double shortest = 0, longest = 0;       ///< l_min, l_max [m], 0 < l_min < l_max
    double dead_volume = 0;                 ///< V_d of each side with its hose [m^3], > 0
    double bulk_modulus = 1.4e9;            ///< beta of the oil in its hoses [Pa], > 0
    double leakage = 0;                     ///< c over the piston [m^3/(s Pa)], >= 0
    double supply_pressure = 0;             ///< p_s [Pa], > p_t
    double tank_pressure = 0;               ///< p_t [Pa], >= 0
    double rated_flow = 0;                  ///< Q_r of one edge, fully open [m^3/s], > 0
    double rated_pressure_drop = 35e5;      ///< p_r over one edge [Pa], > 0
    double pressure_1 = 0, pressure_2 = 0;  ///< at the start [Pa], >= 0
  };

  /// @throws ModelError naming the jack, the value and the range
  HydraulicJack(System& system, std::string name, const Data& data);

  /// Applies the force and sets the rates of the pressures. Once per evaluation, in System::forces().
  /// @param opening  y, -1 to 1
  /// @throws ModelError if y is out of its range, or the length is not between l_min and l_max
  void apply(const Frame& frame_A, const Eigen::Vector3d& p_A, const Frame& frame_B,
             const Eigen::Vector3d& p_B, double opening);

  const FirstOrderState& pressure_1() const { return p_1_; }  ///< [Pa]
  const FirstOrderState& pressure_2() const { return p_2_; }  ///< [Pa]
  double force() const { return force_; }                     ///< F at the last evaluation [N]
  double length() const { return length_; }                   ///< l at the last evaluation [m]
  const std::string& name() const { return name_; }

 private:
  double edge_flow(double opening, double pressure_drop) const;
  std::string name_;
  Data data_;
  FirstOrderState p_1_, p_2_;
  double force_ = 0, length_ = 0;
};

}  // namespace easydyn

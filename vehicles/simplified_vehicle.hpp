#pragma once

#include <optional>
#include <vector>

#include "vehicles/rail_vehicle.hpp"
#include "vehicles/vehicle_model.hpp"
#include "vehicles/wheel_pair_model.hpp"

namespace easydyn::vehicles {

/// What is left above each wheel pair of a simplified vehicle.
enum class VehicleDetail {
  wheel_pair,   ///< the constant force of its primary suspension
  quarter,      ///< one mass on the primary and the secondary suspension in series
  three_masses  ///< a frame mass on the primary, a body mass on the secondary suspension
};

/// A vehicle whose wheel pairs know nothing of each other: to show what vehicle detail is worth. It can stand where a
/// `PlanarVehicle` stands; below it come the moving forces of moving_loads.hpp.
///
///     F         [ m ]         [ m_b ]
///     |           >             >  k_s, d_s
///     |           >  k, d     [ m_f ]
///     |           >             >  k_p, d_p
///    (o)         (o)           (o)             wheel pair of the data sheet, resilient tyre included
///   wheel_pair  quarter     three_masses
///
/// P: static force of the pair's primary suspension (`compute_axle_loads`); the pair has the share s = P / (sum of P in
/// its gear) of everything above: m_f = s m_frame, m_b = P / g - m_f, k_s and d_s = s times the gear's sums, m = P / g.
/// So every axle load is that of the whole vehicle, and `three_masses` of a symmetric car keep the poles of its bounce. In
/// series
///
///   k = k_p k_s / (k_p + k_s),   d = (d_p k_s^2 + d_s k_p^2) / (k_p + k_s)^2
///
/// where d is the limit at low frequencies of the two complex stiffnesses in series. Without a frame (`RunningGear::body`)
/// the body's share stands on k_p, d_p in both. Left out: pitch, and the
/// coupling of wheel pairs through frames, bodies and hinges; of `quarter` also the frame's own motion, of `wheel_pair`
/// every motion above the hub.
class SimplifiedVehicle : public VehicleModel {
 public:
  /// @throws ModelError on impossible data, or if the statics lift a wheel pair: P must be > 0, and for `three_masses`
  ///         the body's part of it
  SimplifiedVehicle(System& system, const RailVehicle& data, VehicleDetail detail);

  void place(const Expr& x) override;
  void apply_suspensions() override;
  void hold_wheels() override;

 private:
  struct Mass {
    Body* body;
    Coordinate heave;
    VerticalSpringDamper support;  // stands on the mass below, or on the hub
  };
  struct Column {
    WheelPairModel pair;
    std::vector<Mass> masses;                        // from below
    std::optional<VerticalSpringDamper> load_above;  // without stiffness: a force
  };
  std::vector<Column> columns_;
};

}  // namespace easydyn::vehicles

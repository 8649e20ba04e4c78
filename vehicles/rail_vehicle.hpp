#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "easydyn/parameter.hpp"

namespace easydyn::vehicles {

/// Acceleration of gravity [m/s2] used for weights and axle loads.
inline constexpr double gravity = 9.81;

/// A car body. It heaves and pitches as a rigid body.
struct CarBody {
  std::string name;
  Sourced mass;           ///< [kg], > 0
  Sourced pitch_inertia;  ///< about the centre of mass [kg m2], > 0
  Sourced x;              ///< of the centre of mass, in the vehicle's frame, forward [m]
  Sourced length;         ///< for drawing [m], > 0
  /// Of the middle of the length, ahead of the centre of mass, for drawing [m].
  Sourced middle_offset{0, "D: centre of mass in the middle"};
};

/// Joins two neighbouring bodies: equal heights at x, free relative pitch.
struct Hinge {
  std::string name;
  std::string front_body, rear_body;
  Sourced x;  ///< [m]
};

/// A vertical spring and damper between the frame of a running gear and a body.
struct SecondarySuspension {
  std::string body;
  Sourced x;          ///< [m]
  Sourced stiffness;  ///< [N/m], > 0
  Sourced damping;    ///< [N s/m], >= 0
};

/// A tyre on a rubber layer: the tyre runs on the rail, the hub carries the primary suspension.
struct ResilientWheel {
  Sourced tyre_mass;  ///< of the pair, part of the pair's mass [kg], > 0
  Sourced stiffness;  ///< tyre to hub, of the pair [N/m], > 0
  Sourced damping;    ///< of the pair [N s/m], >= 0
};

/// Two wheels on one line across the track, on an axle or independent. All values are for the pair.
struct WheelPair {
  std::string name;
  Sourced x;                  ///< [m]
  Sourced mass;               ///< unsprung, with everything rigid on it (motors), tyres included [kg], > 0
  Sourced radius;             ///< [m], > 0
  Sourced primary_stiffness;  ///< to the frame, or to the body of a gear without frame [N/m], > 0
  Sourced primary_damping;    ///< [N s/m], >= 0
  std::optional<ResilientWheel> resilient = {};
  int contacts = 2;                 ///< wheel/rail contacts side by side
  bool has_rubber_primary = false;  ///< rubber springs may be stiffer than coils; for unusual_values() alone
};

/// Bogie or running gear: a frame on one or more wheel pairs, under one or more bodies; or, as below a two-axle wagon,
/// wheel pairs without a frame, whose primary suspensions carry `body` itself.
struct RunningGear {
  std::string name;
  Sourced frame_mass = {};           ///< [kg], > 0; 0 without frame
  Sourced frame_pitch_inertia = {};  ///< [kg m2], > 0; 0 without frame
  Sourced x;                         ///< of the frame's centre of mass [m]; without frame for the reader only
  Sourced pivot_x;  ///< nominal centre of rotation under the body [m]; for the reader, not the statics
  std::vector<SecondarySuspension> secondaries = {};  ///< at least one; none without frame
  std::vector<WheelPair> wheel_pairs;
  std::string body = {};  ///< carried by the primary suspensions of a gear without frame; else empty

  bool has_frame() const { return body.empty(); }
};

/// A rail vehicle (or train) in the vertical plane, as a data sheet.
///
/// x forward, from the vehicle's own origin; heights are not needed: every motion is heave and pitch. All
/// values are for the whole vehicle, left and right together. The nominal geometry is the loaded state: the
/// suspensions carry the preloads of axle_loads.hpp, and z = 0 everywhere is the static equilibrium on a
/// rigid level track.
struct RailVehicle {
  std::string name;
  std::vector<CarBody> bodies;  ///< from front to rear
  std::vector<Hinge> hinges;
  std::vector<RunningGear> gears;  ///< from front to rear
  Sourced length;                  ///< over all [m], > 0

  std::string label() const { return "vehicle \"" + name + "\""; }  ///< for messages and tables
  /// Index of the body. @throws ModelError if there is none of that name
  int body_index(std::string_view body) const;
  double mass() const;    ///< of everything [kg]
  double weight() const;  ///< [N]
  int wheel_pair_count() const;
};

/// @throws ModelError on impossible values: object, quantity, value and accepted range are named
void validate(const RailVehicle& vehicle);

/// Stiffness of a track under one wheel pair, both rails together [N/m]. C: k = 2 sqrt(2) (E I)^(1/4) k'^(3/4), the beam
/// of Zimmermann on pads and ballast in series k' per metre, rigid ground: 0.96e8 on the bundled tram track, 1.63e8 on
/// the bundled high-speed track; rounded towards the softer.
inline constexpr double usual_track_stiffness = 1e8;

/// Values that are possible but unusual: one sentence each, which names object, value and range; empty if there is
/// none. The ranges (D):
///
///   body 8-60 t, frame 1.7-7 t, wheel pair 0.35-2.3 t
///   primary 0.5-5 MN/m per pair, of rubber to 44 MN/m; secondary 0.2-6 MN/m per gear
///   modes on rigid rails (vehicle_modes.hpp) in which a body moves most: bounce 0.4-2 Hz, pitch 0.4-2.5 Hz
///   modes in which a frame bounces most: 4-12 Hz, on rubber primaries to 40 Hz
///   the whole wheel pair, mass m, on the track: sqrt(k / m) / (2 pi) from 30 to 90 Hz
///
/// @param track_stiffness  k, under one wheel pair [N/m], > 0
/// @throws ModelError on impossible data, as compute_axle_loads()
std::vector<std::string> unusual_values(const RailVehicle& vehicle,
                                        double track_stiffness = usual_track_stiffness);

/// Every value with its unit and its provenance, for the report.
std::vector<Parameter> parameters(const RailVehicle& vehicle);

}  // namespace easydyn::vehicles

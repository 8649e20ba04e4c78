#pragma once

#include <string>
#include <vector>

#include "easydyn/parameter.hpp"
#include "track/foundation.hpp"
#include "track/rail_section.hpp"

namespace easydyn::track {

/// Ends of the track that swallow the waves in the rail: in the last bays on each side, where t runs from 0
/// to 1 towards the end, the rail elements get the damping
///   C_e = t^3 (alpha M_e + beta K_e).
/// On the bundled tracks the defaults send back less than 1e-5 of the response at the load below 200 Hz, and
/// less than 1e-3 up to 700 Hz, for a load 5 m before the absorbing bays.
struct AbsorbingEnds {
  int bays = 20;        ///< on each side, >= 0; 0 = plain free ends
  double alpha = 4000;  ///< [1/s], >= 0
  double beta = 2e-4;   ///< [s], >= 0
};

/// A straight ballasted track as a data sheet. All values hold for the WHOLE track (both rails together)
/// unless they say "per rail"; per sleeper where they are lumped.
///
///   rail -- (pad k_p, d_p) -- sleeper m_s -- (ballast k_b, d_b) -- foundation
///
/// Gravity acts on the vehicle only: the dead load of the track is already in the ground.
struct TrackData {
  std::string name;
  RailSection rail;           ///< one rail
  int rails = 2;              ///< >= 1
  Sourced sleeper_spacing;    ///< [m], > 0
  Sourced pad_stiffness;      ///< k_p [N/m], > 0
  Sourced pad_damping;        ///< d_p [N s/m], >= 0
  Sourced sleeper_mass;       ///< m_s [kg], > 0
  Sourced ballast_stiffness;  ///< k_b [N/m], > 0
  Sourced ballast_damping;    ///< d_b [N s/m], >= 0
  Foundation foundation;      ///< default: rigid ground
  Sourced footprint_length;   ///< of a sleeper on the ground, along x [m], > 0
  Sourced footprint_width;    ///< along y [m], > 0
  int elements_per_bay = 4;   ///< rail elements between two sleepers, >= 1
  AbsorbingEnds ends;

  std::string label() const { return "track \"" + name + "\""; }  ///< for messages and tables
};

/// @throws ModelError naming the track, the quantity, its value and the accepted range
void validate(const TrackData& data);

/// Every value with its unit and its provenance, for the report.
std::vector<Parameter> parameters(const TrackData& data);

/// Representative of the Brussels tram network (not its owner's data): 50E2, sleepers every 0.72 m, CLM
/// fitted on layered ground of the Brussels tram class.
TrackData t2000_like_track();

/// Representative of the high-speed line at Ath (not its owner's data): 60E1, monoblock sleepers every 0.6 m,
/// CLM fitted on the layered ground of Ath.
TrackData thalys_like_track();

}  // namespace easydyn::track

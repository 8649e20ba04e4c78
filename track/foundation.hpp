#pragma once

#include <string_view>
#include <variant>
#include <vector>

#include "easydyn/parameter.hpp"

namespace easydyn::track {

/// What the ballast of each sleeper rests on. Values hold per sleeper, for the whole track; displacements are
/// positive downward. From the simplest to the most complete, each but the first a special case of the next:
///
///   ballast -- foundation m_f -- (k_f, d_f) -- ground,   neighbours joined by (k_c, d_c)
///
/// m_f, d_f, k_c, d_c do not depend on frequency: the model follows a real soil up to 30-90 Hz, soft to
/// stiff. Reference: G. Kouroussis, G. Gazetas, I. Anastasopoulos, C. Conti, O. Verlinden, Discrete modelling
/// of vertical track-soil coupling for vehicle-track dynamics, Soil Dyn. Earthq. Eng. 31(12), 2011.
struct RigidGround {};

struct Winkler {
  Sourced k_f;  ///< [N/m], > 0
  Sourced d_f;  ///< [N s/m], >= 0
};

struct WinklerMass {
  Sourced m_f;  ///< [kg], >= 0
  Sourced k_f;  ///< [N/m], > 0
  Sourced d_f;  ///< [N s/m], >= 0
};

/// Coupled lumped mass model. At a wavenumber theta per spacing the chain has the stiffness
/// k_f + 2 k_c (1 - cos theta) and the damping d_f + 2 d_c (1 - cos theta): it is passive, that is it never
/// gives more work than it received, if and only if
///   m_f >= 0,  k_f >= 0,  k_f + 4 k_c >= 0,  d_f >= 0,  d_f + 4 d_c >= 0.
/// A negative d_c is physical (waves take time to reach the neighbour) within that bound.
struct Clm {
  Sourced m_f;  ///< [kg]
  Sourced k_f;  ///< [N/m]
  Sourced d_f;  ///< [N s/m]
  Sourced k_c;  ///< [N/m]
  Sourced d_c;  ///< [N s/m]
};

using Foundation = std::variant<RigidGround, Winkler, WinklerMass, Clm>;

/// "rigid", "Winkler", "Winkler with mass" or "CLM".
std::string_view kind_of(const Foundation& foundation);

bool is_rigid(const Foundation& foundation);

/// The same foundation with all five constants, absent ones 0. Not for rigid ground (all zero: no
/// foundation).
Clm as_clm(const Foundation& foundation);

/// @throws ModelError naming `object`, the violated condition of passivity and the values in it
void validate(const Clm& clm, std::string_view object);
/// As above, and k_f > 0 so that the track does not sink.
void validate(const Foundation& foundation, std::string_view object);

/// Rows for the report, group `object`.
std::vector<Parameter> parameters(const Foundation& foundation, std::string_view object);

}  // namespace easydyn::track

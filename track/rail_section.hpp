#pragma once

#include <span>
#include <string>
#include <string_view>

namespace easydyn::track {

/// Cross-section and material of ONE rail.
struct RailSection {
  std::string name;
  double area = 0;              ///< A [m2], > 0
  double inertia = 0;           ///< I about the horizontal axis [m4], > 0
  double mass_per_length = 0;   ///< rho A [kg/m], > 0
  double youngs_modulus = 0;    ///< E [Pa], > 0
  std::string source;           ///< provenance of the row
  double shear_modulus = 77e9;  ///< G [Pa], > 0
  double shear_factor = 0.38;   ///< kappa [1], > 0: below 1.5 kHz
  std::string shear_source = "F: railFE, kappa = 0.38 below 1.5 kHz; G = 77 to 79 GPa";

  double bending_stiffness() const { return youngs_modulus * inertia; }           ///< E I [N m2]
  double shear_stiffness() const { return shear_factor * shear_modulus * area; }  ///< kappa G A [N]
  double rotary_inertia() const { return area > 0 ? mass_per_length * inertia / area : 0; }  ///< rho I [kg m]
};

/// The sections that come with the library.
std::span<const RailSection> rail_sections();

/// The section called `name` ("60E1", "UIC60", "54E1", "50E2", "46E3", "CN60").
/// @throws ModelError if there is none; the message names the nearest one
const RailSection& rail_section(std::string_view name);

}  // namespace easydyn::track

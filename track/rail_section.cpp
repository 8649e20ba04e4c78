#include "track/rail_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "easydyn/error.hpp"
#include "easydyn/math/units.hpp"
#include "easydyn/nearest_name.hpp"

namespace easydyn::track {
namespace {

using namespace easydyn::units;

const std::array<RailSection, 6> sections = {{
    // name    A [m2]    I [m4]      rho A [kg/m]  E [Pa]
    {"60E1", 7.67e-3, 3.038e-5, 60.21, 210 * GPa, "F: STEM"},
    {"UIC60", 7.67e-3, 3.038e-5, 60.21, 210 * GPa, "F: STEM (other name of 60E1)"},
    {"54E1", 6.977e-3, 2.3372e-5, 54.77, 210 * GPa, "F: STEM"},
    {"50E2", 6.365e-3, 1.9887e-5, 49.97, 210 * GPa, "M-m: EN 13674-1"},
    {"46E3", 5.944e-3, 1.606e-5, 46.66, 210 * GPa, "F: STEM"},
    {"CN60", 7.745e-3, 3.217e-5, 60.64, 205.9 * GPa, "F: TTB-2D"},
}};

}  // namespace

std::span<const RailSection> rail_sections() {
  return sections;
}

const RailSection& rail_section(std::string_view name) {
  const auto found = std::ranges::find(sections, name, &RailSection::name);
  if (found != sections.end()) return *found;
  const auto nearest = std::ranges::min_element(
      sections, {}, [&](const RailSection& section) { return edit_distance(name, section.name); });
  throw ModelError(fmt::format("rail section \"{}\" is unknown, the nearest is \"{}\"", name, nearest->name));
}

}  // namespace easydyn::track

#pragma once

#include <filesystem>
#include <string>

#include "track/spline_profile.hpp"

namespace easydyn::track {

struct ProfileFileOptions {
  /// Units of the columns: m, dm, cm, mm, um, or km. Empty: those in brackets in the header of the file. One of
  /// both must say them; where both do, they must agree.
  std::string x_unit = {}, r_unit = {};
  SplineProfileOptions spline = {};
};

/// Reads a vertical profile from a text file of two columns: position x along the track and height r, **up**:
///
///     # measured 2024, left rail
///     x [m], r [mm]
///     0.00, 0.0
///     0.25, 0.4
///
/// Columns are separated by `,` or `;` (the same in the whole file), the decimal mark is the point. `#` begins a
/// comment; empty lines are left out. The header is optional where the options give the units. Positions ascend
/// strictly; at least four points. The profile goes through the points as they are: nothing is resampled.
///
/// @throws InputError `file:line:column: ` naming the value and what it must be; if the file cannot be read
SplineProfile read_profile(const std::filesystem::path& path, const ProfileFileOptions& options = {});

}  // namespace easydyn::track

#pragma once

#include <filesystem>
#include <string>

#include "vehicles/rail_vehicle.hpp"

namespace easydyn::vehicles {

struct DrawingOptions {
  double width = 1000;  ///< of the picture at most [px], >= 300
  double row_length =
      52;  ///< a longer train is wrapped over rows, between bodies, none longer than this where
           ///< its bodies allow [m], > 0
  double body_height = 2.7;  ///< [m], > 0
};

/// Side elevation of a vehicle as an SVG image: bodies with their masses and centres of mass, frames, suspensions and
/// wheels at their places, static axle loads [kN] under the axles, and dimensions [m]: wheelbases, distances of the
/// pivots, lengths of the bodies and over all.
///
/// Lengths and wheels are to scale; heights above the wheels and the suspensions are symbols. Forward is to the right;
/// rows follow from the front, and a gear shared by two rows is grey where it stands again.
/// @throws ModelError on impossible data or options
std::string draw_vehicle(const RailVehicle& vehicle, const DrawingOptions& options = {});

/// Writes the drawing to a file `*.svg`. @throws InputError if it cannot be written
void write_vehicle_drawing(const std::filesystem::path& path, const RailVehicle& vehicle,
                           const DrawingOptions& options = {});

}  // namespace easydyn::vehicles

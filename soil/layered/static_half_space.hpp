#pragma once

#include "soil/layered/wavenumber_response.hpp"

namespace easydyn::soil {

/// Displacement under a unit point load at the origin of the surface of a homogeneous static half-space, times
/// its shear modulus [1/m], at the distance r and the depth z; z and vertical loads downward:
///
///   vertical load:        u_z = zz,  u_r = xz
///   load along x:         u_x = sum - difference cos 2 theta,  u_y = -difference sin 2 theta,  u_z = -zx cos theta
///
/// Reference: J. Boussinesq (1885) and V. Cerruti (1882), from the transforms of compute_static_compliance().
struct StaticPointResponse {
  double zz = 0, xz = 0, sum = 0, difference = 0, zx = 0;
};
StaticPointResponse compute_static_point_response(double nu, double r, double z);

/// The transform of the same, times the shear modulus [m]: what WavenumberResponse gives for ks2 = 0.
/// @param k  wavenumber [1/m], > 0
struct StaticCompliance {
  double xx = 0, xz = 0, zx = 0, zz = 0, yy = 0;
};
StaticCompliance compute_static_compliance(double nu, double k, double z);

/// Displacement of the surface at (x, y) from the centre of a rectangle under a unit load, uniformly spread, times
/// the shear modulus [1/m]; closed forms (A. E. H. Love, Phil. Trans. A 228, 1929, for the vertical load).
struct StaticRectangleResponse {
  double zz = 0, xz = 0, yz = 0;  ///< vertical load, downward: u_z, u_x, u_y
  double xx = 0, yx = 0, zx = 0;  ///< load along x: u_x, u_y, u_z (downward)
};
StaticRectangleResponse compute_static_rectangle_response(double nu, double length, double width, double x,
                                                          double y);

/// Mean vertical displacement of a rectangle `to` at (x, y) from a rectangle `from` under a unit load, uniformly
/// spread, times the shear modulus [1/m]; closed form.
double compute_static_rectangle_mean(double nu, double from_length, double from_width, double to_length,
                                     double to_width, double x, double y);

}  // namespace easydyn::soil

#pragma once

#include <array>
#include <vector>

#include "soil/absorbing_boundary.hpp"
#include "soil/engine_material.hpp"
#include "soil/lattice.hpp"

namespace easydyn::soil {

/// What absorbs waves at the sides and the bottom.
struct EngineBoundary {
  AbsorbingBoundary absorber = AbsorbingBoundary::sponge;
  /// Damping at the outer edge of a sponge [1/s] = strength x speed / length of the sponge, rising from its inner
  /// edge as the square of the distance: a wave of that speed loses strength / 6 nepers on its way out.
  double sponge_strength = 10;
  double sponge_speed = 0;  ///< [m/s] shear wave speed of the half-space; 0: no sponge
  /// Of a matched layer (matched_layer.hpp): d at its outer edge = strength x speed / length, and alpha [1/s].
  double layer_strength = 5, layer_alpha = 20;
  double layer_speed = 0;  ///< [m/s] c_p of the half-space
  /// The motion at the plane x = 0 of a quarter model, y = 0 of a half model, is antisymmetric: components along
  /// the plane are zero there, else the one across it.
  bool odd_x = false, odd_y = false;
  bool dashpots = true;            ///< viscous dashpots and far-field springs on the outer faces
  std::array<double, 2> origin{};  ///< x, y [m] of the middle of the loads: the springs know their distance
};

/// Damping [1/s] at the nodes of one axis, rising from zero as the square of the distance.
/// @param lines     element boundaries [m]; `interior`: the undamped range of them
/// @param strength  [m/s] damping at the outer edges times the length of what damps
std::vector<double> compute_edge_damping(int degree, const std::vector<double>& lines,
                                         std::array<double, 2> interior, double strength);

/// Sponge of one axis: factors (1 - a) / (1 + a) and 1 / (1 + a) of its nodes, a = damping times dt / 2.
struct SpongeFactors {
  std::vector<double> decay, gain;
};

/// @param lines, interior, strength  see compute_edge_damping()
SpongeFactors compute_sponge(int degree, const std::vector<double>& lines, std::array<double, 2> interior,
                             double strength, double dt);

/// Springs and dashpots of the outer faces, see WaveEngine. Per node along z: integrals over the elements of
/// modulus or impedance times weight; at the bottom: values per area.
struct BoundaryTables {
  BoundaryTables(const Lattice& lattice, const std::vector<EngineMaterial>& materials,
                 const EngineBoundary& boundary);

  std::vector<double> spring_normal_z, spring_shear_z, dash_p_z, dash_s_z;
  double spring_normal_bottom, spring_shear_bottom, dash_p_bottom, dash_s_bottom;
  std::array<double, 2> distance_x, distance_y;  ///< [m] of the outer faces from the loads
};

}  // namespace easydyn::soil

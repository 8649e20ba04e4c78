#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "easydyn/mbs/linear_structure.hpp"

namespace easydyn {

/// A linear-elastic body in its own axes, free in space: what a finite element program knows of it.
///
/// Displacements d are three or six numbers per node: u_x, u_y, u_z [m], then small rotations about x, y, z [rad].
/// Inertia sits in material points P that the nodes carry along: u_P = N d, with masses M between the points' displacements,
/// so that the mass matrix of the displacements is N^T M N.
struct FlexibleModel {
  Eigen::Matrix3Xd nodes;   ///< places of the nodes [m]
  SparseMatrix K;           ///< stiffness of d, symmetric, without force under rigid motion [N/m, N, N m]
  Eigen::Matrix3Xd points;  ///< places of the material points [m]
  SparseMatrix N;           ///< rows: u_x, u_y, u_z of each point (and rotations, see point_rows); columns: d
  SparseMatrix M;           ///< symmetric [kg; kg m, kg m^2 where there are rotations]
  int point_rows = 3;       ///< 3; 6 if the points turn and M knows it

  int node_count() const { return static_cast<int>(nodes.cols()); }
  int node_rows() const { return node_count() ? static_cast<int>(K.rows()) / node_count() : 0; }

  /// @throws ModelError naming `object`: sizes, symmetry, K resists rigid motion, M is not that of a body (its rigid
  ///         translations must weigh the same in all directions)
  void check(const std::string& object) const;

  /// From M and K of another program, 3 or 6 rows per node: the nodes are the material points.
  static FlexibleModel imported(const Eigen::Matrix3Xd& nodes, const SparseMatrix& M, const SparseMatrix& K);
};

/// A straight prismatic beam along x from the origin.
struct BeamData {
  double length = 0;           ///< [m], > 0
  int elements = 10;           ///< of equal length, >= 1
  double mass_per_length = 0;  ///< rho A [kg/m], > 0
  double EA = 0;               ///< axial stiffness [N], > 0
  double EIy = 0, EIz = 0;     ///< bending in the x-z plane and in the x-y plane [N m^2], > 0
  double GJ = 0;               ///< torsion [N m^2], > 0
  double gyration_y = 0;       ///< radius sqrt(I_y / A), about the y axis [m], > 0
  double gyration_z = 0;       ///< radius sqrt(I_z / A), about the z axis [m], > 0

  /// A solid rectangle of width b (along y) and height h (along z); the torsion constant after Roark & Young.
  static BeamData rectangle(double length, int elements, double E, double G, double density, double b,
                            double h);
};

/// Euler-Bernoulli beam elements: cubic bending in both planes, linear tension and torsion. Inertia is integrated
/// exactly (4 Gauss stations per element, 4 points per section): consistent masses with rotary inertia.
/// @throws ModelError naming the value and the range
FlexibleModel beam_model(const BeamData& data);

/// Which displacements a flexible body may take in its floating frame.
struct ShapeOptions {
  std::vector<int> clamped_nodes = {};  ///< that do not move in the floating frame
  std::vector<int> clamped_dofs = {};   ///< more displacements that do not (node * rows per node + row)
  std::vector<int> interface_dofs =
      {};          ///< each gets the static shape of its unit displacement (Craig & Bampton)
  int modes = -1;  ///< eigenmodes with clamped and interface displacements fixed; -1: all
};

/// Shapes as columns: static ones, then modes by rising frequency, each with unit modal mass.
/// Reference: R. R. Craig, M. C. C. Bampton, AIAA J. 6(7), 1968; DOI 10.2514/3.4741.
/// @throws ModelError if an index is out of range, or what is clamped does not hold the body
Eigen::MatrixXd compute_shapes(const FlexibleModel& model, const ShapeOptions& options);

}  // namespace easydyn

#pragma once

#include <array>
#include <functional>
#include <vector>

namespace easydyn::reference {

/// Ground in plane strain, symmetric about y = 0, under a vertical line load on a strip of its top: square bilinear
/// elements (2 x 2 Gauss points, lumped mass), explicit central differences, no absorbing edge: the model must be so
/// large that nothing returns within the time of interest. Cells without material are air, their edges free. It shares
/// nothing with the program but the equations.
///
/// Textbook: K.-J. Bathe, Finite Element Procedures, sections 5.3 and 9.2. Error: dispersion of order (k h)^2 / 24 and,
/// at corners of openings, about h^1.1; measured by halving h.
class PlaneStrainGround {
 public:
  struct Material {
    double density = 0, cs = 0, cp = 0;  ///< [kg/m3], [m/s]; density 0: air
  };

  /// @param h         edge of a cell [m]
  /// @param reach     y [m] of the outer edge, at least
  /// @param depth     [m] below z = 0, at least
  /// @param material  of the cell with this centre, y > 0, z < 0
  PlaneStrainGround(double h, double reach, double depth,
                    const std::function<Material(double y, double z)>& material);

  /// Velocities at a place, one value per output time.
  struct Record {
    std::vector<double> vy, vz;
  };
  /// Motion at places (y, z) on nodes of the mesh under the force per length q(t) [N/m], downward, spread over
  /// |y| < half_width at the height `top`; at the times 0, step, 2 step ... of `count` outputs.
  std::vector<Record> run(const std::function<double(double)>& q, double half_width, double top,
                          const std::vector<std::array<double, 2>>& places, double step, int count);

 private:
  int node(double y, double z) const;

  double h_;
  int ny_, nz_;                  // cells
  std::vector<int> kind_;        // of each cell; -1: air
  std::vector<Material> kinds_;  // of solid cells
  std::vector<double> mass_;     // of each node; 0 in the air
};

}  // namespace easydyn::reference

#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "soil/layered/layered_ground.hpp"

namespace easydyn::soil {

/// Displacement amplitudes of a depth under unit tractions p of one horizontal wavenumber k; x along the wave,
/// z downward, y across:
///
///   p_x sin kx, p_z cos kx   give   u_x = (xx p_x + xz p_z) sin kx,  u_z = (zx p_x + zz p_z) cos kx
///   p_y sin kx               gives  u_y = yy p_y sin kx
struct WavenumberCompliance {
  std::complex<double> xx, xz, zx, zz, yy;  ///< [m/Pa]
};

/// Response of layers to a load on one horizontal plane, wavenumber by wavenumber, at one frequency.
///
/// In a layer, z from its top, two downgoing waves (columns of A) carry the displacement (u_x, u_z):
///
///   S = (b, k) e^(-bz),  D = ((k, a) e^(-az) - S) / ks2,   a = sqrt(k2 - kp2), b = sqrt(k2 - ks2), Re > 0
///
/// S the shear wave, D the divided difference of both waves, which stays a wave of its own where they become the same, ks2 ->
/// 0 (the static limit), and where k -> 0. Upgoing waves are their mirror images, counted from the bottom, so that no
/// exponential grows. With the impedance Z below a layer (force per displacement), its waves reflect as
/// u = R d, R = -(B_u - Z A_u)^-1 (B - Z A), and the impedance above it follows: one 2 x 2 recursion upward from
/// the half-space, sound for thick and thin layers and for any k > 0. Horizontally polarised shear waves are
/// alike, with one wave. Layers that the waves of a wavenumber do not reach (e^-45) are left out.
/// Reference for the setting: E. Kausel, J. M. Roesset, Bull. Seism. Soc. Am. 71(6), 1981.
class WavenumberResponse {
 public:
  /// @param layers           from the surface; the last is the half-space
  /// @param source_depth     [m] >= 0 of the loaded plane
  /// @param receiver_depths  [m] >= 0
  WavenumberResponse(const std::vector<LayerAtFrequency>& layers, double source_depth,
                     const std::vector<double>& receiver_depths);

  /// @param k    wavenumber [1/m], > 0
  /// @param out  one per receiver depth
  void update(double k, WavenumberCompliance* out);

  /// det of the impedance of the surface [Pa2/m2] for loads on the surface: zero at the wavenumber of a
  /// Rayleigh mode (undamped ground), relative to that of the static ground so that it is of order 1.
  std::complex<double> compute_surface_determinant(double k);

  /// The same without poles: the impedance of the surface is infinite at the modes of the ground held at its surface, which lie
  /// between the Rayleigh modes and may come as near to them as one likes. This is the determinant of all waves of all layers
  /// at once, free surface and continuous interfaces (det Z times what the recursion divides by), with the trivial zeros at
  /// a = 0 and b = 0 and the phases of travelling waves taken out: on undamped ground real for k above the wavenumber of the
  /// half-space's shear waves, where it vanishes at the Rayleigh modes and nowhere else.
  std::complex<double> compute_dispersion_function(double k);

 private:
  using Matrix = Eigen::Matrix2cd;

  // A layer of a column, with what one wavenumber makes of it.
  struct Piece {
    LayerAtFrequency material;
    std::complex<double> a, b;
    Matrix A, B;
    Matrix down;       // waves at its start per displacement there
    Matrix reflected;  // upgoing waves at its end per downgoing waves at its start
    Matrix Z_below;    // impedance at its end; unset where the column ends with it
    std::complex<double> down_y, reflected_y;
  };
  // Layers from the loaded plane outward, z positive outward; its end is a half-space or a free surface.
  struct Column {
    std::vector<Piece> pieces;
    bool ends_free = false;
    int active = 0;  // pieces that the waves reach
    Matrix Z;
    std::complex<double> Z_y;

    void update(double k);
    void update_displacement(int place, double depth, const Matrix& at_source,
                             std::complex<double> at_source_y, Matrix& u, std::complex<double>& u_y) const;
  };
  struct Place {
    int side = 0;  // 0 on the loaded plane, 1 below, -1 above
    int piece = 0;
    double depth = 0;  // from the piece's start
  };

  Column below_, above_;
  std::vector<Place> receivers_;
  double first_modulus_ = 0;
};

}  // namespace easydyn::soil

#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "track/irregularity_spectrum.hpp"
#include "track/profile.hpp"
#include "track/taper.hpp"

namespace easydyn::track {

/// Where an irregularity lies and how it is drawn from its spectrum.
struct IrregularityOptions {
  double begin = 0, end = 0;       ///< [m]; flat (r = 0) outside
  double begin_taper = 20;         ///< smooth start: over this length it grows from zero [m], >= 0
  double end_taper = 20;           ///< and over this one it dies out [m], >= 0
  double shortest_wavelength = 0;  ///< [m]; 0: that of the spectrum, else within its band
  double longest_wavelength = 0;   ///< [m]; 0: that of the spectrum, else within its band
  /// Cosines in the band; 0: as many as give dn <= 1 / (2 (end - begin)) and dn <= 1 / (8 longest wavelength).
  /// Given, dn must not exceed 1 / (end - begin).
  int lines = 0;
  std::uint64_t seed = 1;   ///< equal seeds, equal profiles
  int knots_per_wave = 16;  ///< of the table, per shortest wavelength, >= 4
};

/// A random vertical irregularity with a given one-sided spectrum S(n), n = 1 / wavelength:
///
///   r(x) = sum_i sqrt(2 S_i dn) cos(2 pi n_i x + phi_i)       i = 0 .. lines - 1
///   dn = (n_max - n_min) / lines,  n_i = n_min + (i + 1/2) dn
///   S_i dn = integral of S over the cell n_i -+ dn/2, so that the variance sum S_i dn is that of the band exactly
///   phi_i = 2 pi u_i,  u_i = floor(m_i / 2^11) / 2^53,  m_i the numbers of std::mt19937_64(seed)
///
/// The generator and the map to phases are fixed by the C++ standard and by this formula: a seed gives the same
/// profile everywhere (to the rounding of the cosine). The cosines repeat in magnitude after 1/dn, never within
/// the length.
///
/// Speed: r, r' and r'' of the sum, times the taper, are tabulated at knots and joined by quintics, which is twice
/// continuously differentiable. A cosine of wavelength l and knots h apart is met within its amplitude times
/// (2 pi h / l)^6 / 46080: 8e-8 at 16 knots per wave. One evaluation costs as much whatever the number of lines.
///
/// The wheel: taken as the path of the wheel centre itself, as the waves are long against the contact: a rigid
/// wheel of radius R on slopes r' runs higher by R r'^2 / 2, 0.2 um for r' = 1e-3. Wavelengths so short that r''
/// comes near 1/R need the filter of `RolledProfile`.
class Irregularity : public Profile {
 public:
  struct Line {
    double wavenumber;  ///< n_i [1/m]
    double amplitude;   ///< sqrt(2 S_i dn) [m]
    double phase;       ///< phi_i [rad]
  };

  /// @throws ModelError naming the option, its value and the range
  Irregularity(const IrregularitySpectrum& spectrum, const IrregularityOptions& options);

  ProfilePoint at(double x, double wheel_radius) const override;

  const std::vector<Line>& lines() const { return lines_; }
  double line_spacing() const { return dn_; }  ///< dn [1/m]
  double knot_spacing() const { return h_; }   ///< of the table [m]
  const Taper& taper() const { return taper_; }

 private:
  Taper taper_;
  double dn_ = 0, h_ = 0;
  std::vector<Line> lines_;
  std::vector<std::array<double, 6>> cells_;  // coefficients of r(t), t = 0 .. 1 in each cell
};

}  // namespace easydyn::track

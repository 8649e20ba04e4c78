#pragma once

#include <functional>
#include <string>
#include <vector>

#include "easydyn/parameter.hpp"

namespace easydyn::track {

/// What a spectral density is taken per.
enum class SpectralVariable {
  radian_per_metre,  ///< circular wavenumber W = 2 pi / wavelength [rad/m], S(W) in m^2/(rad/m)
  cycle_per_metre,   ///< wavenumber n = 1 / wavelength [1/m], S(n) in m^2/(1/m) = m^3
};

/// One-sided power spectral density of the vertical irregularity of a track, within a band of wavelengths.
///
///   variance = integral of S(n) dn from n = 1/longest to 1/shortest wavelength = integral of S(W) dW
///   S(n) = 2 pi S(W)        W = 2 pi n
///
/// Tools and sources disagree by factors of 2 (sidedness) and 2 pi (variable); here both are said.
class IrregularitySpectrum {
 public:
  /// @param name                 for messages
  /// @param density              one-sided, > 0 over the band [m^2/(rad/m)] or [m^3], after `variable`
  /// @param shortest_wavelength  [m], > 0
  /// @param longest_wavelength   [m], > shortest
  /// @param source               provenance of formula and band
  /// @param coefficients         for tables of parameters
  /// @throws ModelError naming the spectrum, the value and the range
  IrregularitySpectrum(std::string name, SpectralVariable variable, std::function<double(double)> density,
                       double shortest_wavelength, double longest_wavelength,
                       std::string source = "set by the user", std::vector<Parameter> coefficients = {});

  /// S(n), n = 1 / wavelength [m^3]; the formula, whatever the band. @throws ModelError unless n > 0 and S(n) >= 0
  double per_cycle(double n) const;
  /// S(W), W = 2 pi / wavelength [m^2/(rad/m)].
  double per_radian(double W) const;
  /// Integral of S over the band, or over a part of it [m^2]; relative error below 1e-10 for the spectra below.
  double variance() const { return variance(shortest_, longest_); }
  double variance(double shortest_wavelength, double longest_wavelength) const;

  /// The same formula in another band of wavelengths [m], e.g. beyond the one that the source states.
  IrregularitySpectrum with_band(double shortest_wavelength, double longest_wavelength) const;

  const std::string& name() const { return name_; }
  SpectralVariable variable() const { return variable_; }
  double shortest_wavelength() const { return shortest_; }
  double longest_wavelength() const { return longest_; }
  const std::string& source() const { return source_; }
  const std::vector<Parameter>& coefficients() const { return coefficients_; }

 private:
  std::string name_;
  SpectralVariable variable_;
  std::function<double(double)> density_;
  double shortest_, longest_;
  std::string source_;
  std::vector<Parameter> coefficients_;
};

/// ERRI (ORE) B176, S(W) = A Wc^2 / ((W^2 + Wr^2)(W^2 + Wc^2)) per rad/m, Wc = 0.8246, Wr = 0.0206 rad/m.
/// Low level A = 4.032e-7 m rad (F: TTB-2D), high level 1.08e-6 m rad (C: reproduces the GENSYS table). Read as
/// one-sided: the sources leave that open. Band 3-150 m: assumed, the ranges D1 to D3 of EN 13848-1 (M-m).
IrregularitySpectrum erri_b176_low();
IrregularitySpectrum erri_b176_high();

/// FRA, S(W) = k Av Wc^2 / (W^2 (W^2 + Wc^2)) per rad/m, k = 0.25, Wc = 0.8245 rad/m, Av = 1.2107 (class 1),
/// 1.0181, 0.6816, 0.5376, 0.2095, 0.0339 (class 6) cm^2 rad/m, band 1.5-300 m (F: TTB-2D, STEM). Read as
/// one-sided:
/// the sources leave that open.
/// @param track_class  1 (worst) to 6 (best)
/// @throws ModelError on another class
IrregularitySpectrum fra_class(int track_class);

/// SNCF, S(n) = A / (1 + n/n0)^3 per cycle/m, n0 = 0.0489 1/m, A = 308e-6 m^3 times 0.509 (good) or 1.790
/// (poor), band 2-40 m (F: TTB-2D).
IrregularitySpectrum sncf_good();
IrregularitySpectrum sncf_poor();

/// Braun & Hellenbroich, S(W) = S0 (W/W0)^-3.5 per rad/m, W0 = 1 rad/m, S0 = 1e-8 m^3 (M-h). Band 0.5-150 m:
/// assumed, as for ERRI B176; the formula has no bound at long waves.
IrregularitySpectrum braun_hellenbroich();

/// A bundled spectrum by name: erri_low, erri_high, fra_1 ... fra_6, sncf_good, sncf_poor, braun_hellenbroich.
/// @throws ModelError that lists the names
IrregularitySpectrum irregularity_spectrum(const std::string& name);
/// Those names.
const std::vector<std::string>& irregularity_spectrum_names();

}  // namespace easydyn::track

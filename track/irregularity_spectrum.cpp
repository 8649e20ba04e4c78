#include "track/irregularity_spectrum.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "easydyn/require.hpp"
#include "track/gauss_quadrature.hpp"

namespace easydyn::track {

namespace {

constexpr double two_pi = 2 * std::numbers::pi;
const char* const assumed_band = "; band 3-150 m assumed: D1 to D3 of EN 13848-1 (M-m)";

IrregularitySpectrum erri_b176(const std::string& level, double A, const std::string& source) {
  constexpr double Wc = 0.8246, Wr = 0.0206;
  const std::string name = "ERRI B176 " + level;
  return {name,
          SpectralVariable::radian_per_metre,
          [A](double W) { return A * Wc * Wc / ((W * W + Wr * Wr) * (W * W + Wc * Wc)); },
          3,
          150,
          source + "; read as one-sided, which the source leaves open" + assumed_band,
          {{name, "A", A, "m rad", source},
           {name, "Wc", Wc, "rad/m", "F: TTB-2D"},
           {name, "Wr", Wr, "rad/m", "F: TTB-2D"}}};
}

IrregularitySpectrum sncf(const std::string& state, double factor) {
  constexpr double n0 = 0.0489;
  const double A = 308e-6 * factor;
  const std::string name = "SNCF " + state;
  return {name,
          SpectralVariable::cycle_per_metre,
          [A](double n) { return A / std::pow(1 + n / n0, 3); },
          2,
          40,
          "F: TTB-2D",
          {{name, "A", A, "m^3", "F: TTB-2D"}, {name, "n0", n0, "1/m", "F: TTB-2D"}}};
}

}  // namespace

IrregularitySpectrum::IrregularitySpectrum(std::string name, SpectralVariable variable,
                                           std::function<double(double)> density, double shortest_wavelength,
                                           double longest_wavelength, std::string source,
                                           std::vector<Parameter> coefficients)
    : name_(std::move(name)),
      variable_(variable),
      density_(std::move(density)),
      shortest_(shortest_wavelength),
      longest_(longest_wavelength),
      source_(std::move(source)),
      coefficients_(std::move(coefficients)) {
  const std::string object = "spectrum \"" + name_ + "\"";
  if (!density_) throw ModelError(object + ": there is no density");
  require_positive(object, "shortest wavelength", shortest_, "m");
  require(longest_ > shortest_, object, "longest wavelength", longest_, "m",
          fmt::format("> {:g} m, the shortest", shortest_));
}

double IrregularitySpectrum::per_cycle(double n) const {
  require_positive("spectrum \"" + name_ + "\"", "wavenumber", n, "1/m");
  const double S =
      variable_ == SpectralVariable::cycle_per_metre ? density_(n) : two_pi * density_(two_pi * n);
  if (!(S >= 0 && std::isfinite(S)))
    require(false, "spectrum \"" + name_ + "\"", fmt::format("density at the wavelength {:g} m", 1 / n), S,
            "m^3", ">= 0");
  return S;
}

double IrregularitySpectrum::per_radian(double W) const {
  return per_cycle(W / two_pi) / two_pi;
}

double IrregularitySpectrum::variance(double shortest_wavelength, double longest_wavelength) const {
  require_positive("spectrum \"" + name_ + "\"", "shortest wavelength", shortest_wavelength, "m");
  require(longest_wavelength > shortest_wavelength, "spectrum \"" + name_ + "\"", "longest wavelength",
          longest_wavelength, "m", fmt::format("> {:g} m, the shortest", shortest_wavelength));
  // over ln n: spectra are powers of n over much of their band
  const double low = -std::log(longest_wavelength), high = -std::log(shortest_wavelength);
  constexpr int parts = 64;
  double sum = 0;
  for (int k = 0; k < parts; ++k)
    sum +=
        integrate_gauss(low + (high - low) * k / parts, low + (high - low) * (k + 1) / parts, [&](double u) {
          const double n = std::exp(u);
          return n * per_cycle(n);
        });
  return sum;
}

IrregularitySpectrum IrregularitySpectrum::with_band(double shortest_wavelength,
                                                     double longest_wavelength) const {
  return {name_,
          variable_,
          density_,
          shortest_wavelength,
          longest_wavelength,
          source_ + "; band set by the user",
          coefficients_};
}

IrregularitySpectrum erri_b176_low() {
  return erri_b176("low", 4.032e-7, "F: TTB-2D");
}

IrregularitySpectrum erri_b176_high() {
  return erri_b176("high", 1.08e-6, "C: reproduces the GENSYS table");
}

IrregularitySpectrum fra_class(int track_class) {
  require(track_class >= 1 && track_class <= 6, "FRA spectrum", "track class", track_class, "", "1 to 6");
  constexpr std::array Av_cm2 = {1.2107, 1.0181, 0.6816, 0.5376, 0.2095, 0.0339};
  constexpr double k = 0.25, Wc = 0.8245;
  const double Av = Av_cm2[static_cast<std::size_t>(track_class - 1)] * 1e-4;
  const std::string name = fmt::format("FRA class {}", track_class), source = "F: TTB-2D, STEM";
  return {name,
          SpectralVariable::radian_per_metre,
          [Av](double W) { return k * Av * Wc * Wc / (W * W * (W * W + Wc * Wc)); },
          1.5,
          300,
          source + "; read as one-sided, which the sources leave open",
          {{name, "k", k, "1", source},
           {name, "Av", Av, "m^2 rad/m", source},
           {name, "Wc", Wc, "rad/m", source}}};
}

IrregularitySpectrum sncf_good() {
  return sncf("good", 0.509);
}

IrregularitySpectrum sncf_poor() {
  return sncf("poor", 1.790);
}

IrregularitySpectrum braun_hellenbroich() {
  constexpr double W0 = 1, S0 = 1e-8;
  const std::string name = "Braun & Hellenbroich";
  return {name,
          SpectralVariable::radian_per_metre,
          [](double W) { return S0 * std::pow(W / W0, -3.5); },
          0.5,
          150,
          "M-h; band 0.5-150 m assumed, so that a high-speed train feels it up to 150 Hz",
          {{name, "S0", S0, "m^3", "M-h"}, {name, "W0", W0, "rad/m", "M-h"}}};
}

const std::vector<std::string>& irregularity_spectrum_names() {
  static const std::vector<std::string> names = {
      "erri_low",  "erri_high",         "fra_1", "fra_2", "fra_3", "fra_4", "fra_5", "fra_6", "sncf_good",
      "sncf_poor", "braun_hellenbroich"};
  return names;
}

IrregularitySpectrum irregularity_spectrum(const std::string& name) {
  if (name == "erri_low") return erri_b176_low();
  if (name == "erri_high") return erri_b176_high();
  for (int c = 1; c <= 6; ++c)
    if (name == fmt::format("fra_{}", c)) return fra_class(c);
  if (name == "sncf_good") return sncf_good();
  if (name == "sncf_poor") return sncf_poor();
  if (name == "braun_hellenbroich") return braun_hellenbroich();
  std::string known;
  for (const std::string& other : irregularity_spectrum_names()) known += (known.empty() ? "" : ", ") + other;
  throw ModelError(fmt::format("irregularity: there is no spectrum \"{}\"; known are {}", name, known));
}

}  // namespace easydyn::track

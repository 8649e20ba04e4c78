#include "track/irregularity.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "easydyn/error.hpp"

namespace {

using namespace easydyn::track;
using easydyn::ModelError;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double pi = std::numbers::pi;

// The sum of cosines itself, without table and taper.
ProfilePoint sum_of_cosines(const Irregularity& irregularity, double x) {
  ProfilePoint sum;
  for (const auto& line : irregularity.lines()) {
    const double k = 2 * pi * line.wavenumber, angle = k * x + line.phase;
    sum.r += line.amplitude * std::cos(angle);
    sum.dr -= line.amplitude * k * std::sin(angle);
    sum.ddr -= line.amplitude * k * k * std::cos(angle);
  }
  return sum;
}

// Integrals of the formulas by hand, W from 2 pi / longest to 2 pi / shortest; 1e-10: the quadrature's own claim.
TEST(IrregularitySpectrum, HasTheVarianceOfItsFormula) {
  const auto from = [](const IrregularitySpectrum& s) { return 2 * pi / s.longest_wavelength(); };
  const auto to = [](const IrregularitySpectrum& s) { return 2 * pi / s.shortest_wavelength(); };

  const auto erri = [](double A, double W) {
    const double c = 0.8246, r = 0.0206;
    return A * c * c / (c * c - r * r) * (std::atan(W / r) / r - std::atan(W / c) / c);
  };
  const auto low = erri_b176_low(), high = erri_b176_high();
  EXPECT_NEAR(low.variance() / (erri(4.032e-7, to(low)) - erri(4.032e-7, from(low))), 1, 1e-10);
  EXPECT_NEAR(high.variance() / (erri(1.08e-6, to(high)) - erri(1.08e-6, from(high))), 1, 1e-10);

  const double Av[] = {1.2107e-4, 1.0181e-4, 0.6816e-4, 0.5376e-4, 0.2095e-4, 0.0339e-4};
  const auto fra = [](double W) { return -1 / W - std::atan(W / 0.8245) / 0.8245; };
  for (int c = 1; c <= 6; ++c) {
    const auto s = fra_class(c);
    EXPECT_NEAR(s.variance() / (0.25 * Av[c - 1] * (fra(to(s)) - fra(from(s)))), 1, 1e-10) << c;
  }

  // of S(n) = A / (1 + n/n0)^3, n from 1/40 to 1/2
  const auto sncf = [](double n) { return -0.0489 / 2 / std::pow(1 + n / 0.0489, 2); };
  EXPECT_NEAR(sncf_good().variance() / (308e-6 * 0.509 * (sncf(0.5) - sncf(0.025))), 1, 1e-10);
  EXPECT_NEAR(sncf_poor().variance() / (308e-6 * 1.790 * (sncf(0.5) - sncf(0.025))), 1, 1e-10);

  const auto braun = braun_hellenbroich();
  EXPECT_NEAR(braun.variance() / (1e-8 / 2.5 * (std::pow(from(braun), -2.5) - std::pow(to(braun), -2.5))), 1,
              1e-10);
}

TEST(IrregularitySpectrum, IsTheSamePerRadianAndPerCycle) {
  // S(n) dn = S(W) dW with W = 2 pi n
  const auto A = erri_b176_low();
  for (const double n : {0.01, 0.1, 0.3}) {
    EXPECT_NEAR(A.per_cycle(n) / (2 * pi * A.per_radian(2 * pi * n)), 1, 1e-14);
    EXPECT_NEAR(sncf_good().per_cycle(n) / (2 * pi * sncf_good().per_radian(2 * pi * n)), 1, 1e-14);
  }
  // S(W) by hand at W = Wc: A / 2 / (Wc^2 + Wr^2), at n = n0: A / 8; to the rounding of the wavenumber
  EXPECT_NEAR(A.per_radian(0.8246) / (4.032e-7 / 2 / (0.8246 * 0.8246 + 0.0206 * 0.0206)), 1, 1e-14);
  EXPECT_NEAR(sncf_good().per_cycle(0.0489) / (308e-6 * 0.509 / 8), 1, 1e-14);
  // one spectrum written in both ways gives one profile
  const IrregularitySpectrum radian(
      "r", SpectralVariable::radian_per_metre, [](double W) { return 1e-8 / (W * W); }, 1, 20),
      cycle(
          "c", SpectralVariable::cycle_per_metre, [](double n) { return 1e-8 / (2 * pi * n * n); }, 1, 20);
  const IrregularityOptions options{.begin = 0, .end = 100};
  const Irregularity a(radian, options), b(cycle, options);
  for (const double x : {25.0, 50.3, 71.7}) EXPECT_NEAR(a.at(x, 0.4).r, b.at(x, 0.4).r, 1e-15);
}

TEST(IrregularitySpectrum, KeepsItsNormalisationBandAndProvenance) {
  for (const std::string& name : irregularity_spectrum_names()) {
    const auto s = irregularity_spectrum(name);
    EXPECT_EQ(s.variable(), name.starts_with("sncf") ? SpectralVariable::cycle_per_metre
                                                     : SpectralVariable::radian_per_metre);
    EXPECT_LT(s.shortest_wavelength(), s.longest_wavelength());
    EXPECT_FALSE(s.coefficients().empty());
    EXPECT_THAT(s.source(), testing::AnyOf(HasSubstr("F: "), HasSubstr("C: "), HasSubstr("M-h")));
    for (const auto& c : s.coefficients()) EXPECT_FALSE(c.source.empty());
  }
  EXPECT_THAT([] { irregularity_spectrum("fra_7"); },
              ThrowsMessage<ModelError>(HasSubstr("fra_6, sncf_good")));
  EXPECT_THAT([] { fra_class(0); }, ThrowsMessage<ModelError>(HasSubstr("track class = 0, must be 1 to 6")));
}

TEST(IrregularitySpectrum, RefusesAnImpossibleOne) {
  const auto flat = [](double) { return 1e-8; };
  using S = IrregularitySpectrum;
  EXPECT_THROW(S("s", SpectralVariable::cycle_per_metre, nullptr, 1, 2), ModelError);
  EXPECT_THROW(S("s", SpectralVariable::cycle_per_metre, flat, 0, 2), ModelError);
  EXPECT_THROW(S("s", SpectralVariable::cycle_per_metre, flat, 2, 2), ModelError);
  EXPECT_THROW(S("s", SpectralVariable::cycle_per_metre, flat, 1, std::nan("")), ModelError);
  const S negative(
      "s", SpectralVariable::cycle_per_metre, [](double) { return -1.0; }, 1, 2);
  EXPECT_THAT([&] { negative.variance(); }, ThrowsMessage<ModelError>(HasSubstr("must be >= 0")));
}

// Over the length 1/dn all cosines are orthogonal if 2 n_min / dn is a whole number: then the sample variance is
// the integral of S to rounding, whatever the seed. ERRI, 3-150 m: n_min = 1/150, n_max = 1/3, dn = 1/3000, 980
// lines.
TEST(Irregularity, HasTheVarianceOfItsBand) {
  const auto spectrum = erri_b176_low();
  const Irregularity r(spectrum, {.begin = 0, .end = 3000, .begin_taper = 0, .end_taper = 0, .lines = 980});
  ASSERT_NEAR(r.line_spacing(), 1.0 / 3000, 1e-15);
  double sum = 0;
  for (const auto& line : r.lines()) sum += line.amplitude * line.amplitude / 2;
  EXPECT_NEAR(sum / spectrum.variance(), 1, 1e-9);
  // the mean square over equidistant samples finer than half of the shortest wave is that over the length
  const int samples = 3000;
  double square = 0;
  for (int i = 0; i < samples; ++i) {
    const double value = r.at(3000.0 * i / samples, 0.4).r;
    square += value * value / samples;
  }
  // 1e-6: the table meets short waves within 8e-8 of their amplitude
  EXPECT_NEAR(square / spectrum.variance(), 1, 1e-6);
}

// Welch's estimate: Hann windows of 500 m overlapping by half. Averaged over a band of width dn along the length
// L it has the relative standard deviation 1 / sqrt(L dn) (chi-square with 2 L dn degrees of freedom); the
// tolerance is 3 of these, and 1 % for the leakage of the window, S'' (0.4 / 500 m)^2 / 2 / S with S ~ n^-4 at n
// = 0.04 1/m.
TEST(Irregularity, HasTheSpectrumThatItIsDrawnFrom) {
  const double length = 8000, dx = 0.5, segment = 500;
  for (const auto& spectrum : {erri_b176_low(), sncf_good().with_band(3, 150)}) {
    const Irregularity profile(spectrum, {.begin = 0,
                                          .end = length,
                                          .begin_taper = 0,
                                          .end_taper = 0,
                                          .shortest_wavelength = 3,
                                          .longest_wavelength = 150,
                                          .seed = 3});
    const int m = static_cast<int>(segment / dx), segments = static_cast<int>(2 * length / segment) - 1;
    std::vector<double> density(161, 0);  // at n = k / segment, one-sided
    for (int s = 0; s < segments; ++s) {
      std::vector<double> w(static_cast<std::size_t>(m));
      for (int i = 0; i < m; ++i)
        w[static_cast<std::size_t>(i)] =
            (1 - std::cos(2 * pi * i / m)) / 2 * profile.at(s * segment / 2 + i * dx, 0.4).r;
      for (int k = 20; k <= 160; ++k) {
        double re = 0, im = 0;
        const double c1 = std::cos(2 * pi * k / m), s1 = std::sin(2 * pi * k / m);
        double c = 1, sn = 0;
        for (const double v : w) {
          re += v * c;
          im += v * sn;
          const double next = c * c1 - sn * s1;
          sn = sn * c1 + c * s1;
          c = next;
        }
        // 2 dx |W|^2 / sum(window^2), sum(window^2) = 3/8 m
        density[static_cast<std::size_t>(k)] += 2 * dx * (re * re + im * im) / (0.375 * m) / segments;
      }
    }
    for (const auto& [low, high] : {std::pair{20, 40}, {40, 80}, {80, 160}}) {
      double estimate = 0;  // trapezoidal over the band
      for (int k = low; k <= high; ++k)
        estimate += density[static_cast<std::size_t>(k)] * (k == low || k == high ? 0.5 : 1.0) / segment;
      const double exact = spectrum.variance(segment / high, segment / low);
      EXPECT_NEAR(estimate / exact, 1, 3 / std::sqrt(length * (high - low) / segment) + 0.01)
          << spectrum.name() << " " << low / segment;
    }
  }
}

TEST(Irregularity, IsTheSameToTheDigitForASeedAndAnotherForAnother) {
  IrregularityOptions options{.begin = -50, .end = 250, .seed = 11};
  const Irregularity a(erri_b176_low(), options), b(erri_b176_low(), options);
  options.seed = 12;
  const Irregularity other(erri_b176_low(), options);
  for (const double x : {-20.0, 0.123, 77.7, 200.0}) {
    EXPECT_EQ(a.at(x, 0.4).r, b.at(x, 0.4).r);
    EXPECT_EQ(a.at(x, 0.4).ddr, b.at(x, 0.4).ddr);
    EXPECT_NE(a.at(x, 0.4).r, other.at(x, 0.4).r);
  }
  // the generator that the C++ standard fixes ([rand.predef]: its 10000th number from the default seed)
  std::mt19937_64 standard;
  standard.discard(9999);
  EXPECT_EQ(standard(), 9981545732273789042u);
  std::mt19937_64 random(11);
  for (int i = 0; i < 3; ++i) {
    const double u = static_cast<double>(random() / 2048) / 9007199254740992.0;  // 2^53
    EXPECT_EQ(a.lines()[static_cast<std::size_t>(i)].phase, 2 * pi * u);
  }
}

TEST(Irregularity, MeetsTheSumOfCosinesByItsTable) {
  for (const int knots : {8, 16}) {
    const Irregularity r(sncf_poor(), {.begin = 0, .end = 200, .seed = 5, .knots_per_wave = knots});
    // error of a quintic through r, r', r'': h^6 max|r^(6)| / 46080, for each cosine
    double bound = 0;
    for (const auto& line : r.lines())
      bound += line.amplitude * std::pow(2 * pi * line.wavenumber * r.knot_spacing(), 6) / 46080;
    double worst = 0, worst_slope = 0, worst_curvature = 0, slope = 0, curvature = 0;
    for (double x = 20; x < 180; x += 0.0317) {
      const ProfilePoint exact = sum_of_cosines(r, x), p = r.at(x, 0.4);
      worst = std::max(worst, std::abs(p.r - exact.r));
      worst_slope = std::max(worst_slope, std::abs(p.dr - exact.dr));
      worst_curvature = std::max(worst_curvature, std::abs(p.ddr - exact.ddr));
      slope = std::max(slope, std::abs(exact.dr));
      curvature = std::max(curvature, std::abs(exact.ddr));
    }
    EXPECT_LT(worst, bound + 1e-14);
    if (knots == 16) {
      EXPECT_LT(bound, 1e-9);
      EXPECT_LT(worst_slope, 1e-6 * slope);
      EXPECT_LT(worst_curvature, 1e-4 * curvature);
    }
    RecordProperty("worst", std::to_string(worst));
  }
}

TEST(Irregularity, IsTwiceContinuouslyDifferentiableAndStartsAndEndsFlat) {
  const Irregularity r(erri_b176_high(),
                       {.begin = 10, .end = 110, .begin_taper = 20, .end_taper = 30, .seed = 2});
  const double h = r.knot_spacing(), e = 1e-9;
  double curvature = 0;
  for (int i = 0; i <= 500; ++i) {
    const double x = 10 + i * h;
    const ProfilePoint before = r.at(x - e, 0.4), behind = r.at(x + e, 0.4);
    curvature = std::max(curvature, std::abs(behind.ddr));
    EXPECT_NEAR(before.r, behind.r, 1e-10);  // 2 e r', r' < 0.01
    EXPECT_NEAR(before.dr, behind.dr, 1e-10);
    EXPECT_NEAR(before.ddr, behind.ddr, 1e-9);
  }
  EXPECT_GT(curvature, 1e-4);
  for (const double x : {-100.0, 10 - e, 10 + e, 110 - e, 110 + e, 500.0}) {
    EXPECT_NEAR(r.at(x, 0.4).r, 0, 1e-15);
    EXPECT_NEAR(r.at(x, 0.4).dr, 0, 1e-12);
    EXPECT_NEAR(r.at(x, 0.4).ddr, 0, 1e-9);
  }
  // half-way up the taper the factor is 1/2, behind it 1; 1e-9: the table
  EXPECT_NEAR(r.at(20, 0.4).r, sum_of_cosines(r, 20).r / 2, 1e-9);
  EXPECT_NEAR(r.at(50, 0.4).r, sum_of_cosines(r, 50).r, 1e-9);
  EXPECT_NEAR(r.at(95, 0.4).r, sum_of_cosines(r, 95).r / 2, 1e-9);
}

TEST(Irregularity, RefusesImpossibleOptions) {
  const auto with = [](IrregularityOptions options) { return Irregularity(sncf_good(), options); };
  EXPECT_THAT([&] { with({.begin = 0, .end = 0}); },
              ThrowsMessage<ModelError>(HasSubstr("end = 0 m, must be > begin")));
  EXPECT_THAT(
      [&] { with({.begin = 0, .end = 30}); },
      ThrowsMessage<ModelError>(HasSubstr("begin_taper + end_taper = 40 m, must be <= end - begin = 30 m")));
  EXPECT_THAT([&] { with({.begin = 0, .end = 100, .shortest_wavelength = 1}); },
              ThrowsMessage<ModelError>(HasSubstr("within the band of the spectrum, 2 m to 40 m")));
  EXPECT_THROW(with({.begin = 0, .end = 100, .longest_wavelength = 50}), ModelError);
  EXPECT_THROW(with({.begin = 0, .end = 100, .shortest_wavelength = 10, .longest_wavelength = 10}),
               ModelError);
  // (1/2 - 1/40) 100 = 47.5 cells of 1 / 100 m
  EXPECT_THAT([&] { with({.begin = 0, .end = 100, .lines = 47}); },
              ThrowsMessage<ModelError>(HasSubstr("lines = 47, must be >= 48")));
  EXPECT_THROW(with({.begin = 0, .end = 100, .lines = -1}), ModelError);
  EXPECT_THROW(with({.begin = 0, .end = 100, .knots_per_wave = 3}), ModelError);
  EXPECT_THROW(with({.begin = std::nan(""), .end = 100}), ModelError);
  EXPECT_THROW(with({.begin = 0, .end = std::numeric_limits<double>::infinity()}), ModelError);
}

}  // namespace

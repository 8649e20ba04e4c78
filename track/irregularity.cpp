#include "track/irregularity.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "easydyn/require.hpp"
#include "track/gauss_quadrature.hpp"

namespace easydyn::track {

namespace {

constexpr double two_pi = 2 * std::numbers::pi;

// Quintic of t = 0 .. 1 through values, slopes and curvatures at both ends of a cell of length h.
std::array<double, 6> quintic(const ProfilePoint& a, const ProfilePoint& b, double h) {
  const double d0 = h * a.dr, d1 = h * b.dr, s0 = h * h * a.ddr, s1 = h * h * b.ddr;
  const double value = b.r - a.r - d0 - s0 / 2, slope = d1 - d0 - s0, curvature = s1 - s0;
  return {a.r,
          d0,
          s0 / 2,
          10 * value - 4 * slope + curvature / 2,
          -15 * value + 7 * slope - curvature,
          6 * value - 3 * slope + curvature / 2};
}

// Adds a cosine at equidistant knots; rotates a phasor, set right every 64 knots so that rounding does not grow.
void add_line(const Irregularity::Line& line, double begin, double h, std::vector<ProfilePoint>& knots) {
  const double k = two_pi * line.wavenumber, c1 = std::cos(k * h), s1 = std::sin(k * h);
  double c = 0, s = 0;
  for (std::size_t i = 0; i < knots.size(); ++i) {
    if (i % 64 == 0) {
      const double angle = k * (begin + static_cast<double>(i) * h) + line.phase;
      c = line.amplitude * std::cos(angle);
      s = line.amplitude * std::sin(angle);
    }
    knots[i].r += c;
    knots[i].dr -= k * s;
    knots[i].ddr -= k * k * c;
    const double next = c * c1 - s * s1;
    s = s * c1 + c * s1;
    c = next;
  }
}

}  // namespace

Irregularity::Irregularity(const IrregularitySpectrum& spectrum, const IrregularityOptions& options)
    : taper_{options.begin, options.end, options.begin_taper, options.end_taper} {
  const std::string object = "irregularity \"" + spectrum.name() + "\"";
  const double shortest = options.shortest_wavelength == 0 ? spectrum.shortest_wavelength()
                                                           : options.shortest_wavelength,
               longest = options.longest_wavelength == 0 ? spectrum.longest_wavelength()
                                                         : options.longest_wavelength;
  const std::string band = fmt::format("within the band of the spectrum, {:g} m to {:g} m",
                                       spectrum.shortest_wavelength(), spectrum.longest_wavelength());
  require(shortest >= spectrum.shortest_wavelength() && shortest < spectrum.longest_wavelength(), object,
          "shortest wavelength", shortest, "m", band);
  require(longest <= spectrum.longest_wavelength() && longest > shortest, object, "longest wavelength",
          longest, "m", band + " and above the shortest");
  require_finite(object, "begin", options.begin, "m");
  require(options.end > options.begin, object, "end", options.end, "m",
          fmt::format("> begin = {:g} m", options.begin));
  const double length = options.end - options.begin;
  require_not_negative(object, "begin_taper", options.begin_taper, "m");
  require_not_negative(object, "end_taper", options.end_taper, "m");
  require(options.begin_taper + options.end_taper <= length, object, "begin_taper + end_taper",
          options.begin_taper + options.end_taper, "m", fmt::format("<= end - begin = {:g} m", length));
  require(options.knots_per_wave >= 4, object, "knots per wave", options.knots_per_wave, "", ">= 4");

  const double n_min = 1 / longest, n_max = 1 / shortest;
  const double fewest = (n_max - n_min) * length;
  const double advised = std::ceil((n_max - n_min) * std::max(2 * length, 8 * longest));
  const double lines = options.lines == 0 ? advised : options.lines;
  require(lines >= fewest * (1 - 1e-12) && lines >= 1, object, "lines", lines, "",
          fmt::format(">= {:.0f}, that it may not repeat within {:g} m", std::max(1.0, std::ceil(fewest)),
                      length));
  require(lines * length / shortest * options.knots_per_wave < 1e11, object, "lines", lines, "",
          fmt::format("fewer, for {:g} m with waves down to {:g} m", length, shortest));
  dn_ = (n_max - n_min) / lines;

  std::mt19937_64 random(options.seed);
  lines_.reserve(static_cast<std::size_t>(lines));
  for (int i = 0; i < static_cast<int>(lines); ++i) {
    const double from = n_min + i * dn_;
    const double cell = integrate_gauss(from, from + dn_, [&](double n) { return spectrum.per_cycle(n); });
    const double u = std::ldexp(static_cast<double>(random() >> 11), -53);
    lines_.push_back({from + dn_ / 2, std::sqrt(2 * cell), two_pi * u});
  }

  const auto cells = static_cast<std::size_t>(std::ceil(length * options.knots_per_wave / shortest));
  h_ = length / static_cast<double>(cells);
  std::vector<ProfilePoint> knots(cells + 1);
  for (const Line& line : lines_) add_line(line, options.begin, h_, knots);
  for (std::size_t i = 0; i <= cells; ++i) {
    // the last knot is the end itself, whatever the rounding of h
    const double x = i == cells ? options.end : options.begin + static_cast<double>(i) * h_;
    knots[i] = product(taper_.at(x), knots[i]);
  }
  cells_.reserve(cells);
  for (std::size_t i = 0; i < cells; ++i) cells_.push_back(quintic(knots[i], knots[i + 1], h_));
}

ProfilePoint Irregularity::at(double x, double) const {
  if (!(x >= taper_.begin && x <= taper_.end)) return {};
  const double position = (x - taper_.begin) / h_;
  const std::size_t i = std::min(static_cast<std::size_t>(position), cells_.size() - 1);
  const double t = position - static_cast<double>(i);
  const std::array<double, 6>& c = cells_[i];
  return {c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5])))),
          (c[1] + t * (2 * c[2] + t * (3 * c[3] + t * (4 * c[4] + t * 5 * c[5])))) / h_,
          (2 * c[2] + t * (6 * c[3] + t * (12 * c[4] + t * 20 * c[5]))) / (h_ * h_)};
}

}  // namespace easydyn::track

#include "soil/layered/rayleigh_modes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "easydyn/require.hpp"
#include "soil/layered/wavenumber_response.hpp"

namespace easydyn::soil {
namespace {

constexpr double pi = std::numbers::pi;

// Dispersion function of the elastic ground; real below the half-space's shear wave speed. The determinant of the surface's
// impedance will not do: between two samples its poles hide the roots beside them.
class Secular {
 public:
  Secular(const LayeredGround& ground, double w)
      : layers_(make_elastic(ground, w)), response_(layers_, 0, {}) {}

  double operator()(double k) { return response_.compute_dispersion_function(k).real(); }

  // Wavenumbers of the shear waves.
  double slowest() const {
    return extreme([](double a, double b) { return std::max(a, b); });
  }
  double half_space() const { return std::sqrt(layers_.back().ks2.real()); }
  // Phase that a wave collects in the layers, over 1 / k.
  double depth() const {
    double sum = 0;
    for (std::size_t i = 0; i + 1 < layers_.size(); ++i) sum += layers_[i].thickness;
    return sum;
  }

 private:
  static std::vector<LayerAtFrequency> make_elastic(const LayeredGround& ground, double w) {
    std::vector<LayerAtFrequency> layers = ground.compute_layers(w);
    for (LayerAtFrequency& layer : layers) {
      layer.ks2 = (layer.ks2 * layer.mu).real() / layer.mu.real();
      layer.mu = layer.mu.real();
    }
    return layers;
  }
  template <typename F>
  double extreme(F choose) const {
    double value = std::sqrt(layers_.front().ks2.real());
    for (const LayerAtFrequency& layer : layers_) value = choose(value, std::sqrt(layer.ks2.real()));
    return value;
  }

  std::vector<LayerAtFrequency> layers_;
  WavenumberResponse response_;
};

// Bisection between opposite signs; NaN where the sign changes in a jump: where another layer comes within reach of the
// waves and its factor enters.
double find_root(Secular& D, double a, double b, double at_a, double at_b) {
  const double limit = std::max(std::abs(at_a), std::abs(at_b));
  double value = at_a;
  for (int pass = 0; pass < 200 && b - a > 4e-16 * b; ++pass) {
    const double middle = (a + b) / 2;
    value = D(middle);
    if ((value > 0) == (at_a > 0)) {
      a = middle;
    } else {
      b = middle;
    }
  }
  return std::abs(value) <= 1e-6 * limit ? (a + b) / 2 : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::vector<double> compute_rayleigh_speeds(const LayeredGround& ground, double frequency) {
  require_positive("Rayleigh modes", "frequency", frequency, "Hz");
  const double w = 2 * pi * frequency;
  Secular D(ground, w);
  // From just faster than the half-space's shear waves (no mode) to slower than any Rayleigh wave, c_R > 0.874 c_S.
  const double low = D.half_space() * (1 + 1e-9), high = 1.15 * D.slowest();
  // Modes are about pi / depth apart in the vertical wavenumber: many steps to each.
  const int steps = 200 + static_cast<int>(60 * high * D.depth());
  std::vector<double> speeds;
  double k = high, at_k = D(k);
  for (int i = 1; i <= steps; ++i) {
    // Evenly in the vertical wavenumber of the half-space, which crowds near its shear waves.
    const double share = 1 - static_cast<double>(i) / steps;
    const double next = std::sqrt(low * low + share * share * (high * high - low * low)), at_next = D(next);
    if ((at_k > 0) != (at_next > 0)) {
      const double root = find_root(D, next, k, at_next, at_k);
      if (std::isfinite(root)) speeds.push_back(w / root);
    }
    k = next;
    at_k = at_next;
  }
  return speeds;
}

double find_radiation_frequency(const LayeredGround& ground, double speed, double lowest, double highest) {
  require_positive("Rayleigh modes", "speed", speed, "m/s");
  const auto is_slow = [&](double f) {
    const std::vector<double> speeds = compute_rayleigh_speeds(ground, f);
    return !speeds.empty() && speeds.front() <= speed;
  };
  if (is_slow(lowest)) return lowest;
  constexpr int steps = 100;
  double before = lowest;
  for (int i = 1; i <= steps; ++i) {
    double f = lowest * std::pow(highest / lowest, static_cast<double>(i) / steps);
    if (is_slow(f)) {
      while (f - before > 1e-6 * f) {
        const double middle = (before + f) / 2;
        (is_slow(middle) ? f : before) = middle;
      }
      return f;
    }
    before = f;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

std::optional<ModeCrossing> find_crossing(const LayeredGround& ground, const Eigen::VectorXd& frequency,
                                          const Eigen::VectorXd& speed) {
  const Eigen::Index n = frequency.size();
  const char* const object = "crossing with a Rayleigh mode";
  require(n >= 2, object, "number of samples", static_cast<double>(n), "", ">= 2");
  require(speed.size() == n, object, "number of speeds", static_cast<double>(speed.size()), "",
          fmt::format("{}, one per frequency", n));
  for (Eigen::Index i = 0; i < n; ++i) {
    require(frequency[i] > (i == 0 ? 0 : frequency[i - 1]), object, "frequency", frequency[i], "Hz",
            "> 0 and ascending");
    require_positive(object, "speed", speed[i], "m/s");
  }
  const auto has_caught_up = [&](double f, double c) {
    const std::vector<double> speeds = compute_rayleigh_speeds(ground, f);
    return !speeds.empty() && c >= speeds.front();
  };
  // The mode lies between these: no need to look for it where the wave is slower.
  double slowest = std::numeric_limits<double>::infinity();
  for (const Layer& layer : ground.layers()) slowest = std::min(slowest, layer.cs);
  bool was_behind = false;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (speed[i] < 0.8 * slowest || !has_caught_up(frequency[i], speed[i])) {
      was_behind = true;
      continue;
    }
    if (!was_behind) continue;
    const double slope = std::log(speed[i] / speed[i - 1]) / std::log(frequency[i] / frequency[i - 1]);
    const auto speed_at = [&](double f) { return speed[i] * std::pow(f / frequency[i], slope); };
    double behind = frequency[i - 1], ahead = frequency[i];
    while (ahead - behind > 1e-9 * ahead) {
      const double middle = (behind + ahead) / 2;
      (has_caught_up(middle, speed_at(middle)) ? ahead : behind) = middle;
    }
    return ModeCrossing{ahead, speed_at(ahead)};
  }
  return std::nullopt;
}

}  // namespace easydyn::soil

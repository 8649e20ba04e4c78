#include "track_on_soil/moving_load_response.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <utility>
#include <vector>

#include "easydyn/math/units.hpp"
#include "easydyn/require.hpp"
#include "soil/layered/wavenumber_response.hpp"

namespace easydyn::track_on_soil {
namespace {

using units::pi;
using Complex = std::complex<double>;

// Gauss and Kronrod's rule of 7 and 15 points on -1 ... 1, its nodes >= 0; Piessens et al., QUADPACK, 1983.
struct KronrodNode {
  double x, kronrod, gauss;
};
constexpr std::array<KronrodNode, 8> kronrod_rule = {{
    {0.991455371120812639206854697526329, 0.022935322010529224963732008058970, 0},
    {0.949107912342758524526189684047851, 0.063092092629978553290700663189204,
     0.129484966168869693270611432679082},
    {0.864864423359769072789712788640926, 0.104790010322250183839876322541518, 0},
    {0.741531185599394439863864773280788, 0.140653259715525918745189590510238,
     0.279705391489276667901467771423780},
    {0.586087235467691130294144691693630, 0.169004726639267902826583426598550, 0},
    {0.405845151377397166906606412076961, 0.190350578064785409913256402421014,
     0.381830050505118944950369775488975},
    {0.207784955007898467600689403773245, 0.204432940075298892414161999234649, 0},
    {0, 0.209482141084727828012999174891714, 0.417959183673469387755102040816327},
}};

template <typename F>
Complex integrate(F& f, double a, double b, double tolerance, int depth = 0) {
  const double middle = (a + b) / 2, half = (b - a) / 2;
  Complex kronrod = 0, gauss = 0;
  for (const KronrodNode& node : kronrod_rule) {
    const Complex value = node.x == 0 ? f(middle) : f(middle - half * node.x) + f(middle + half * node.x);
    kronrod += node.kronrod * value;
    gauss += node.gauss * value;
  }
  if (half * std::abs(kronrod - gauss) <= tolerance || depth == 20) return half * kronrod;
  return integrate(f, a, middle, tolerance / 2, depth + 1) +
         integrate(f, middle, b, tolerance / 2, depth + 1);
}

// Ground under a strip of the width B: displacement per force per length [m2/N].
Complex compute_strip_compliance(const soil::LayeredGround& ground, double width, double k, double w) {
  const std::vector<soil::LayerAtFrequency> layers = ground.compute_layers(w);
  soil::WavenumberResponse response(layers, 0, {0});
  const auto integrand = [&](double ky) {
    soil::WavenumberCompliance G;
    response.update(std::hypot(k, ky), &G);
    const double x = ky * width / 2;
    const double share = x < 1e-4 ? 1 : std::sin(x) / x;
    return G.zz * share * share;
  };
  // Waves of the surface lie below 1.2 times the wavenumber of the slowest shear wave; from there to the last lobe.
  double slow = k;
  for (const soil::LayerAtFrequency& layer : layers)
    slow = std::max(slow, 1.2 * std::sqrt(std::abs(layer.ks2)));
  const double lobe = 2 * pi / width, last = lobe * (4 + std::ceil(2 * slow / lobe));
  // What is left beyond: G = (1 - nu) / (mu k_y) of the uppermost layer, the square of the sine at its mean, 1/2.
  const soil::LayerAtFrequency& upper = layers.front();
  const Complex modulus = upper.mu * 2.0 * (1 - upper.speed_ratio2);  // mu / (1 - nu)
  Complex sum = 1.0 / (modulus * std::pow(width * last, 2));
  const double tolerance = 1e-4 / std::abs(modulus);
  double from = 0;
  for (double to = std::min(lobe / 4, slow / 2); from < last; from = to, to = std::min(last, to + lobe))
    sum += integrate(integrand, from, to, tolerance);
  return sum / pi;
}

}  // namespace

Eigen::VectorXd compute_moving_load_response(const track::TrackData& data, const soil::Site& site,
                                             double speed, const Eigen::VectorXd& s) {
  validate(data);
  require_positive("moving load on a track", "speed", speed, "m/s");
  const soil::LayeredGround ground(site, soil::GroundDamping::constant_q);
  const track::BeamProperties rail = rail_beam(data);
  const double L = data.sleeper_spacing;

  // Dynamic stiffness of the rail per length.
  const auto stiffness = [&](double k) {
    const double w = k * speed, k4 = std::pow(k, 4);
    const auto spring = [&](double stiff, double damping) { return Complex(stiff, w * damping) / L; };
    const auto in_series = [](Complex a, Complex b) { return a * b / (a + b); };
    Complex Z = 1.0 / compute_strip_compliance(ground, data.footprint_width, k, w);
    if (const auto& mass = data.ballast_mass) {
      Z = in_series(Z, spring(mass->base_stiffness, mass->base_damping)) - w * w * mass->mass / L +
          spring(mass->shear_stiffness, mass->shear_damping) * (L * L * k * k);
    }
    Z = in_series(Z, spring(data.ballast_stiffness, data.ballast_damping));
    if (const auto& pads = data.under_sleeper_pads) Z = in_series(Z, spring(pads->stiffness, pads->damping));
    Z -= w * w * data.sleeper_mass / L;
    if (data.slab) Z += data.slab->bending_stiffness * k4 - w * w * data.slab->mass_per_length;
    Z = in_series(Z, spring(data.pad_stiffness, data.pad_damping));
    return rail.bending_stiffness * k4 - w * w * rail.mass_per_length + Z;
  };

  // Trapezoidal rule in log k, to ten times the wavenumber of the rail on its pads; there D = E I k^4.
  const double first = std::log(1e-4),
               last = std::log(10 * std::pow(data.pad_stiffness / L / rail.bending_stiffness, 0.25));
  constexpr double step = 0.03;
  Eigen::VectorXd w = Eigen::VectorXd::Zero(s.size());
  for (double log_k = first; log_k < last; log_k += step) {
    const double k = std::exp(log_k);
    const Complex compliance = step * k / stiffness(k);
    for (Eigen::Index i = 0; i < s.size(); ++i) w[i] += (compliance * std::polar(1.0, -k * s[i])).real();
  }
  return w / pi;
}

}  // namespace easydyn::track_on_soil

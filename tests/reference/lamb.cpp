#include "tests/reference/lamb.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

namespace easydyn::reference {

namespace {

/// Integral over [a, b] of a function with at most inverse square-root singularities at the ends: the midpoint
/// rule after s = a + (b - a) sin^2(pi x / 2), whose Jacobian vanishes there, converges fast.
template <class F>
double integrate_between(double a, double b, int points, F f) {
  double sum = 0;
  for (int i = 0; i < points; ++i) {
    const double x = M_PI / 2 * (i + 0.5) / points, s = std::sin(x);
    sum += f(a + (b - a) * s * s) * 2 * s * std::cos(x);
  }
  return sum * (b - a) * M_PI / 2 / points;
}

}  // namespace

Lamb::Lamb(double poisson_ratio) : nu_(poisson_ratio), a2_((1 - 2 * nu_) / (2 - 2 * nu_)) {
  // Rayleigh: D(w) = (1 - 2 w^2)^2 - 4 w^2 sqrt(w^2 - a2) sqrt(w^2 - 1) = 0, w > 1.
  const auto D = [this](double w) {
    return std::pow(1 - 2 * w * w, 2) - 4 * w * w * std::sqrt((w * w - a2_) * (w * w - 1));
  };
  double low = 1, high = 1.3;  // D(1) = 1, D(1.3) < 0 for nu >= 0
  for (int i = 0; i < 200; ++i) (D((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
  w_R_ = (low + high) / 2;
  const double w = w_R_, A = std::sqrt(w * w - a2_), B = std::sqrt(w * w - 1);
  const double slope = -8 * w * (1 - 2 * w * w) - 8 * w * A * B - 4 * w * w * (w * B / A + w * A / B);
  residue_radial_ = (1 - 2 * w * w + 2 * A * B) / slope;
}

double Lamb::vertical(double tau) const {
  // Roots of -16 (1 - a2) x^3 + 8 (3 - 2 a2) x^2 - 8 x + 1 = 0: x3 = w_R^2 and those of a quadratic.
  using Complex = std::complex<double>;
  const double x3 = w_R_ * w_R_, sum = (3 - 2 * a2_) / (2 * (1 - a2_)) - x3,
               product = 1 / (16 * (1 - a2_) * x3);
  const Complex root = std::sqrt(Complex(sum * sum / 4 - product)), x1 = sum / 2 + root, x2 = sum / 2 - root;
  const auto factor = [this](Complex x, Complex other, Complex third, Complex square) {
    return (x - 0.5) * (x - 0.5) * std::sqrt(square) / ((x - other) * (x - third));
  };
  const Complex A1 = factor(x1, x2, x3, a2_ - x1), A2 = factor(x2, x1, x3, a2_ - x2);
  const double A3 = factor(x3, x1, x2, x3 - a2_).real(), f = (1 - nu_) / (2 * M_PI), t2 = tau * tau;
  if (t2 <= a2_) return 0;
  if (tau < 1)
    return f / 2 * (1.0 - A1 / std::sqrt(t2 - x1) - A2 / std::sqrt(t2 - x2) - A3 / std::sqrt(x3 - t2)).real();
  if (tau < w_R_) return f * (1 - A3 / std::sqrt((w_R_ - tau) * (w_R_ + tau)));
  return f;
}

double Lamb::radial(double tau) const {
  const double first = std::sqrt(a2_), last = std::min(tau, 1.0);
  if (!(tau > first)) return 0;
  double u = -1 / (M_PI * M_PI) * integrate_between(first, last, 100, [&](double w) {
    const std::complex<double> alpha(0, std::sqrt(std::max(w * w - a2_, 0.0)));
    const double beta = std::sqrt(std::max(1 - w * w, 0.0)), s = 1 - 2 * w * w;
    const std::complex<double> G = (s - 2.0 * alpha * beta) / (s * s + 4 * w * w * alpha * beta);
    return G.imag() * w * tau / std::sqrt(std::max((tau - w) * (tau + w), 1e-300));
  });
  if (tau > w_R_) u -= residue_radial_ * w_R_ * tau / std::sqrt((tau - w_R_) * (tau + w_R_)) / M_PI;
  return u;
}

double Lamb::convolve(bool is_vertical, const std::function<double(double)>& force_rate, double begin,
                      double end, double t, double r, double speed) const {
  // u(t) = int S(s) f'(t - s) ds, s = r tau / c_S, split where S is singular.
  const double scale = r / speed, from = std::max(t - end, 0.0), to = t - begin;
  double cuts[] = {from, std::sqrt(a2_) * scale, scale, w_R_ * scale, to}, u = 0;
  for (double& cut : cuts) cut = std::clamp(cut, from, std::max(from, to));
  for (int c = 0; c < 4; ++c)
    if (cuts[c + 1] > cuts[c])
      u += integrate_between(cuts[c], cuts[c + 1], 200, [&](double s) {
        return (is_vertical ? vertical(s / scale) : radial(s / scale)) * force_rate(t - s);
      });
  return u;
}

}  // namespace easydyn::reference

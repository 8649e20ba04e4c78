#pragma once

#include <Eigen/Core>
#include <cmath>
#include <complex>
#include <numbers>

namespace easydyn::soil::test {

/// Frequency response of the discretised ground without the time error of the leapfrog, from a record that has died
/// out. With u ~ e^(i w t) the leapfrog's (u+ - 2 u + u-) / dt^2 is -W^2 u, W = (2 / dt) sin(w dt / 2): what it
/// answers at w is what an exact integration answers at W. Its velocity, the mean of two half steps, is
/// i sin(w dt) / dt times u.
///
///   H(W) = V(w) / F(w) dt / (i sin(w dt)) [m/N],  w = (2 / dt) asin(W dt / 2)
///
/// Elastic ground, or memory variables that the engine integrates in w (an error of the damping, not of the speed).
/// @param time, velocity  the record, uniform, sampled at least twice per period
/// @param force           the transform of the force at a circular frequency, int f(t) e^(-i w t) dt
/// @param dt              time step of the solver [s]
template <class Force>
std::complex<double> compute_warped_response(const Eigen::VectorXd& time, const Eigen::VectorXd& velocity,
                                             const Force& force, double dt, double W) {
  using Complex = std::complex<double>;
  const double w = 2 / dt * std::asin(W * dt / 2), step = time(1) - time(0);
  Complex V = 0;
  for (Eigen::Index i = 0; i < time.size(); ++i) V += step * std::polar(1.0, -w * time(i)) * velocity(i);
  return V * dt / (Complex(0, std::sin(w * dt)) * force(w));
}

/// Ricker pulse of unit amplitude.
struct Ricker {
  double f0 = 0;     ///< [Hz] centre frequency
  double delay = 0;  ///< [s] of its peak

  double operator()(double t) const {
    const double a = std::pow(std::numbers::pi * f0 * (t - delay), 2);
    return (1 - 2 * a) * std::exp(-a);
  }
  /// int f(t) e^(-i w t) dt = 2 / sqrt(pi) f^2 / f0^3 e^(-(f / f0)^2 - i w delay), f = w / (2 pi)
  std::complex<double> transform(double w) const {
    const double f = w / (2 * std::numbers::pi), ratio = f / f0;
    return std::polar(2 / std::sqrt(std::numbers::pi) * ratio * ratio / f0 * std::exp(-ratio * ratio),
                      -w * delay);
  }
};

}  // namespace easydyn::soil::test

// A line of receivers on a homogeneous ground: speed of the Rayleigh wave and its decay by material damping.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "soil/wave_solver.hpp"
#include "tests/soil/verification_record.hpp"
#include "tests/soil/warped_response.hpp"

namespace easydyn::soil {
namespace {

using Complex = std::complex<double>;
constexpr double pi = std::numbers::pi;
constexpr double cs = 150, ratio = 0.9194017;  // c_R / c_S at nu = 0.25: root of Rayleigh's equation

/// Receivers every metre from 12 m on; the body waves along the surface fade as r^-2, the Rayleigh wave as r^-1/2.
constexpr double first = 12;
constexpr int receivers = 33;
double distance(int i) {
  return first + i;
}

/// Vertical frequency responses along the line at the frequency f.
class Line {
 public:
  explicit Line(double damping) {
    Site site;
    Layer ground;
    ground.density = 1800;
    ground.cs = cs;
    ground.cp = cs * std::sqrt(3.0);
    ground.damping = damping;
    site.layers = {ground};
    for (int i = 0; i < receivers; ++i) site.receivers.push_back({"r", {distance(i), 0, 0}});
    site.highest_frequency = 50;
    site.damping_frequency = 20;
    site.margin = 6;
    site.duration = 0.7;
    SurfaceLoads loads;
    loads.footprints = {{0, 0, 0.5, 0.5}};
    loads.time = Eigen::VectorXd::LinSpaced(301, 0, 0.3);
    loads.force = 1e4 * loads.time.unaryExpr(pulse_);
    SolverOptions options;
    options.quarter_model = true;
    options.output_step = 2e-3;
    WaveSolver solver(site, loads, options);
    dt_ = solver.time_step();
    std::printf("%.2f million dof, %ld steps\n", 1e-6 * static_cast<double>(solver.lattice().dofs()),
                solver.steps());
    motion_ = solver.run();
  }

  std::vector<Complex> respond(double f) const {
    std::vector<Complex> H;
    for (int i = 0; i < receivers; ++i)
      H.push_back(test::compute_warped_response(
          motion_.time, motion_.vz.col(i), [&](double w) { return 1e4 * pulse_.transform(w); }, dt_,
          2 * pi * f));
    return H;
  }

 private:
  test::Ricker pulse_{22, 1.3 / 22};
  double dt_ = 0;
  GroundMotion motion_;
};

/// Slope over the distance of the logarithm of a / b, least squares; the phase is followed from receiver to receiver.
Complex fit_slope(const std::vector<Complex>& a, const std::vector<Complex>& b) {
  Complex logarithm = 0, sum = 0, moment = 0;
  double r_sum = 0, rr = 0;
  for (int i = 0; i < receivers; ++i) {
    const Complex quotient = a[i] / b[i];
    logarithm = i == 0 ? std::log(quotient) : logarithm + std::log(quotient / (a[i - 1] / b[i - 1]));
    sum += logarithm;
    moment += logarithm * distance(i);
    r_sum += distance(i);
    rr += distance(i) * distance(i);
  }
  return (moment - sum * r_sum / double(receivers)) / (rr - r_sum * r_sum / receivers);
}

/// The outgoing cylindrical wave H0^(2)(k r) along the line.
std::vector<Complex> cylindrical_wave(double k) {
  std::vector<Complex> wave;
  for (int i = 0; i < receivers; ++i) wave.emplace_back(::j0(k * distance(i)), -::y0(k * distance(i)));
  return wave;
}

TEST(SurfaceWave, RunsAndDecaysAsRayleighsAlongALineOfReceivers) {
  const Line elastic(0), damped(0.03);
  double worst_speed = 0;
  for (const double f :
       {20.0, 30.0, 40.0}) {  // the line begins 1.7 wavelengths away; at 15 Hz body waves add 0.4 %
    const double k = 2 * pi * f / (ratio * cs);
    const Complex slope = fit_slope(elastic.respond(f), cylindrical_wave(k));
    const double speed = 2 * pi * f / (k - slope.imag());
    std::printf("%2.0f Hz: c_R = %.3f m/s, exact %.3f; fades by %+.4f of k beside 1 / sqrt(r)\n", f, speed,
                ratio * cs, -slope.real() / k);
    EXPECT_NEAR(speed / (ratio * cs), 1, 0.003) << f << " Hz";
    worst_speed = std::max(worst_speed, std::abs(speed / (ratio * cs) - 1));
  }
  test::record_verification("rayleigh-speed", 100 * worst_speed);

  // With the same complex factor m on both moduli, k = w / (c_R sqrt(m)): the damped wave is the elastic one at another k,
  // and -Im k / Re k = tan(delta / 2), tan(delta) = 2 xi. Held by the Maxwell body within 5 % (relaxation_test).
  double worst_damping = 0;
  for (const double f : {10.0, 20.0, 40.0}) {
    const Complex slope = fit_slope(damped.respond(f), elastic.respond(f));  // -i (k_damped - k_elastic)
    const Complex k = 2 * pi * f / (ratio * cs) + Complex(0, 1) * slope;
    const double measured = std::tan(2 * std::atan(-k.imag() / k.real())) / 2;
    std::printf("%2.0f Hz: damping ratio %.5f from the decay over %d m\n", f, measured, receivers - 1);
    EXPECT_NEAR(measured, 0.03, 0.05 * 0.03) << f << " Hz";
    worst_damping = std::max(worst_damping, std::abs(measured / 0.03 - 1));
  }
  test::record_verification("damping-from-decay", 100 * worst_damping);
}

}  // namespace
}  // namespace easydyn::soil

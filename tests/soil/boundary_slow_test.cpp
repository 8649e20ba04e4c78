// What the boundary sends back, frequency by frequency: a small model against the exact motion of the layered ground. The
// table of docs/soil_boundary.md is what this prints.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>

#include "soil/layered/footprint_response.hpp"
#include "soil/wave_solver.hpp"
#include "tests/soil/verification_record.hpp"

namespace easydyn::soil {
namespace {

constexpr double pi = std::numbers::pi;
using Complex = std::complex<double>;

constexpr std::array<double, 10> frequencies{3, 5, 8, 10, 12, 14, 16, 18, 20, 30};
using Levels = std::array<double, frequencies.size()>;  // [dB]
// Goals, with a crossover of 15 Hz and with a matched layer on both soils at all receivers.
constexpr Levels stated{-20, -25, -25, -35, -35, -35, -35, -35, -35, -30};
constexpr std::array<double, 3> receivers{4, 8, 16};  // [m]
// Both motions are compared times exp(-decay t): undamped layers need it, and what comes late hardly loses.
constexpr double decay = 0.5;  // [1/s]

Layer layer(double thickness, double cs) {
  Layer result;
  result.thickness = thickness;
  result.density = 1800;
  result.cs = cs;
  result.cp = 2 * cs;  // nu = 1/3
  return result;
}

Site make_site(const std::vector<Layer>& layers) {
  Site site;
  site.layers = layers;
  for (const double x : receivers) site.receivers.push_back({std::to_string(x), {x, 0, 0}});
  site.margin = 3;
  site.duration = 1.6;
  return site;
}

/// Ricker pulse of 12 Hz.
SurfaceLoads make_loads() {
  SurfaceLoads loads;
  loads.footprints = {{0, 0, 1, 1}};
  loads.time = Eigen::VectorXd::LinSpaced(501, 0, 0.5);
  loads.force.resize(501, 1);
  for (int i = 0; i < 501; ++i) {
    const double a = std::pow(pi * 12 * (loads.time(i) - 0.15), 2);
    loads.force(i, 0) = 1e4 * (1 - 2 * a) * std::exp(-a);
  }
  return loads;
}

GroundMotion compute_motion(const Site& site, const SurfaceLoads& loads, const SolverOptions& options) {
  WaveSolver solver(site, loads, options);
  const RunSummary summary = solver.compute_summary();
  std::printf(
      "  %s, crossover %2.0f Hz: %.2f million dof, low %.2f, %ld of %ld elements in the layer, %ld steps\n",
      options.boundary == AbsorbingBoundary::sponge ? "sponge" : "matched layer", options.crossover_frequency,
      1e-6 * static_cast<double>(solver.lattice().dofs()),
      solver.low_lattice() ? 1e-6 * static_cast<double>(solver.low_lattice()->dofs()) : 0.0,
      summary.layer_elements, summary.elements, solver.steps());
  return solver.run();
}

Complex integrate(const Eigen::VectorXd& time, const Eigen::Ref<const Eigen::VectorXd>& values, Complex i_w) {
  Complex sum = 0;
  for (Eigen::Index i = 0; i < time.size(); ++i) sum += values(i) * std::exp(-i_w * time(i));
  return sum * (time(1) - time(0));
}

/// Small models on one ground, and the exact motion of that ground.
class SmallModel {
 public:
  explicit SmallModel(const std::vector<Layer>& layers, GroundDamping damping = GroundDamping::none)
      : site_(make_site(layers)), loads_(make_loads()), w_(frequencies.size()) {
    FootprintRequest request;
    request.length = request.width = 1;
    for (const double x : receivers) request.points.push_back({x, 0, 0});
    for (std::size_t f = 0; f < frequencies.size(); ++f)
      w_(static_cast<Eigen::Index>(f)) = Complex(2 * pi * frequencies[f], -decay);
    exact_ = compute_footprint_response(LayeredGround(site_, damping), request, w_);
  }

  /// |difference| / |motion| of v_x and v_z together at each receiver [dB]; printed.
  std::array<Levels, receivers.size()> measure(SolverOptions options) const {
    options.quarter_model = true;
    options.output_step = 2e-3;
    const GroundMotion motion = compute_motion(site_, loads_, options);
    std::array<Levels, receivers.size()> back{};
    for (Eigen::Index r = 0; r < 3; ++r) {
      std::printf("  %2.0f m:", receivers[static_cast<std::size_t>(r)]);
      for (std::size_t f = 0; f < frequencies.size(); ++f) {
        const auto row = static_cast<Eigen::Index>(f);
        const Complex i_w = Complex(0, 1) * w_(row), force = integrate(loads_.time, loads_.force.col(0), i_w),
                      x = i_w * force * exact_.ux(row, r), z = i_w * force * exact_.uz(row, r);
        const double level = 10 * std::log10((std::norm(integrate(motion.time, motion.vx.col(r), i_w) - x) +
                                              std::norm(integrate(motion.time, motion.vz.col(r), i_w) - z)) /
                                             (std::norm(x) + std::norm(z)));
        back[static_cast<std::size_t>(r)][f] = level;
        std::printf(" %6.1f", level);
      }
      std::printf(" dB\n");
    }
    std::fflush(stdout);
    return back;
  }

 private:
  Site site_;
  SurfaceLoads loads_;
  Eigen::VectorXcd w_;
  FootprintResponse exact_;
};

void expect_as_stated(const std::array<Levels, receivers.size()>& back) {
  for (std::size_t r = 0; r < receivers.size(); ++r)
    for (std::size_t f = 0; f < frequencies.size(); ++f)
      EXPECT_LT(back[r][f], stated[f]) << frequencies[f] << " Hz, receiver " << r;
}

class Boundary : public testing::TestWithParam<int> {
 protected:
  static std::vector<Layer> layers() {
    std::printf("%s\n", GetParam() == 0 ? "cs 150 m/s" : "5 m of cs 150 m/s on 300 m/s");
    return GetParam() == 0 ? std::vector<Layer>{layer(0, 150)}
                           : std::vector<Layer>{layer(5, 150), layer(0, 300)};
  }
};

TEST_P(Boundary, SendsBackLessThanStated) {
  const SmallModel model(layers());
  SolverOptions options;
  model.measure(options);
  options.crossover_frequency = 15;
  const auto back = model.measure(options);
  expect_as_stated(back);
  for (const Levels& levels : back)
    for (std::size_t f = 0; f < frequencies.size(); ++f)
      test::record_verification((GetParam() == 0 ? "boundary-half-space-" : "boundary-layered-") +
                                    std::to_string(static_cast<int>(frequencies[f])),
                                levels[f]);
}

TEST_P(Boundary, SendsBackLessThanStatedWithAMatchedLayer) {
  SolverOptions options;
  options.boundary = AbsorbingBoundary::matched_layer;
  const auto back = SmallModel(layers()).measure(options);
  expect_as_stated(back);
  for (const Levels& levels : back)
    for (std::size_t f = 0; f < frequencies.size(); ++f) {
      if (frequencies[f] == 3) test::record_verification("boundary-pml-3", levels[f]);
      if (frequencies[f] == 8) test::record_verification("boundary-pml-8", levels[f]);
      if (frequencies[f] >= 10 && frequencies[f] <= 20)
        test::record_verification("boundary-pml-10-20", levels[f]);
    }
}

TEST_P(Boundary, SendsBackLessThanStatedWithAMatchedLayerOnDampedGround) {
  // The damping acts in the layer as outside: no step of impedance. 3 %, by memory variables, and exactly their modulus.
  std::vector<Layer> damped = layers();
  for (Layer& each : damped) each.damping = 0.03;
  SolverOptions options;
  options.boundary = AbsorbingBoundary::matched_layer;
  expect_as_stated(SmallModel(damped, GroundDamping::maxwell_body).measure(options));
}

INSTANTIATE_TEST_SUITE_P(OnTwoSoils, Boundary, testing::Values(0, 1));

}  // namespace
}  // namespace easydyn::soil

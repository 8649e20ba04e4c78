// Open blocks against a plane-strain model of another kind (tests/reference/plane_strain.hpp): a trench and an
// embankment under a load so long that within the record nothing arrives from its ends.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "soil/wave_solver.hpp"
#include "tests/reference/plane_strain.hpp"
#include "tests/soil/verification_record.hpp"
#include "tests/soil/warped_response.hpp"

namespace easydyn::soil {
namespace {

using reference::PlaneStrainGround;

constexpr double half_length = 42, half_width = 0.4, step = 1e-3;  // of the load; of the records
constexpr int count = 251;
const test::Ricker pulse{12, 1.3 / 12};
const Layer soft{"ground", 0, 1800, 100, 100 * std::sqrt(3.0), 0, ""};  // nu 0.25; cp x 0.25 s = 43 m

/// Velocities at (0, y, z), half of the load's whole length away from its ends.
GroundMotion compute_motion(const std::vector<Layer>& layers, const std::vector<Block>& blocks,
                            const std::vector<std::array<double, 2>>& places) {
  Site site;
  site.layers = layers;
  site.blocks = blocks;
  for (const auto& [y, z] : places) site.receivers.push_back({"r", {0, y, z}});
  site.highest_frequency = 30;
  site.points_per_wavelength = 7.5;
  site.margin = 6;
  site.duration = step * (count - 1);
  SurfaceLoads loads;
  loads.footprints = {{0, 0, 2 * half_length, 2 * half_width}};
  loads.time = Eigen::VectorXd::LinSpaced(count, 0, site.duration);
  loads.force = 2 * half_length * loads.time.unaryExpr(pulse);  // 1 N/m
  SolverOptions options;
  options.quarter_model = true;
  options.output_step = step;
  WaveSolver solver(site, loads, options);
  std::printf("%.2f million dof, %ld steps\n", 1e-6 * static_cast<double>(solver.lattice().dofs()),
              solver.steps());
  return solver.run();
}

Eigen::Map<const Eigen::VectorXd> as_vector(const std::vector<double>& record) {
  return {record.data(), static_cast<Eigen::Index>(record.size())};
}

/// |a - b| / |b| of v_y and v_z together.
double compare(const GroundMotion& motion, Eigen::Index r, const PlaneStrainGround::Record& expected) {
  const auto vy = as_vector(expected.vy), vz = as_vector(expected.vz);
  return std::sqrt(((motion.vy.col(r) - vy).squaredNorm() + (motion.vz.col(r) - vz).squaredNorm()) /
                   (vy.squaredNorm() + vz.squaredNorm()));
}

double amplitude(const Eigen::VectorXd& v, double f) {
  std::complex<double> sum = 0;
  for (Eigen::Index i = 0; i < v.size(); ++i)
    sum += v(i) * std::polar(1.0, -2 * std::numbers::pi * f * step * static_cast<double>(i));
  return std::abs(sum);
}

PlaneStrainGround::Material material_of(const Layer& layer) {
  return {layer.density, layer.cs, layer.cp};
}

TEST(Trench, TakesAwayWhatItTakesAwayInPlaneStrain) {
  // Open, 0.8 m wide and 3.2 m deep, 4 m from the axis on both sides: two fifths of the Rayleigh wave at 12 Hz.
  const std::vector<std::array<double, 2>> places{{2, 0}, {6, 0}, {8, 0}, {10, 0}};
  Block trench;
  trench.y = {4, 4.8};
  trench.z = {-3.2, 0};
  trench.open = true;
  trench.mirrored = true;
  const auto reference = [&](double h, bool open) {
    PlaneStrainGround ground(h, 28, 24, [&](double y, double z) {
      return open && y > 4 && y < 4.8 && z > -3.2 ? PlaneStrainGround::Material{} : material_of(soft);
    });
    return ground.run(pulse, half_width, 0, places, step, count);
  };
  const auto plain = reference(0.1, false), behind = reference(0.1, true), coarse = reference(0.2, true);
  const GroundMotion without = compute_motion({soft}, {}, places),
                     with = compute_motion({soft}, {trench}, places);
  double worst = 0, worst_level = 0;
  for (Eigen::Index r = 0; r < 4; ++r) {
    const auto& exact = behind[static_cast<std::size_t>(r)];
    // How far the reference is from its own limit: of order h^2 to h^1.1, a third to all of this difference.
    const auto& rough = coarse[static_cast<std::size_t>(r)];
    const double own = std::sqrt(((as_vector(rough.vy) - as_vector(exact.vy)).squaredNorm() +
                                  (as_vector(rough.vz) - as_vector(exact.vz)).squaredNorm()) /
                                 (as_vector(exact.vy).squaredNorm() + as_vector(exact.vz).squaredNorm()));
    const double error = compare(with, r, exact),
                 error_without = compare(without, r, plain[static_cast<std::size_t>(r)]);
    std::printf("y %2.0f m: without %.4f, with the trench %.4f (reference, h 0.2 against 0.1: %.4f);",
                places[static_cast<std::size_t>(r)][0], error_without, error, own);
    EXPECT_LT(error_without, 0.02);
    EXPECT_LT(error, 0.03);
    worst = std::max({worst, error, error_without});
    for (const double f : {8.0, 12.0, 16.0, 20.0}) {
      const double level = 20 * std::log10(amplitude(with.vz.col(r), f) / amplitude(without.vz.col(r), f));
      const double expected = 20 * std::log10(amplitude(as_vector(exact.vz), f) /
                                              amplitude(as_vector(plain[static_cast<std::size_t>(r)].vz), f));
      std::printf("  %.0f Hz %+.2f (%+.2f) dB", f, level, expected);
      if (r == 0) continue;  // in front of it waves stand; what it takes away counts behind
      EXPECT_NEAR(level, expected, 0.5) << f << " Hz, receiver " << r;
      worst_level = std::max(worst_level, std::abs(level - expected));
    }
    std::printf("\n");
  }
  test::record_verification("trench-record", 100 * worst);
  test::record_verification("trench-insertion-loss", worst_level);
}

TEST(Embankment, MovesAsInPlaneStrain) {
  // 1 m high and 4 m wide, of 160 m/s, loaded on its top; the ground beside it is 1 m lower.
  const Layer bank{"bank", 1, 2000, 160, 160 * std::sqrt(3.0), 0, ""};
  const std::vector<std::array<double, 2>> places{{1, 0}, {4, -1}, {8, -1}};
  Block air;
  air.y = {2, std::numeric_limits<double>::infinity()};
  air.z = {-1, 0};
  air.open = true;
  air.mirrored = true;
  const auto reference = [&](double h) {
    PlaneStrainGround ground(h, 28, 24, [&](double y, double z) {
      return z < -1 ? material_of(soft) : y < 2 ? material_of(bank) : PlaneStrainGround::Material{};
    });
    return ground.run(pulse, half_width, 0, places, step, count);
  };
  const auto expected = reference(0.1);
  const GroundMotion motion = compute_motion({bank, soft}, {air}, places);
  double worst = 0;
  for (Eigen::Index r = 0; r < 3; ++r) {
    const double error = compare(motion, r, expected[static_cast<std::size_t>(r)]);
    std::printf("y %2.0f m: %.4f\n", places[static_cast<std::size_t>(r)][0], error);
    EXPECT_LT(error, 0.03);
    worst = std::max(worst, error);
  }
  test::record_verification("embankment", 100 * worst);
}

}  // namespace
}  // namespace easydyn::soil
